#include "core/leaf_optics.hpp"

#include "core/require.hpp"

namespace sunfleck {

void validate(const LeafOptics& optics) {
  require(optics.reflectance >= 0.f && optics.reflectance <= 1.f, "leaf reflectance", optics.reflectance, "in [0, 1]");
  require(optics.transmittance >= 0.f && optics.transmittance <= 1.f, "leaf transmittance", optics.transmittance,
          "in [0, 1]");
  require(optics.albedo() <= 1.f, "leaf reflectance + transmittance", optics.albedo(), "at most 1");
  require(optics.gloss >= 0.f && optics.gloss <= 1.f, "leaf gloss", optics.gloss, "in [0, 1]");
  require(optics.gloss_roughness >= kLeastGlossRoughness && optics.gloss_roughness <= 1.f, "leaf gloss_roughness",
          optics.gloss_roughness, "in [0.05, 1]");
}

}  // namespace sunfleck
