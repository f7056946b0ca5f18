#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace sunfleck {

// The numbers of points in the order of Morton's curve through their box (Morton 1966), which keeps near ones together:
// what is worked on in that order finds its neighbours in the processor's cache. To 1/1024 of the box; points of one
// place keep their order.
std::vector<std::uint32_t> mortonOrder(std::span<const glm::vec3> points);

}  // namespace sunfleck
