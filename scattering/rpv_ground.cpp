#include "scattering/rpv_ground.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "core/require.hpp"

namespace sunfleck {

float rpvReflectance(const RpvGround& ground, const glm::vec3& to_eye, const glm::vec3& to_light) {
  const float eye = std::max(to_eye.z, kLeastRpvCosine), light = std::max(to_light.z, kLeastRpvCosine);
  const float bowl = std::pow(eye * light * (eye + light), ground.k - 1.f);
  const float phase_cosine = std::clamp(glm::dot(to_eye, to_light), -1.f, 1.f);  // 1 at the hot spot
  const float base = 1.f + ground.theta * (ground.theta + 2.f * phase_cosine);
  const float lobe = (1.f - ground.theta * ground.theta) / (base * std::sqrt(base));
  const float apart = glm::length(glm::vec2(to_eye) / eye - glm::vec2(to_light) / light);
  const float hot_spot = 1.f + (1.f - ground.rho_c) / (1.f + apart);
  return ground.rho0 * bowl * lobe * hot_spot;
}

double rpvAlbedo(const RpvGround& ground, double cosine) {
  // Directions by the law of cosines: rings of equal flux.
  constexpr int kRings = 48, kTurns = 48;
  const auto to_light = [](double z, double azimuth) {
    const double sine = std::sqrt((1. - z) * (1. + z));
    return glm::vec3(glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), z));
  };
  const glm::vec3 from = to_light(cosine, 0.);
  double sum = 0.;
  for (int ring = 0; ring < kRings; ++ring)
    for (int turn = 0; turn < kTurns; ++turn)
      sum += double{rpvReflectance(
          ground, from, to_light(std::sqrt((ring + 0.5) / kRings), std::numbers::pi * (turn + 0.5) / kTurns))};
  return sum / (kRings * kTurns);
}

double largestRpvAlbedo(const RpvGround& ground) {
  constexpr int kAngles = 24;
  double largest = 0.;
  for (int i = 0; i <= kAngles; ++i)
    largest = std::max(largest, rpvAlbedo(ground, std::cos(0.5 * std::numbers::pi * i / kAngles)));
  return largest;
}

void validate(const RpvGround& ground) {
  require(ground.rho0 >= 0.f && ground.rho0 <= 1.f, "ground rpv rho0", ground.rho0, "in [0, 1]");
  require(ground.k >= 0.2f && ground.k <= 2.f, "ground rpv k", ground.k, "in [0.2, 2]");
  require(ground.theta >= -0.9f && ground.theta <= 0.9f, "ground rpv theta", ground.theta, "in [-0.9, 0.9]");
  require(ground.rho_c >= 0.f && ground.rho_c <= 2.f, "ground rpv rho_c", ground.rho_c, "in [0, 2]");
  // The integral may round a ground that reflects everything up.
  const double albedo = largestRpvAlbedo(ground);
  require(albedo <= 1. + 1e-5, "ground rpv: largest share of the light reflected", albedo,
          "at most 1: rho0 must be smaller, or k nearer to 1");
}

}  // namespace sunfleck
