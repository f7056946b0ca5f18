// What shading reads and gives. Like all of this folder's text, it is C++ (with GLM's vectors) and GLSL.

const uint kMostSurfaceKinds = 64u;       // of trees in a scene
const uint kMostShadingLights = 4u;

// What a kind of tree does to light, per band [1].
struct KindOptics {
  vec4 leaf_reflectance;    // of the mean leaf, alike on both sides; w: roughness of the gloss, 0 where no leaf has one
  vec4 leaf_transmittance;
  vec4 leaf_gloss;          // intensity rho_s (R20); w: number of the gloss's table among the kind's
  vec4 wood_reflectance;
  vec4 slab_rate, slab_loss, slab_backward;  // SppRates of its leaves, lit along the slab's normal (S2)
  uvec4 maps;  // x, y: places of its leaves' maps across and down, 0: there are none; z: number of the first place;
               // w: of the first table of its leaves' gloss
};

// (R37) A place of maps: so many groups of four numbers. First the transmittance; then of the upper and the lower side
// the reflectance with the gloss's roughness, and the intensity of the gloss with the number of its table among the
// kind's.
const uint kLeafPlaceGroups = 5u;
const uint kNoLeafPlace = 0xffffffffu;  // not known: the mean leaf

// A sun.
struct ShadingLight {
  vec4 travel;      // xyz: unit vector along which its light travels
  vec4 irradiance;  // xyz: of a plane that faces it, per band
};

// What the eye sees of a leaf, of wood or of the ground: two sides that scatter by Lambert's law,
// of a leaf under a gloss if it has one.
struct Surface {
  vec3 normal;         // on the eye's side
  vec3 to_eye;         // unit vector
  vec3 reflectance;    // of the eye's side, per band [1]
  vec3 transmittance;
  float roughness;     // of the gloss on the eye's side, 0 where no side has one
  vec3 gloss;          // its intensity, per band [1]
  vec3 gloss_beyond;   // that of the other side
  uint gloss_table;
  uint gloss_table_beyond;
  uint kind;           // whose leaves make the slab around it
  uint tree;           // of the stand; for models that know each leaf
  uint leaf;           // of the tree; 0xffffffff for wood and ground
};

// Radiance towards the eye, per band [1/sr, times irradiance].
struct Shaded {
  vec3 direct;     // of light that was scattered here alone
  vec3 scattered;  // of light that was scattered before
  vec3 single;     // what of that was scattered once before; 0 where the model does not tell
};
