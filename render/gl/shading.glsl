// (R3, R27) What surfaces send to the eye: the text shared with C++ and where it reads. It comes after prelude.glsl,
// spp_formulas.glsl and foliage.glsl. MODEL is the file of the model asked for (shading_program.hpp), which is one more
// part of the program: what changes with the model changes nothing else.
#include "spp/power_table.glsl"
#include "scattering/gloss_formulas.glsl"
#include "render/shading/surface_types.glsl"

layout(std140, binding = 1) uniform Surfaces {
  KindOptics kinds[kMostSurfaceKinds];
  ShadingLight lights[kMostShadingLights];
};
layout(std430, binding = 14) readonly buffer GlossTables { float gloss_tables[]; };
#define MODEL_CONSTANTS(Type) \
  layout(std430, binding = 15) readonly buffer ModelConstants { Type model_constants[]; }

#include "render/shading/surface.glsl"
#include MODEL
#include "render/shading/shade.glsl"
