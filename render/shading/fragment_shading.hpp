#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "render/shading/shading_data.hpp"

namespace sunfleck::shading {

// What stands before and beyond a place in the light of one sun; as in render/gl/foliage.glsl.
struct Foliage {
  float before;   // n+: leaves crossed between the sun and the place                      [1]
  float beyond;   // n-: leaves crossed beyond it                                          [1]
  float visible;  // share of the sun's light that meets neither leaf nor wood before      [1], 0 .. 1
};

// One sun at a fragment.
struct FragmentLight {
  Foliage foliage{0.f, 0.f, 1.f};
  float thickness = 0.f;     // along the light, a leaf itself included [1]
  float compensation = 1.f;  // G [1], 0 .. 1
};

// What is known of a place on a surface before it is shaded.
struct Fragment {
  Surface surface;
  std::array<FragmentLight, kMostShadingLights> lights;
  vec3 sky{0.f};  // mean radiance of the environment's light there (D10), per band
};

// (R37) What is seen of a leaf that is not alike everywhere.
struct SeenLeaf {
  uint place = kNoLeafPlace;  // of the maps; by default the mean leaf
  bool front = true;          // whether the upper side is seen, about which the corners turn counter-clockwise
};

// (R27) Shades fragments on the processor, by the text that the graphics card shades by. Any thread may ask it.
class FragmentShading {
 public:
  FragmentShading(Model model, const ShadingData& data);
  ~FragmentShading();

  // (R37) The place of a point of the leaf's images, where a pixel shows so many places of the full size.
  uint leafPlace(uint kind, const vec2& at, float places) const;
  Surface leafSurface(uint kind, const SeenLeaf& seen, uint tree, uint leaf, const vec3& normal,
                      const vec3& to_eye) const;
  Surface woodSurface(uint kind, uint tree, const vec3& normal, const vec3& to_eye) const;
  Surface groundSurface(uint kind, const vec3& albedo, const vec3& normal, const vec3& to_eye) const;

  // Of one sun; of the environment; of what the field tells of the sides that are seen and not, nothing by other
  // models; of all suns and the environment.
  Shaded shadeByLight(const Surface& surface, const FragmentLight& at, uint light) const;
  Shaded shadeBySky(const Surface& surface, const vec3& sky) const;
  Shaded shadeBySides(const Surface& surface, const vec3& same, const vec3& other) const;
  Shaded shade(const Fragment& fragment) const;

 private:
  class Text;
  struct Texts;
  std::unique_ptr<Text> text_;
  uint lights_;
};

}  // namespace sunfleck::shading
