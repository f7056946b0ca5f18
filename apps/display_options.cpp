#include "apps/display_options.hpp"

namespace sunfleck::apps {

Display DisplayOptions::display() const {
  return {exposure, curve == "filmic" ? ToneCurve::filmic : ToneCurve::clamp};
}

void addDisplayOptions(CLI::App& command, DisplayOptions& options) {
  command.add_option("--exposure", options.exposure, "Factor from radiance to brightness in a .png (default 3)")
      ->check(numberIn(1e-6, 1e6, "in [1e-6, 1e6]"));
  command
      .add_option("--tone-map", options.curve,
                  "Curve from brightness to a .png: clamp, as it is (default), or filmic, whose highlights fade")
      ->check(CLI::IsMember({"clamp", "filmic"}));
}

}  // namespace sunfleck::apps
