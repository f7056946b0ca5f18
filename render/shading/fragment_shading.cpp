#include "render/shading/fragment_shading.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "spp/power_table.hpp"
#include "spp/slab.hpp"

namespace sunfleck::shading {

using Number = float;
using glm::dot;
using glm::floor;
using glm::max;
using glm::min;
using glm::normalize;
using spp::kTableDepths, spp::kTableThicknesses;
using spp::select;
using spp::TablePlace, spp::tablePlace, spp::tableValue;
using std::abs, std::erfc, std::exp, std::sqrt;

// The text shared with GLSL as members of a class: its functions read what it holds.
class FragmentShading::Text : public spp::StreamFormulas<float> {
 public:
  explicit Text(const ShadingData& data)
      : kinds(data.kinds), lights(data.lights), leaf_tables(data.leaf_tables), model_numbers(data.constants) {}
  virtual ~Text() = default;
  virtual Shaded shadeByLight(Surface, Foliage, float, float, uint) = 0;
  virtual Shaded shadeBySky(Surface, vec3) = 0;
  virtual Shaded shadeBySides(Surface, vec3, vec3) { return {}; }

  std::vector<KindOptics> kinds;
  std::vector<ShadingLight> lights;
  std::shared_ptr<const LeafTables> leaf_tables;
  std::vector<vec4> model_numbers;
  float glossTableNumber(uint number) const { return leaf_tables->gloss_tables[number]; }
  vec4 leafNumbers(uint kind, uint place, uint group) const {
    const LeafTables::OfKind& of = leaf_tables->kinds[kind];
    return of.pyramid->numbers[std::size_t{kLeafPlaceGroups} * (place - of.first_place) + group];
  }
  vec4 modelNumbers(uint number) const { return model_numbers[number]; }
#define GLOSSY true
#define MAPPED true
#define SHARED_FN static inline
#define SHARED_CONSTANT static constexpr
#include "render/shading/surface.glsl"
#include "scattering/gloss_formulas.glsl"
};

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"  // not all models read all, and Mesa's GLSL wants names
struct FragmentShading::Texts {
  struct Ss final : Text {
    using Text::Text;
#include "render/shading/shade.glsl"
#include "render/shading/ss.glsl"
  };
  struct Spp final : Text {
    using Text::Text;
#include "render/shading/shade.glsl"
#include "render/shading/spp.glsl"
  };
  struct Tables final : Text {
    using Text::Text;
#include "render/shading/shade.glsl"
#include "render/shading/tables.glsl"
  };

  struct Field final : Text {
    using Text::Text;
#include "render/shading/field.glsl"
#include "render/shading/shade.glsl"
  };

  static std::unique_ptr<Text> of(Model model, const ShadingData& data) {
    switch (model) {
      case Model::ss:
        return std::make_unique<Ss>(data);
      case Model::spp:
      case Model::sppg:
        return std::make_unique<Spp>(data);
      case Model::sppr:
      case Model::nstreamg:
      case Model::pp:
        return std::make_unique<Tables>(data);
      case Model::field:
        return std::make_unique<Field>(data);
    }
    return nullptr;
  }
};
#pragma GCC diagnostic pop

FragmentShading::FragmentShading(Model model, const ShadingData& data)
    : text_(Texts::of(model, data)), lights_(static_cast<uint>(data.lights.size())) {}
FragmentShading::~FragmentShading() = default;

uint FragmentShading::leafPlace(uint kind, const vec2& at, float places) const {
  return text_->leafPlace(kind, at, places);
}
Surface FragmentShading::leafSurface(uint kind, const SeenLeaf& seen, uint tree, uint leaf, const vec3& normal,
                                     const vec3& to_eye) const {
  return text_->leafSurface(kind, seen.place, seen.front, tree, leaf, normal, to_eye);
}
Surface FragmentShading::woodSurface(uint kind, uint tree, const vec3& normal, const vec3& to_eye) const {
  return text_->woodSurface(kind, tree, normal, to_eye);
}
Surface FragmentShading::groundSurface(uint kind, const vec3& albedo, const vec3& normal, const vec3& to_eye) const {
  return text_->opaqueSurface(kind, 0u, albedo, normal, to_eye);
}

Shaded FragmentShading::shadeByLight(const Surface& surface, const FragmentLight& at, uint light) const {
  return text_->shadeByLight(surface, at.foliage, at.thickness, at.compensation, light);
}
Shaded FragmentShading::shadeBySky(const Surface& surface, const vec3& sky) const {
  return text_->shadeBySky(surface, sky);
}
Shaded FragmentShading::shadeBySides(const Surface& surface, const vec3& same, const vec3& other) const {
  return text_->shadeBySides(surface, same, other);
}

Shaded FragmentShading::shade(const Fragment& fragment) const {
  Shaded all = shadeBySky(fragment.surface, fragment.sky);
  for (uint light = 0; light < lights_; ++light) {
    const Shaded one = shadeByLight(fragment.surface, fragment.lights[light], light);
    all.direct += one.direct;
    all.scattered += one.scattered;
    all.single += one.single;
  }
  return all;
}

}  // namespace sunfleck::shading
