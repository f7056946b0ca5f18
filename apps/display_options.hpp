#pragma once

#include <string>

#include "apps/run_options.hpp"
#include "render/tone_mapping.hpp"

namespace sunfleck::apps {

// Brings a leaf in full sun to about the middle of the display's range.
inline constexpr float kExposure = 3.f;

// How a .png shows radiances.
struct DisplayOptions {
  float exposure = kExposure;
  std::string curve = "clamp";
  Display display() const;
};
void addDisplayOptions(CLI::App& command, DisplayOptions& options);

}  // namespace sunfleck::apps
