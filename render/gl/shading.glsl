// (R3, R27) What surfaces send to the eye: the text shared with C++ and where it reads. It comes after prelude.glsl,
// spp_formulas.glsl and foliage.glsl. MODEL is the file of the model asked for (render/shading/shading_model.hpp), which
// is one more part of the program: what changes with the model changes nothing else.
#include "spp/power_table.glsl"
#include "scattering/gloss_formulas.glsl"
#include "render/shading/surface_types.glsl"

layout(std140, binding = 1) uniform Surfaces {
  KindOptics kinds[kMostSurfaceKinds];
  ShadingLight lights[kMostShadingLights];
};
layout(binding = 10) uniform samplerBuffer gloss_tables;   // a number in each texel
layout(binding = 11) uniform samplerBuffer model_numbers;
float glossTableNumber(uint number) { return texelFetch(gloss_tables, int(number)).r; }
vec4 modelNumbers(uint number) { return texelFetch(model_numbers, int(number)); }

// Where GLOSSY is told, compilers know that no leaf has a gloss.
#ifndef GLOSSY
#define GLOSSY true
#endif

// The same of maps, which a unit more holds where MAPS is told.
#ifdef MAPS
#define MAPPED true
layout(binding = 16) uniform samplerBuffer leaf_places;  // see LeafPlaceTexture
vec4 leafNumbers(uint kind, uint place, uint group) { return texelFetch(leaf_places, int(place * kLeafPlaceGroups + group)); }
#else
#define MAPPED false
vec4 leafNumbers(uint kind, uint place, uint group) { return vec4(0.0); }
#endif

#include "render/shading/surface.glsl"
#include MODEL
#include "render/shading/shade.glsl"
