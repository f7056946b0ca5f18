#include "render/shading/fragment_shading.hpp"

#include <cassert>
#include <cstring>
#include <glm/geometric.hpp>

#include "spp/power_table.hpp"
#include "spp/slab.hpp"

namespace sunfleck::shading {

using Number = float;
using glm::dot;
using glm::max;
using glm::min;
using glm::normalize;
using spp::kTableDepths, spp::kTableThicknesses;
using spp::select;
using spp::TablePlace, spp::tablePlace, spp::tableValue;
using std::abs, std::erfc, std::exp, std::sqrt;

// The text shared with GLSL as members of a class: its functions read `kinds`, `lights` and model_constants.
class FragmentShading::Text : public spp::StreamFormulas<float> {
 public:
  explicit Text(const ShadingData& data) : kinds(data.kinds), lights(data.lights), gloss_tables(data.gloss_tables) {}
  virtual ~Text() = default;
  virtual Shaded shadeByLight(Surface, Foliage, float, float, uint) = 0;
  virtual Shaded shadeBySky(Surface, vec3) = 0;
  virtual Shaded shadeBySides(Surface, vec3, vec3) { return {}; }
  virtual void setConstants(std::span<const float>) {}

  std::vector<KindOptics> kinds;
  std::vector<ShadingLight> lights;
  std::vector<float> gloss_tables;
#define SHARED_FN static inline
#define SHARED_CONSTANT static constexpr
#include "render/shading/surface.glsl"
#include "scattering/gloss_formulas.glsl"
};

#define MODEL_CONSTANTS(Type)                                                                      \
  void setConstants(std::span<const float> numbers) override {                                     \
    assert(numbers.size_bytes() % sizeof(Type) == 0);                                              \
    model_constants.resize(numbers.size_bytes() / sizeof(Type));                                   \
    std::memcpy(static_cast<void*>(model_constants.data()), numbers.data(), numbers.size_bytes()); \
  }                                                                                                \
  std::vector<Type> model_constants

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
  struct Sppg final : Text {
    using Text::Text;
#include "render/shading/shade.glsl"
#include "render/shading/sppg.glsl"
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
        return std::make_unique<Spp>(data);
      case Model::sppg:
        return std::make_unique<Sppg>(data);
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
    : text_(Texts::of(model, data)), lights_(static_cast<uint>(data.lights.size())) {
  text_->setConstants(data.constants);
}
FragmentShading::~FragmentShading() = default;

Surface FragmentShading::leafSurface(uint kind, uint tree, uint leaf, const vec3& normal, const vec3& to_eye) const {
  return text_->leafSurface(kind, tree, leaf, normal, to_eye);
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
    all.single += one.single;
    all.multiple += one.multiple;
  }
  return all;
}

}  // namespace sunfleck::shading
