#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/brf_options.hpp"
#include "render/reference/brf_trace.hpp"

namespace sunfleck::apps {

// The reflectance factors of one band, view for view, with their errors.
nlohmann::ordered_json jsonOf(const std::vector<BrfView>& views, const BrfResult& result);
nlohmann::ordered_json jsonOf(const ReflectanceParts& parts, const char* name);
// The same as a table for people.
std::string tableOf(const std::vector<BrfView>& views, const BrfResult& result, const char* name);

// CSV of all of it. Several bands are told apart by their names in a first column.
void writeBrf(const std::string& file, const std::vector<BrfView>& views, const std::vector<BrfResult>& results,
              const std::vector<std::string>& bands);

// A results file of the RAMI exercises: a line "rows columns -1.000000" (what is missing), then for each view, parted
// by tabs, zenith of the sun, zenith of the view, azimuth of the view from the direction the light travels in (pi where
// the sun stands), all in radians, reflectance factor and its standard error.
void writeMes(const std::string& file, const std::vector<BrfView>& views, const BrfResult& result, const Scene& scene);

}  // namespace sunfleck::apps
