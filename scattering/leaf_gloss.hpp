#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace sunfleck {

// (R20) The glossy reflection of a leaf's rough surface: facets that reflect as mirrors, their slopes spread by
// Beckmann's law. Directions are unit vectors that point away from the leaf, in axes whose z is its normal, with z > 0;
// all is for the intensity rho_s = 1, in which it is linear. A value; immutable, and threads share it.
class LeafGloss {
 public:
  //   roughness  m, root mean square slope of the facets [1], kLeastGlossRoughness .. 1 (core/leaf_optics.hpp)
  explicit LeafGloss(float roughness);

  // f = D G / (4 mu mu') [1/sr], reciprocal and bounded: Smith's masking and shadowing G takes away what would grow
  // without bound at grazing angles.
  float brdf(const glm::vec3& to_eye, const glm::vec3& to_light) const;

  // E: share of the light along `cosine` that is reflected to anywhere [1], 0 .. 1; between the nodes of a table.
  float albedo(float cosine) const;
  float meanAlbedo() const { return mean_albedo_; }  // of light from everywhere, exactly that of the table [1]

  // A reflected direction by the facets that are visible from `to_eye`, at the point (u, v) of [0, 1)^2, and
  // f mu' / density, 0 .. 1: 0 where the direction leads into the leaf.
  struct Sample {
    glm::vec3 to_light{0.f};
    float weight = 0.f;
  };
  Sample sample(const glm::vec3& to_eye, float u, float v) const;
  // The density of these directions [1/sr]; what is missing of 1 leads into the leaf.
  float density(const glm::vec3& to_eye, const glm::vec3& to_light) const;

 private:
  // Beckmann's density of facets by the half-way vector [1/sr].
  float facets(const glm::vec3& half_way) const;
  // Area of the facets that are visible along a direction, per area of the leaf [1]: mu / G1.
  float visible(float cosine) const;
  double integratedAlbedo(double cosine) const;

  float roughness_;
  std::array<float, 65> albedo_{};  // the nodes of glossAlbedoPlace()
  float mean_albedo_ = 0.f;
};

}  // namespace sunfleck
