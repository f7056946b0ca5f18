#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "core/directions.hpp"
#include "render/reference/detail/cosine_law.hpp"
#include "render/reference/detail/scattering.hpp"
#include "render/reference/trace_light.hpp"
#include "scattering/leaf_gloss.hpp"

namespace sunfleck::detail {

// (R20) A leaf under a gloss: f_s = rho_s f of LeafGloss, and beneath it Lambert's law on both sides for the light that
// the gloss lets in and out again,
//   f_r = rho in(mu) in(mu') / (pi in_mean),    f_t = tau in(mu) in(mu') / (pi in_mean),    in(mu) = 1 - rho_s E(mu),
// with in_mean its mean over light from everywhere. So a leaf of rho + tau = 1 sends on all light of each direction.
template <int N>
class GlossyLeaf {
 public:
  GlossyLeaf(const std::vector<TraceLight>& bands, std::uint32_t kind)
      : lobe_(bands.front().ofKind(kind).leaf.gloss_roughness) {
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const LeafOptics leaf = bands[b].ofKind(kind).leaf;
      const int band = static_cast<int>(b);
      gloss_[band] = leaf.gloss;
      // Where the gloss reflects everything nothing comes in.
      const float in_mean = std::max(1.f - leaf.gloss * lobe_.meanAlbedo(), 1e-6f);
      beneath_.reflectance[band] = leaf.reflectance / in_mean;
      beneath_.transmittance[band] = leaf.transmittance / in_mean;
      in_mean_[band] = in_mean;
    }
  }

  // As SceneOptics' functions of these names, with `normal` on the side that the path arrives at.
  Onward scatter(const glm::vec3& normal, const glm::vec3& arriving, BandLanes<N>& weight, PathRandom& random) const {
    const Lobes lobes(*this, -glm::dot(normal, arriving), weight);
    if (!(lobes.all() > 0.f)) return {};
    const float drawn = random.uniform() * lobes.all();
    if (drawn < lobes.glossy) {
      const Axes axes = axesAlong(normal);
      const auto [u, v] = random.pair();
      const LeafGloss::Sample sample = lobe_.sample(into(axes, -arriving), u, v);
      weight *= gloss_;
      weight *= sample.weight * lobes.all() / lobes.glossy;
      const glm::vec3 direction =
          sample.to_light.x * axes.right + sample.to_light.y * axes.up + sample.to_light.z * normal;
      if (!survives(weight, random)) return {};
      return {.fate = Fate::reflected, .side = normal, .direction = direction};
    }
    const bool passes = drawn >= lobes.glossy + lobes.reflected;
    const glm::vec3 side = passes ? -normal : normal;
    const glm::vec3 direction = lambertDirection(side, random);
    weight *= lobes.entering;
    weight *= passes ? beneath_.transmittance : beneath_.reflectance;
    weight *= entering(glm::dot(side, direction));
    weight *= lobes.all() / (passes ? lobes.passed : lobes.reflected);
    if (!survives(weight, random)) return {};
    return {.fate = passes ? Fate::passed : Fate::reflected, .side = side, .direction = direction};
  }

  BandLanes<N> sent(const glm::vec3& normal, const glm::vec3& arriving, const glm::vec3& to_light) const {
    const float cosine = glm::dot(normal, to_light), eye = -glm::dot(normal, arriving);
    BandLanes<N> share = cosine > 0.f ? beneath_.reflectance : beneath_.transmittance;
    share *= std::abs(cosine) * std::numbers::inv_pi_v<float>;
    share *= entering(eye);
    share *= entering(std::abs(cosine));
    if (!(cosine > 0.f && eye > 0.f)) return share;
    const Axes axes = axesAlong(normal);
    const float glossy = cosine * lobe_.brdf(into(axes, -arriving), into(axes, to_light));
    for (int band = 0; band < N; ++band) share[band] += gloss_[band] * glossy;
    return share;
  }

  float density(const glm::vec3& normal, const glm::vec3& arriving, const BandLanes<N>& weight,
                const glm::vec3& direction) const {
    const float cosine = glm::dot(normal, direction);
    const Lobes lobes(*this, -glm::dot(normal, arriving), weight);
    if (!(lobes.all() > 0.f)) return 0.f;
    const float lambert = std::abs(cosine) * std::numbers::inv_pi_v<float>;
    if (!(cosine > 0.f)) return lobes.passed * lambert / lobes.all();
    const Axes axes = axesAlong(normal);
    const float glossy = lobe_.density(into(axes, -arriving), into(axes, direction));
    return (lobes.reflected * lambert + lobes.glossy * glossy) / lobes.all();
  }

  // Bounds of what is sent to either side, 0 where nothing is.
  SurfaceOptics<N> bounds() const {
    SurfaceOptics<N> all = beneath_;
    for (int band = 0; band < N; ++band) all.reflectance[band] += gloss_[band];
    return all;
  }

 private:
  // What the bands together send by each way, from which the way of a path is drawn.
  struct Lobes {
    Lobes(const GlossyLeaf& leaf, float cosine, const BandLanes<N>& weight) : entering(leaf.entering(cosine)) {
      const float albedo = leaf.lobe_.albedo(cosine);
      for (int band = 0; band < N; ++band) {
        const float in = weight[band] * entering[band] * leaf.in_mean_[band];
        glossy += weight[band] * leaf.gloss_[band] * albedo;
        reflected += in * leaf.beneath_.reflectance[band];
        passed += in * leaf.beneath_.transmittance[band];
      }
    }
    float all() const { return glossy + reflected + passed; }
    BandLanes<N> entering;
    float glossy = 0.f, reflected = 0.f, passed = 0.f;
  };

  BandLanes<N> entering(float cosine) const {
    const float albedo = lobe_.albedo(cosine);
    BandLanes<N> share;
    for (int band = 0; band < N; ++band) share[band] = 1.f - gloss_[band] * albedo;
    return share;
  }

  static glm::vec3 into(const Axes& axes, const glm::vec3& v) {
    // A path may arrive along the leaf, to within rounding.
    return {glm::dot(v, axes.right), glm::dot(v, axes.up), std::max(glm::dot(v, axes.along), 1e-6f)};
  }

  LeafGloss lobe_;
  BandLanes<N> gloss_;        // rho_s
  SurfaceOptics<N> beneath_;  // rho, tau over in_mean
  BandLanes<N> in_mean_;
};

}  // namespace sunfleck::detail
