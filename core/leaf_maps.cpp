#include "core/leaf_maps.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <tuple>

#include "core/require.hpp"

namespace sunfleck {
namespace {

// Of an image that repeats; `at` in places.
std::size_t wrapped(double at, int count) {
  const double within = at - std::floor(at / count) * count;
  return std::min(static_cast<std::size_t>(within), static_cast<std::size_t>(count - 1));
}

// A part of the images and the leaf area that shows it.
struct ShownPart {
  LeafPatch patch;
  double area = 0.;  // [m^2]
};

std::vector<ShownPart> shownParts(const TreeMesh& mesh) {
  using Key = std::tuple<std::uint32_t, float, float, float, float, float, float>;
  std::vector<double> area_of_patch(mesh.patches.size(), 0.);
  for (std::size_t i = 0; i < mesh.patch_of_triangle.size(); ++i)
    if (const std::uint32_t patch = mesh.patch_of_triangle[i]; patch != TreeMesh::kNoPatch)
      area_of_patch[patch] += triangleArea(mesh, mesh.leaf_triangles[i]);
  std::map<Key, double> areas;  // most cards of a tree bear the same part
  for (std::size_t i = 0; i < area_of_patch.size(); ++i) {
    if (!(area_of_patch[i] > 0.)) continue;
    const auto& [c, mask] = mesh.patches[i];
    areas[{mask, c[0].x, c[0].y, c[1].x, c[1].y, c[2].x, c[2].y}] += area_of_patch[i];
  }
  std::vector<ShownPart> parts;
  for (const auto& [key, area] : areas) {
    const auto& [mask, ax, ay, bx, by, cx, cy] = key;
    parts.push_back({{.corners = {glm::vec2(ax, ay), {bx, by}, {cx, cy}}, .mask = mask}, area});
  }
  return parts;
}

// A part's corners in an image of this size, in places, and the box about them.
struct PartInImage {
  std::array<glm::dvec2, 3> corners;
  glm::dvec2 low, high;

