#pragma once

#include <cstddef>
#include <span>

#include "render/sweep_file.hpp"

namespace sunfleck::apps {

// What a sweep computes at once: a scene under one sun, with as many optics as ride on the same paths.
struct SweepTask {
  std::size_t scene = 0;
  SweepSun sun;
  std::span<const SweepOptics> optics;
};

// Tasks follow from the file alone, so that its rows are the same to the last bit whoever computes which of them when.
std::size_t taskCount(const SweepFile& sweep);
SweepTask taskAt(const SweepFile& sweep, std::size_t number);

}  // namespace sunfleck::apps
