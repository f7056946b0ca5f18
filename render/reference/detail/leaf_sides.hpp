#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "core/directions.hpp"
#include "render/reference/detail/cosine_law.hpp"
#include "render/reference/detail/scattering.hpp"
#include "scattering/leaf_gloss.hpp"

namespace sunfleck::detail {

// (R37) A leaf under a gloss at one place, as who arrives on one of its sides finds it: f_s = rho_s f of LeafGloss, and
// beneath it Lambert's law for the light that the gloss of one side lets in and that of the same or the other out
// again,
//   f_r = rho in(mu) in(mu') / (pi in_mean),    f_t = tau in(mu) in_o(mu') / (pi max(in_mean, in_mean_o)),
// in(mu) = 1 - rho_s E(mu), in_mean its mean over light from everywhere, and in_o, in_mean_o those of the other side.
template <int N>
class LeafSides {
 public:
  struct Side {
    const LeafGloss* lobe;  // must outlive it
    BandLanes<N> gloss;     // rho_s [1]
  };
  //   met, other  the side that is arrived at, and the other
  //   optics      rho of the side that is arrived at, and tau [1]
  LeafSides(const Side& met, const Side& other, const SurfaceOptics<N>& optics) : met_(met), other_(other) {
    for (int band = 0; band < N; ++band) {
      // Where the gloss reflects everything nothing comes in.
      const auto meanOf = [&](const Side& side) {
        return std::max(1.f - side.gloss[band] * side.lobe->meanAlbedo(), 1e-6f);
      };
      in_mean_[band] = meanOf(met);
      other_in_mean_[band] = meanOf(other);
      beneath_.reflectance[band] = optics.reflectance[band] / in_mean_[band];
      beneath_.transmittance[band] = optics.transmittance[band] / std::max(in_mean_[band], other_in_mean_[band]);
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
      const LeafGloss::Sample sample = met_.lobe->sample(into(axes, -arriving), u, v);
      weight *= met_.gloss;
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
    weight *= entering(passes ? other_ : met_, glm::dot(side, direction));
    weight *= lobes.all() / (passes ? lobes.passed : lobes.reflected);
    if (!survives(weight, random)) return {};
    return {.fate = passes ? Fate::passed : Fate::reflected, .side = side, .direction = direction};
  }

  BandLanes<N> sent(const glm::vec3& normal, const glm::vec3& arriving, const glm::vec3& to_light) const {
    const float cosine = glm::dot(normal, to_light), eye = -glm::dot(normal, arriving);
    BandLanes<N> share = cosine > 0.f ? beneath_.reflectance : beneath_.transmittance;
    share *= std::abs(cosine) * std::numbers::inv_pi_v<float>;
    share *= entering(met_, eye);
    share *= entering(cosine > 0.f ? met_ : other_, std::abs(cosine));
    if (!(cosine > 0.f && eye > 0.f)) return share;
    const Axes axes = axesAlong(normal);
    const float glossy = cosine * met_.lobe->brdf(into(axes, -arriving), into(axes, to_light));
    for (int band = 0; band < N; ++band) share[band] += met_.gloss[band] * glossy;
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
    const float glossy = met_.lobe->density(into(axes, -arriving), into(axes, direction));
    return (lobes.reflected * lambert + lobes.glossy * glossy) / lobes.all();
  }

 private:
  // What the bands together send by each way, from which the way of a path is drawn.
  struct Lobes {
    Lobes(const LeafSides& leaf, float cosine, const BandLanes<N>& weight)
        : entering(LeafSides::entering(leaf.met_, cosine)) {
      const float albedo = leaf.met_.lobe->albedo(cosine);
      for (int band = 0; band < N; ++band) {
        const float in = weight[band] * entering[band];
        glossy += weight[band] * leaf.met_.gloss[band] * albedo;
        reflected += in * leaf.in_mean_[band] * leaf.beneath_.reflectance[band];
        passed += in * leaf.other_in_mean_[band] * leaf.beneath_.transmittance[band];
      }
    }
    float all() const { return glossy + reflected + passed; }
    BandLanes<N> entering;
    float glossy = 0.f, reflected = 0.f, passed = 0.f;
  };

  static BandLanes<N> entering(const Side& side, float cosine) {
    const float albedo = side.lobe->albedo(cosine);
    BandLanes<N> share;
    for (int band = 0; band < N; ++band) share[band] = 1.f - side.gloss[band] * albedo;
    return share;
  }

  static glm::vec3 into(const Axes& axes, const glm::vec3& v) {
    // A path may arrive along the leaf, to within rounding.
    return {glm::dot(v, axes.right), glm::dot(v, axes.up), std::max(glm::dot(v, axes.along), 1e-6f)};
  }

  Side met_, other_;
  SurfaceOptics<N> beneath_;  // rho, tau over the means
  BandLanes<N> in_mean_, other_in_mean_;
};

}  // namespace sunfleck::detail
