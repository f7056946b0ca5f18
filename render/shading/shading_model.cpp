#include "render/shading/shading_model.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <stdexcept>

#include "core/leaf_optics.hpp"
#include "spp/slab.hpp"

namespace sunfleck::shading {
namespace {

// Calls append(optics, numbers) for each kind and band.
template <typename Append>
std::vector<float> ofLeaves(std::span<const TreeKind> kinds, const Append& append) {
  std::vector<float> numbers;
  for (const TreeKind& kind : kinds)
    for (const LeafOptics& leaf : kind.leaf) append(leaf, numbers);
  return numbers;
}

std::vector<float> none(std::span<const TreeKind>, const spp::PowerTableOf&) {
  return {};
}

std::vector<float> sppNumbers(std::span<const TreeKind> kinds, const spp::PowerTableOf&) {
  return ofLeaves(kinds, [](const LeafOptics& leaf, std::vector<float>& numbers) {
    numbers.push_back(leaf.albedo());
    numbers.push_back(spp::sphericalLeafForwardShare(leaf.reflectance, leaf.transmittance));
  });
}

// The nodes' powers band by band within a node. Bands that are alike share their table.
std::vector<float> tableNumbers(std::span<const TreeKind> kinds, const spp::PowerTableOf& table_of) {
  std::vector<float> numbers;
  for (const TreeKind& kind : kinds) {
    std::array<spp::PowerTable, kBands> tables;
    for (std::size_t band = 0; band < kBands; ++band)
      tables[band] = band > 0 && kind.leaf[band] == kind.leaf[band - 1] ? tables[band - 1] : table_of(kind.leaf[band]);
    for (std::size_t node = 0; node < tables[0].nodes.size(); ++node) {
      for (const spp::PowerTable& table : tables) numbers.push_back(table.nodes[node].down);
      for (const spp::PowerTable& table : tables) numbers.push_back(table.nodes[node].up);
    }
  }
  return numbers;
}
std::vector<float> refinedNumbers(std::span<const TreeKind> kinds, const spp::PowerTableOf&) {
  return tableNumbers(kinds, spp::refinedPowerTable);
}
// On the processor; a fragment that solves the streams' slab itself costs twice as much as all else of it.
std::vector<float> streamNumbers(std::span<const TreeKind> kinds, const spp::PowerTableOf&) {
  return tableNumbers(kinds, spp::streamPowerTable);
}
std::vector<float> exactNumbers(std::span<const TreeKind> kinds, const spp::PowerTableOf& exact) {
  if (!exact) throw std::invalid_argument("the model pp needs the exact solution");
  return tableNumbers(kinds, exact);
}

constexpr std::array kShadingModels{
    ShadingModel{Model::ss, "render/shading/ss.glsl", none},
    ShadingModel{Model::spp, "render/shading/spp.glsl", sppNumbers},
    ShadingModel{Model::sppg, "render/shading/sppg.glsl", sppNumbers},
    ShadingModel{Model::sppr, "render/shading/tables.glsl", refinedNumbers},
    ShadingModel{Model::nstreamg, "render/shading/tables.glsl", streamNumbers},
    ShadingModel{Model::pp, "render/shading/tables.glsl", exactNumbers},
    ShadingModel{Model::field, "render/shading/field.glsl", none},
};

}  // namespace

const ShadingModel& shadingModel(Model model) {
  const auto found = std::ranges::find(kShadingModels, model, &ShadingModel::model);
  assert(found != kShadingModels.end());
  return *found;
}

}  // namespace sunfleck::shading
