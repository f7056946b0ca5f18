#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/common.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "render/reference/detail/glossy_leaf.hpp"
#include "render/reference/detail/lambert_surface.hpp"
#include "render/reference/detail/leaf_sides.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/trace_light.hpp"

namespace sunfleck::detail {

// Leaves of a kind that have a gloss, or that differ from place to place or from side to side.
template <int N>
class LeafSurface {
 public:
  // `scene` must outlive it. Nothing where the leaves are all alike, without a gloss.
  static std::optional<LeafSurface> of(const std::vector<TraceLight>& bands, std::uint32_t kind,
                                       const RayScene::Geometry& scene) {
    const bool glossy = std::ranges::any_of(bands, [&](const auto& b) { return b.ofKind(kind).leaf.gloss > 0.f; });
    if (!glossy && !bands.front().ofKind(kind).maps) return std::nullopt;
    return LeafSurface(bands, kind, scene, glossy);
  }

  // Where it is 0, nothing is sent, from whichever place and side.
  SurfaceOptics<N> bounds() const {
    SurfaceOptics<N> most = alike_;
    for (int band = 0; band < N; ++band) most.reflectance[band] += gloss_[band];
    if (!maps_) return most;
    glm::vec3 reflectance(0.f), transmittance(0.f);
    for (const LeafPlace& place : maps_->places) {
      transmittance = glm::max(transmittance, place.transmittance);
      for (const LeafFace& face : place.faces) reflectance = glm::max(reflectance, face.reflectance + face.gloss);
    }
    for (int band = 0; band < bands_; ++band) {
      most.reflectance[band] = std::max(most.reflectance[band], reflectance[mapBand(band)]);
      most.transmittance[band] = std::max(most.transmittance[band], transmittance[mapBand(band)]);
    }
    return most;
  }

  // As SceneOptics' functions of these names.
  Onward scatter(const Hit& hit, const glm::vec3& arriving, BandLanes<N>& weight, PathRandom& random) const {
    return at(hit, [&](const auto& leaf) { return leaf.scatter(hit.normal, arriving, weight, random); });
  }
  BandLanes<N> sent(const Hit& hit, const glm::vec3& arriving, const glm::vec3& to_light) const {
    return at(hit, [&](const auto& leaf) { return leaf.sent(hit.normal, arriving, to_light); });
  }
  float density(const Hit& hit, const glm::vec3& arriving, const BandLanes<N>& weight,
                const glm::vec3& direction) const {
    return at(hit, [&](const auto& leaf) { return leaf.density(hit.normal, arriving, weight, direction); });
  }

 private:
  LeafSurface(const std::vector<TraceLight>& bands, std::uint32_t kind, const RayScene::Geometry& scene, bool glossy)
      : scene_(&scene), bands_(static_cast<int>(bands.size())), maps_(bands.front().ofKind(kind).maps) {
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const TreeOptics tree = bands[b].ofKind(kind);
      const int band = static_cast<int>(b);
      alike_.reflectance[band] = tree.leaf.reflectance;
      alike_.transmittance[band] = tree.leaf.transmittance;
      gloss_[band] = tree.leaf.gloss;
      map_bands_[b] = tree.map_band;
    }
    if (glossy) glossy_.emplace(bands, kind);
    if (!maps_ || !maps_->glossy()) return;
    std::vector<LeafGloss> lobes;
    for (const float roughness : maps_->roughnesses) lobes.emplace_back(roughness);
    lobes_ = std::make_shared<const std::vector<LeafGloss>>(std::move(lobes));
  }

  int mapBand(int band) const { return map_bands_[static_cast<std::size_t>(band)]; }

  // `body(leaf)` of what the leaf is at the place and on the side that was hit: a LambertSurface, LeafSides or
  // GlossyLeaf.
  template <typename Body>
  auto at(const Hit& hit, const Body& body) const {
    const LeafPlace* const known = placeOf(hit);
    if (!known) return glossy_ ? body(*glossy_) : body(LambertSurface<N>{alike_});
    const LeafPlace& place = *known;
    const LeafFace &met = place.faces[hit.front ? 0 : 1], &other = place.faces[hit.front ? 1 : 0];
    const SurfaceOptics<N> optics{.reflectance = ofBands(met.reflectance),
                                  .transmittance = ofBands(place.transmittance)};
    if (!lobes_) return body(LambertSurface<N>{optics});
    const auto sideOf = [&](const LeafFace& face) {
      return typename LeafSides<N>::Side{.lobe = &(*lobes_)[face.roughness], .gloss = ofBands(face.gloss)};
    };
    return body(LeafSides<N>(sideOf(met), sideOf(other), optics));
  }

  // None where it is not known. Leaves that differ by side alone need no images.
  const LeafPlace* placeOf(const Hit& hit) const {
    if (!maps_) return nullptr;
    if (maps_->places.size() == 1) return maps_->places.data();
    const std::optional<glm::vec2> point = scene_->inImages(hit);
    return point ? &maps_->places[maps_->placeAt(*point)] : nullptr;
  }

  BandLanes<N> ofBands(const glm::vec3& of_map) const {
    BandLanes<N> lanes;
    for (int band = 0; band < bands_; ++band) lanes[band] = of_map[mapBand(band)];
    return lanes;
  }

  const RayScene::Geometry* scene_;
  int bands_;
  SurfaceOptics<N> alike_;  // where the leaf's images are not known
  BandLanes<N> gloss_;
  std::optional<GlossyLeaf<N>> glossy_;
  std::shared_ptr<const LeafMaps> maps_;                 // none where all leaves are alike
  std::array<int, N> map_bands_{};                       // of each band: which of the maps'
  std::shared_ptr<const std::vector<LeafGloss>> lobes_;  // of the maps' roughnesses, where they have any gloss
};

}  // namespace sunfleck::detail
