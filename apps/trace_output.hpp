#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/trace_compare.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/scene.hpp"

namespace sunfleck::apps {

// JSON has no infinity: a score that cannot be told is null.
nlohmann::ordered_json known(double value);

// The shares of the light of one band by their names.
std::vector<NamedEstimate> figuresOf(const ForwardResult& result);
// The shares of the light, their errors and their orders, of one band.
nlohmann::ordered_json jsonOf(const ForwardResult& result);
// The same as a table for people.
std::string tableOf(const ForwardResult& result);
// The shares for other leaves than those traced.
std::string tableOf(const ForwardResult& result, const LeafOptics& traced, const LeafOptics& leaf);

// CSV of the irradiance of each leaf. Leaves of several kinds are told apart by the kind's name in a first column.
void writeLeaves(const std::string& file, const Scene& scene, const ForwardResult& result);

}  // namespace sunfleck::apps
