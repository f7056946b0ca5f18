#pragma once

#include <glm/vec3.hpp>

namespace sunfleck {

// (R21) Ground by the model of Rahman, Pinty and Verstraete (1993), in one band of light.
struct RpvGround {
  float rho0 = 0.1f;  // reflectance [1], 0 .. 1
  float k = 1.f;      // how the reflectance bends with the angles [1], 0.2 .. 2: below 1 a bowl, above 1 a bell
  float theta = 0.f;  // Henyey and Greenstein's asymmetry [1], -0.9 .. 0.9: below 0 more is sent back to the light
  float rho_c = 1.f;  // width of the hot spot [1], 0 .. 2; 1: none
  bool operator==(const RpvGround&) const = default;
};

// Cosines below this count as it where the model would grow without bound: it was fitted to angles up to some 80
// degrees. So no path's weight, which is the factor below, can grow beyond the factor's largest.
inline constexpr float kLeastRpvCosine = 0.05f;

// Bidirectional reflectance factor [1]: pi times the BRDF. Unit vectors that point away from the ground, with z > 0.
float rpvReflectance(const RpvGround& ground, const glm::vec3& to_eye, const glm::vec3& to_light);
// Share of the light along `cosine` that is reflected to anywhere [1], to some 1e-3 of it.
double rpvAlbedo(const RpvGround& ground, double cosine);
// The largest of these shares.
double largestRpvAlbedo(const RpvGround& ground);

// Throws InvalidInput on a parameter out of its range, and on a ground that would reflect more light than arrives at
// some angle.
void validate(const RpvGround& ground);

}  // namespace sunfleck
