#include "field/field_result.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numbers>

namespace sunfleck {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace

// (F4)
std::vector<glm::vec3> sentRadiance(const StandElements& stand, std::span<const FieldPart> parts,
                                    std::span<const FieldKind> kinds) {
  std::vector<glm::vec3> radiance(2 * stand.elements.size());
  tbb::parallel_for(std::size_t{0}, stand.elements.size(), [&](std::size_t i) {
    const FieldKind& kind = kinds[stand.kinds[i] / 2];
    const bool wood = stand.kinds[i] % 2 == 1;
    for (int band = 0; band < kBands; ++band) {
      const auto b = static_cast<std::size_t>(band);
      std::array<float, 2> light{};
      for (const FieldPart& part : parts)
        for (std::size_t side = 0; side < 2; ++side)
          light[side] += part.scale[band] * (part.solutions[b]->scattered[2 * i + side] +
                                             (part.direct ? part.direct->irradiance[2 * i + side] : 0.f));
      const float reflectance = (wood ? kind.wood_reflectance[band] : kind.leaf[b].reflectance) / kPi,
                  transmittance = wood ? 0.f : kind.leaf[b].transmittance / kPi;
      for (std::size_t side = 0; side < 2; ++side)
        radiance[2 * i + side][band] = reflectance * light[side] + transmittance * light[1 - side];
    }
  });
  return radiance;
}

FieldResult fieldResult(const StandElements& stand, std::span<const FieldPart> parts) {
  FieldResult result;
  for (const FieldPart& part : parts)
    for (std::size_t band = 0; band < kBands; ++band) {
      const FieldSolution& solution = *part.solutions[band];
      const auto scale = double{part.scale[static_cast<int>(band)]};
      FieldBalance& balance = result.balance[band];
      balance.in += scale * solution.balance.in;
      balance.absorbed_leaves += scale * solution.balance.absorbed_leaves;
      balance.absorbed_wood += scale * solution.balance.absorbed_wood;
      balance.absorbed_ground += scale * solution.balance.absorbed_ground;
      balance.out_up += scale * solution.balance.out_up;
      balance.out_down += scale * solution.balance.out_down;
      result.iterations = std::max(result.iterations, solution.iterations);
      result.error_bound = std::max(result.error_bound, solution.error_bound);
      result.converged = result.converged && solution.converged;
    }
  const FieldElements& elements = stand.elements;
  std::vector<LeafLight> leaves(stand.mesh.leaf_count, LeafLight{});
  std::vector<float> areas(stand.mesh.leaf_count);
  for (std::size_t i = 0; i < elements.leaf_elements; ++i) areas[elements.leaf[i]] += elements.area[i];
  for (std::size_t i = 0; i < elements.leaf_elements; ++i) {
    LeafLight& leaf = leaves[elements.leaf[i]];
    const float share = elements.area[i] / areas[elements.leaf[i]];
    for (const FieldPart& part : parts)
      for (std::size_t band = 0; band < kBands; ++band) {
        const float scale = share * part.scale[static_cast<int>(band)];
        const std::vector<float>& scattered = part.solutions[band]->scattered;
        leaf.scattered[band].front += scale * scattered[2 * i];
        leaf.scattered[band].back += scale * scattered[2 * i + 1];
        if (!part.direct) continue;
        leaf.direct[band].front += scale * part.direct->irradiance[2 * i];
        leaf.direct[band].back += scale * part.direct->irradiance[2 * i + 1];
      }
  }
  for (std::size_t tree = 0; tree + 1 < stand.first_leaf.size(); ++tree)
    result.trees.emplace_back(leaves.begin() + static_cast<std::ptrdiff_t>(stand.first_leaf[tree]),
                              leaves.begin() + static_cast<std::ptrdiff_t>(stand.first_leaf[tree + 1]));
  return result;
}

}  // namespace sunfleck
