// The gloss of a leaf, and where tables of it are read. This text is C++ and GLSL: values in, a value or a struct out;
// literals with f. The equations stand in docs/EQUATIONS.md. All is for the intensity 1; cosines are to the leaf's
// normal, of directions on its side [1], 0 .. 1.
//   roughness  m, root mean square slope of the facets [1]

// (R20) Beckmann's density of facets by the half-way vector [1/sr].
//   across_squared  square of that vector's part along the leaf
SHARED_FN Number glossFacets(Number across_squared, Number cosine, Number roughness) {
  Number cosine_squared = cosine * cosine;
  Number m_squared = roughness * roughness;
  Number tangent_squared = across_squared / cosine_squared;
  return Number(0.31830988618379067f) * exp(-tangent_squared / m_squared) /
         (m_squared * cosine_squared * cosine_squared);
}

// (R20) Area of the facets that are visible along a direction, per area of the leaf [1]: mu / G1.
SHARED_FN Number glossVisible(Number cosine, Number roughness) {
  Number spread = roughness * sqrt(max(Number(0.0f), (Number(1.0f) - cosine) * (Number(1.0f) + cosine)));
  Number a = cosine / spread;  // infinite along the normal
  return Number(0.5f) * (cosine * erfc(-a) +
                         spread * Number(0.56418958354775629f) * select(a < Number(8.0f), exp(-a * a), Number(0.0f)));
}

// (R20) f = D G / (4 mu mu') [1/sr], with heights that are the same for masking and shadowing:
// 1 / G = visible(mu) / mu + visible(mu') / mu' - 1.
SHARED_FN Number glossBrdf(Number eye, Number light, Number facets, Number roughness) {
  Number unmasked = glossVisible(eye, roughness) * light + glossVisible(light, roughness) * eye - eye * light;
  return facets / (Number(4.0f) * unmasked);
}

// A place between two nodes of a table.
struct GlossPlace {
  int node;
  Number part;  // of the way to the next [1], 0 .. 1
};

SHARED_CONSTANT int kGlossAlbedos = 64;  // intervals of E, at the squares of 0, 1 / 64 .. 1: close at grazing angles

// (R20) Where E of a direction is read: linear in the cosine between nodes at its even roots.
SHARED_FN GlossPlace glossAlbedoPlace(Number cosine) {
  Number at = sqrt(min(max(cosine, Number(0.0f)), Number(1.0f))) * Number(kGlossAlbedos);
  GlossPlace place;
  place.node = min(int(at), kGlossAlbedos - 1);
  Number low = Number(place.node);
  place.part = (at - low) * (at + low) / (Number(2.0f) * low + Number(1.0f));
  return place;
}
SHARED_FN Number between(Number before, Number beyond, Number part) {
  return before + part * (beyond - before);
}

// (R26) Tables of what the gloss sends to the eye of light that is uniform over half of the sphere, the slab's upper one:
// E, then A over the cosine of the slab's normal to the leaf's, then the upper half's share of E over the three numbers
// of glossSharePlace(), the last fastest.
SHARED_CONSTANT int kGlossSlants = 64;   // intervals of A over -1 .. 1
SHARED_CONSTANT int kGlossViews = 20;    // nodes over sqrt(mu) / (sqrt(mu) + sqrt(1 - mu)): close at both ends
SHARED_CONSTANT int kGlossHeights = 32;  // nodes
SHARED_CONSTANT int kGlossTurns = 9;     // nodes over -1 .. 1
SHARED_CONSTANT int kGlossSlantsFirst = 65;
SHARED_CONSTANT int kGlossMeanAlbedo = 129;  // the last of A: light of the leaf's whole side
SHARED_CONSTANT int kGlossSharesFirst = 130;
SHARED_CONSTANT int kGlossNumbers = 5890;

SHARED_FN GlossPlace glossPlace(Number at, int nodes) {
  GlossPlace place;
  place.node = min(int(at), nodes - 2);
  place.part = at - Number(place.node);
  return place;
}
SHARED_FN GlossPlace glossSlantPlace(Number slant_cosine) {
  return glossPlace((Number(0.5f) * Number(kGlossSlants)) * min(slant_cosine + Number(1.0f), Number(2.0f)), kGlossSlants + 1);
}

struct GlossSharePlace {
  GlossPlace view;
  GlossPlace height;
  GlossPlace turn;
};
//   eye     cosine of the line of sight
//   height  between the mirrored line of sight and the slab's upward normal [1], -1 .. 1: nodes are close about 0, where
//           the lobe passes from one half to the other
//   slant   between the leaf's normal and the slab's; with both cosines above it tells how far the slab's normal is
//           turned about the mirrored line of sight
SHARED_FN GlossSharePlace glossSharePlace(Number eye, Number height, Number slant, Number roughness) {
  Number narrow = Number(2.0f) * roughness;
  Number stretched = height * (Number(1.0f) + narrow) / (abs(height) + narrow);
  Number sines = sqrt(max((Number(1.0f) - eye * eye) * (Number(1.0f) - height * height), Number(1.0e-12f)));
  Number turn = min(max((slant - eye * height) / sines, Number(-1.0f)), Number(1.0f));
  GlossSharePlace place;
  Number level = sqrt(max(Number(1.0f) - eye, Number(0.0f)));
  Number raised = sqrt(max(eye, Number(0.0f)));
  place.view = glossPlace(Number(kGlossViews - 1) * (raised / (raised + level)), kGlossViews);
  place.height = glossPlace((Number(0.5f) * Number(kGlossHeights - 1)) *
                                min(max(stretched + Number(1.0f), Number(0.0f)), Number(2.0f)), kGlossHeights);
  place.turn = glossPlace((Number(0.5f) * Number(kGlossTurns - 1)) * (turn + Number(1.0f)), kGlossTurns);
  return place;
}