  PartInImage(const ImageCorners& given, int width, int height) {
    for (std::size_t c = 0; c < 3; ++c) corners[c] = {double{given[c].x} * width, (1. - double{given[c].y}) * height};
    low = glm::floor(glm::min(corners[0], glm::min(corners[1], corners[2])));
    high = glm::ceil(glm::max(corners[0], glm::max(corners[1], corners[2])));
  }
  double places() const { return (high.x - low.x) * (high.y - low.y); }
  // Weights of the second and the third corner at a point.
  glm::dvec2 weightsAt(const glm::dvec2& point) const {
    const glm::dvec2 to_second = corners[1] - corners[0], to_third = corners[2] - corners[0], to = point - corners[0];
    const double determinant = to_second.x * to_third.y - to_second.y * to_third.x;
    return glm::dvec2(to.x * to_third.y - to.y * to_third.x, to_second.x * to.y - to_second.y * to.x) / determinant;
  }
};

// Adds the part's area to the places whose middles it holds, or to that of its own middle if it holds none.
void addPart(const ShownPart& part, const TreeMesh& mesh, int width, int height, std::vector<double>& areas,
             std::vector<std::size_t>& held) {
  const PartInImage shown(part.patch.corners, width, height);
  const auto numberOf = [&](double x, double y) {
    return wrapped(y, height) * static_cast<std::size_t>(width) + wrapped(x, width);
  };
  held.clear();
  for (double y = shown.low.y; y < shown.high.y; ++y)
    for (double x = shown.low.x; x < shown.high.x; ++x) {
      const glm::dvec2 weights = shown.weightsAt({x + 0.5, y + 0.5});
      if (weights.x < 0. || weights.y < 0. || weights.x + weights.y > 1.) continue;
      if (part.patch.mask != LeafPatch::kNoMask &&
          !mesh.masks[part.patch.mask]->at(part.patch.corners, static_cast<float>(weights.x),
                                           static_cast<float>(weights.y)))
        continue;
      held.push_back(numberOf(x, y));
    }
  if (held.empty()) {
    const glm::dvec2 middle = (shown.corners[0] + shown.corners[1] + shown.corners[2]) / 3.;
    held.push_back(numberOf(std::floor(middle.x), std::floor(middle.y)));
  }
  const double share =
      part.patch.mask == LeafPatch::kNoMask ? 1. : opaqueShare(*mesh.masks[part.patch.mask], part.patch.corners);
  for (const std::size_t place : held) areas[place] += share * part.area / static_cast<double>(held.size());
}

}  // namespace

std::size_t LeafMaps::placeAt(const glm::vec2& point) const {
  const double x = double{point.x} * width, y = (1. - double{point.y}) * height;
  return wrapped(y, height) * static_cast<std::size_t>(width) + wrapped(x, width);
}

bool LeafMaps::glossy() const {
  return std::ranges::any_of(places, [](const LeafPlace& place) {
    return place.faces[0].gloss != glm::vec3(0.f) || place.faces[1].gloss != glm::vec3(0.f);
  });
}

void validate(const LeafMaps& maps, const std::string& what) {
  for (const int side : {maps.width, maps.height})
    require(side >= 1 && side <= kMostMapWidth, what + ": width or height", side, "1 to 4096 places");
  require(maps.places.size() == static_cast<std::size_t>(maps.width) * static_cast<std::size_t>(maps.height),
          what + ": number of places", maps.places.size(), "width times height");
  require(!maps.roughnesses.empty() && maps.roughnesses.size() <= kMostRoughnesses, what + ": number of roughnesses",
          maps.roughnesses.size(), "1 to 8");
  for (const float roughness : maps.roughnesses)
    require(roughness >= kLeastGlossRoughness && roughness <= 1.f, what + ": gloss_roughness", roughness,
            "in [0.05, 1]");
  // Made once: there may be millions of places.
  const std::string roughness = what + ": number of a roughness", gloss = what + ": gloss",
                    reflectance = what + ": reflectance", transmittance = what + ": transmittance",
                    sum = what + ": reflectance + transmittance";
  for (const LeafPlace& place : maps.places)
    for (const LeafFace& face : place.faces) {
      require(face.roughness < maps.roughnesses.size(), roughness, face.roughness, "below the number of roughnesses");
      for (int band = 0; band < kBands; ++band) {
        require(face.gloss[band] >= 0.f && face.gloss[band] <= 1.f, gloss, face.gloss[band], "in [0, 1]");
        require(face.reflectance[band] >= 0.f, reflectance, face.reflectance[band], "at least 0");
        require(place.transmittance[band] >= 0.f, transmittance, place.transmittance[band], "at least 0");
        // Sums of shares that were rounded to floats.
        require(face.reflectance[band] + place.transmittance[band] <= 1.f + 1e-6f, sum,
                face.reflectance[band] + place.transmittance[band], "at most 1");
      }
    }
}

std::vector<float> leafAreaShares(const TreeMesh& mesh, int width, int height) {
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const std::vector<ShownPart> parts = shownParts(mesh);
  // Where very many parts are large, by places of places.
  constexpr double kMostVisits = 3e8;
  int coarse_width = width, coarse_height = height, coarse = 1;
  const auto visits = [&] {
    return std::accumulate(parts.begin(), parts.end(), 0., [&](double sum, const ShownPart& part) {
      return sum + PartInImage(part.patch.corners, coarse_width, coarse_height).places();
    });
  };
  while (count > 1 && visits() > kMostVisits && coarse < std::max(width, height)) {
    coarse *= 2;
    coarse_width = (width + coarse - 1) / coarse;
    coarse_height = (height + coarse - 1) / coarse;
  }
  std::vector<double> areas(static_cast<std::size_t>(coarse_width) * static_cast<std::size_t>(coarse_height), 0.);
  std::vector<std::size_t> held;
  for (const ShownPart& part : parts) addPart(part, mesh, coarse_width, coarse_height, areas, held);
  const double all = std::accumulate(areas.begin(), areas.end(), 0.);
  std::vector<float> shares(count, static_cast<float>(1. / static_cast<double>(count)));
  if (!(all > 0.)) return shares;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int left = x / coarse * coarse, top = y / coarse * coarse;
      const int within = std::min(coarse, width - left) * std::min(coarse, height - top);
      const double area = areas[static_cast<std::size_t>(y / coarse * coarse_width + x / coarse)];
      shares[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
          static_cast<float>(area / (all * within));
    }
  return shares;
}

BandOptics meanOptics(const LeafMaps& maps, std::span<const float> shares) {
  glm::dvec3 reflectance(0.), transmittance(0.), gloss(0.);
  double roughness = 0., all_gloss = 0., plain_roughness = 0., all = 0.;
  for (std::size_t i = 0; i < maps.places.size(); ++i) {
    const double share = double{shares[i]};
    if (!(share > 0.)) continue;
    all += share;
    transmittance += share * glm::dvec3(maps.places[i].transmittance);
    for (const LeafFace& face : maps.places[i].faces) {
      reflectance += 0.5 * share * glm::dvec3(face.reflectance);
      gloss += 0.5 * share * glm::dvec3(face.gloss);
      const double of_gloss = double{face.gloss.x} + double{face.gloss.y} + double{face.gloss.z};
      const double rough = double{maps.roughnesses[face.roughness]};
      roughness += share * of_gloss * rough;
      plain_roughness += 0.5 * share * rough;
      all_gloss += share * of_gloss;
    }
  }
  BandOptics mean;
  for (int band = 0; band < kBands; ++band) {
    LeafOptics& optics = mean[static_cast<std::size_t>(band)];
    optics.reflectance = static_cast<float>(reflectance[band] / all);
    optics.transmittance = std::min(static_cast<float>(transmittance[band] / all), 1.f - optics.reflectance);
    optics.gloss = static_cast<float>(gloss[band] / all);
    optics.gloss_roughness = static_cast<float>(all_gloss > 0. ? roughness / all_gloss : plain_roughness / all);
  }
  return mean;
}

}  // namespace sunfleck
