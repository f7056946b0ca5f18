#include "render/shading/shading_model.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <stdexcept>

#include "core/leaf_optics.hpp"
#include "spp/slab.hpp"

namespace sunfleck::shading {
namespace {

using Numbers = std::vector<glm::vec4>;

Numbers none(std::span<const TreeKind>, const spp::PowerTableOf&) {
  return {};
}

// The bands of P+ of a node, then those of P-. Bands that are alike share their table.
Numbers tableNumbers(std::span<const TreeKind> kinds, const spp::PowerTableOf& table_of) {
  Numbers numbers;
  for (const TreeKind& kind : kinds) {
    std::array<spp::PowerTable, kBands> tables;
    for (std::size_t band = 0; band < kBands; ++band)
      tables[band] = band > 0 && kind.leaf[band] == kind.leaf[band - 1] ? tables[band - 1] : table_of(kind.leaf[band]);
    for (std::size_t node = 0; node < tables[0].nodes.size(); ++node)
      for (const auto half : {&spp::SlabPowers::down, &spp::SlabPowers::up}) {
        glm::vec4& power = numbers.emplace_back(0.f);
        for (std::size_t band = 0; band < kBands; ++band)
          power[static_cast<int>(band)] = tables[band].nodes[node].*half;
      }
  }
  return numbers;
}
Numbers refinedNumbers(std::span<const TreeKind> kinds, const spp::PowerTableOf&) {
  return tableNumbers(kinds, spp::refinedPowerTable);
}
// On the processor; a fragment that solves the streams' slab itself costs twice as much as all else of it.
Numbers streamNumbers(std::span<const TreeKind> kinds, const spp::PowerTableOf&) {
  return tableNumbers(kinds, spp::streamPowerTable);
}
Numbers exactNumbers(std::span<const TreeKind> kinds, const spp::PowerTableOf& exact) {
  if (!exact) throw std::invalid_argument("the model pp needs the exact solution");
  return tableNumbers(kinds, exact);
}

constexpr std::array kShadingModels{
    ShadingModel{Model::ss, "render/shading/ss.glsl", none},
    ShadingModel{Model::spp, "render/shading/spp.glsl", none},
    ShadingModel{Model::sppg, "render/shading/spp.glsl", none},
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
