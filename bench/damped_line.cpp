#include "bench/damped_line.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "grid/deep_opacity_map.hpp"
#include "spp/forward_share.hpp"
#include "spp/slab.hpp"
#include "spp/slab_arrays.hpp"

namespace sunfleck {
namespace {

constexpr int kAxes = 24;            // both ways along each
constexpr int kResolution = 256;     // of the maps in which leaves on the lines are counted
constexpr std::size_t kPlaces = 12;  // on a line, alike in the share of light that comes from before them

}  // namespace

DampedLine::DampedLine(const TreeMesh& mesh, const Stand& stand, Direction sun, LeafDepths slab,
                       std::vector<float> compensation, std::vector<float> direct)
    : slab_(std::move(slab)), compensation_(std::move(compensation)), direct_(std::move(direct)) {
  for (const Direction& axis : spreadAxes(kAxes)) {
    const Direction down = axis.z < 0.f ? axis : -axis;
    const LeafDepths found = leafDepths(mesh, DeepOpacityMap(mesh, down, kResolution), stand).front();
    const std::vector<float> facing = leafProjections(mesh, down);
    std::vector<float> below(found.depth.size());
    for (std::size_t i = 0; i < below.size(); ++i) below[i] = found.thickness[i] - 1.f - found.depth[i];
    const float cosine = glm::dot(down, sun);  // the way out is against the light, as that to the sun is
    ways_.push_back({cosine, found.depth, facing});
    ways_.push_back({-cosine, std::move(below), facing});
  }
}

std::vector<float> DampedLine::irradiance(const LeafOptics& leaf) const {
  std::vector<float> irradiance = direct_;
  const float forward = spp::sphericalLeafForwardShare(leaf.reflectance, leaf.transmittance);
  const auto solid_angle = static_cast<float>(4. * std::numbers::pi / static_cast<double>(ways_.size()));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, irradiance.size(), 64), [&](const auto& range) {
    std::array<float, kPlaces> depth, thickness, down, up;
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      thickness.fill(slab_.thickness[i]);
      for (const Way& way : ways_) {
        // With l the leaves before a place, light from there has the share e^-l; u = 1 - e^-l goes from 0 to this.
        const float reached = 1.f - std::exp(-std::max(way.leaves[i], 0.f));
        for (std::size_t k = 0; k < kPlaces; ++k) {
          const float u = reached * (static_cast<float>(k) + 0.5f) / static_cast<float>(kPlaces);
          depth[k] = std::clamp(slab_.depth[i] + std::log1p(-u) * way.cosine, 0.f, slab_.thickness[i]);
        }
        spp::sppPowers(depth, thickness, 1.f, leaf.albedo(), forward, down, up);
        float radiance = 0.f;
        for (std::size_t k = 0; k < kPlaces; ++k) {
          // As (R7) has it, half of either power meets leaves turned every way; both sides send out the albedo's share.
          const float direct = spp::directPower(depth[k], 1.f);
          const float met = 0.5f * (direct + compensation_[i] * (down[k] - direct + up[k]));
          radiance += leaf.albedo() * met / (2.f * std::numbers::pi_v<float>);
        }
        irradiance[i] += solid_angle * way.facing[i] * radiance * reached / static_cast<float>(kPlaces);
      }
    }
  });
  return irradiance;
}

}  // namespace sunfleck
