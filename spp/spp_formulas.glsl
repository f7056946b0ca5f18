// Closed forms of light in a plane-parallel slab of leaves, and their compensation for the edge of a crown. This text is
// C++ (for single numbers and for lanes of a vector) and GLSL: values in, a value or a struct out; literals with f; no
// sampling, no globals, no branch on a Number but select(). The equations stand in docs/EQUATIONS.md.
//
// The slab's optical depth counts leaf crossings along its normal, from 0 at the lit face to `thickness` at the other.
// F, the power that arrives through a plane facing the light, is 1.
//   depth          z      optical depth of the place below the lit face                        [1], 0 .. thickness
//   thickness      w      optical thickness of the slab; may be infinite                       [1], >= 0
//   mu0                   |cos| of the light's direction to the slab's normal                  [1], (0, 1]
//   albedo         omega  share of the light that meets a leaf and is scattered                [1], 0 .. 1
//   forward_share  T      share of the scattered light that goes on into the forward half      [1], 0 .. 1

// (1 - e^-x) / x for |x| < 1/2, where the difference would lose its digits: Taylor's series to a rounding.
SHARED_FN Number decaySeries(Number x) {
  Number sum = Number(kDecaySeries[kSeriesDegree]);
  for (int n = kSeriesDegree - 1; n >= 0; --n) sum = sum * x + Number(kDecaySeries[n]);
  return sum;
}

// D(p, q, z) = (e^-pz - e^-qz) / (q - p), which is z e^-pz where p = q, given the two exponentials `ep` and `eq`.
SHARED_FN Number rateQuotient(Number p, Number q, Number z, Number ep, Number eq) {
  Number gap = q - p;
  Number inverse = Number(1.0f) / gap;
  Number x = gap * z;
  return select(abs(x) < Number(0.5f), z * ep * decaySeries(x), (ep - eq) * inverse);
}

// Integral of e^-rate t over t = 0 .. z; rate >= 0.
SHARED_FN Number decayIntegral(Number rate, Number z) {
  return rateQuotient(Number(0.0f), rate, z, Number(1.0f), exp(-rate * z));
}

// (S8) T of leaves of all directions lit along the slab's normal: from 1/6, where they only reflect, to 5/6, where they
// only transmit.
SHARED_FN Number sphericalLeafForwardShare(Number reflectance, Number transmittance) {
  Number albedo = max(reflectance + transmittance, Number(1.0e-30f));
  return Number(0.5f) + (transmittance - reflectance) / (Number(3.0f) * albedo);
}

struct SlabPowers {
  Number down;  // P+: radiance integrated over the forward half of the sphere, direct light included  [1], 0 .. F + ...
  Number up;    // P-: radiance integrated over the backward half                                      [1]
};

// (S1) SS: light that met no leaf. Beer and Lambert's law along the slanted path.
SHARED_FN Number directPower(Number depth, Number mu0) {
  return exp(-depth / mu0);
}

// A depth, the nearer face for what lies outside, in a slab that counts as w thick. One without end has a w too, to whose
// face no depth but infinity may come near.
SHARED_FN Number depthWithin(Number depth, Number thickness, Number w) {
  Number deepest = select(w < thickness, select(depth < thickness, Number(1.0e-7f) * w, w), w);
  return min(max(depth, Number(0.0f)), deepest);
}

// (S2) What SPP's solution has of the leaves and the light's direction, the same at all depths of all slabs.
struct SppRates {
  Number rate;      // k                                                                           [1], >= 0
  Number loss;      // gamma / mu0, gamma = 1 - omega T                                            [1], >= 0
  Number backward;  // omega R / mu0                                                               [1], >= 0
};

SHARED_FN SppRates sppRates(Number mu0, Number albedo, Number forward_share) {
  Number backward_share = Number(1.0f) - forward_share;
  Number lost = Number(1.0f) - albedo;
  SppRates leaves;
  leaves.rate = sqrt((lost + Number(2.0f) * albedo * backward_share) * lost) / mu0;
  leaves.loss = (lost + albedo * backward_share) / mu0;
  leaves.backward = albedo * backward_share / mu0;
  return leaves;
}

// (S2) SPP, Shinya et al. 2013 Eqs. 11 to 22 in a form whose every exponent is negative and that has no pole at
// albedo 1, where its exponent k is 0.
SHARED_FN SlabPowers sppPowersOf(SHARED_IN(SppRates) leaves, Number depth, Number thickness) {
  Number w = min(thickness, Number(1.0e30f));  // as good as infinite, and its products are still numbers
  Number z = depthWithin(depth, thickness, w);
  Number rest = w - z;
  // sh(x) = (1 - e^-2kx) / 2k and ch(x) = (1 + e^-2kx) / 2: sinh and cosh without their growing factor.
  Number rate = Number(2.0f) * leaves.rate;
  Number fade = exp(-leaves.rate * z);
  Number fade_rest = exp(-rate * rest);
  Number fade_w = fade * fade * fade_rest;
  Number sh_w = rateQuotient(Number(0.0f), rate, w, Number(1.0f), fade_w);
  Number sh_rest = rateQuotient(Number(0.0f), rate, rest, Number(1.0f), fade_rest);
  Number ch_w = Number(0.5f) * (Number(1.0f) + fade_w);
  Number ch_rest = Number(0.5f) * (Number(1.0f) + fade_rest);
  Number scale = fade / (ch_w + leaves.loss * sh_w);
  SlabPowers powers;
  powers.down = scale * (ch_rest + leaves.loss * sh_rest);
  powers.up = scale * leaves.backward * sh_rest;
  return powers;
}
SHARED_FN SlabPowers sppPowers(Number depth, Number thickness, Number mu0, Number albedo, Number forward_share) {
  return sppPowersOf(sppRates(mu0, albedo, forward_share), depth, thickness);
}

// (R35) Of SPP's diffuse powers with mu0 = 1 those of light that was scattered once.
SHARED_FN SlabPowers sppScatteredOnce(SHARED_IN(SppRates) leaves, Number depth, Number thickness) {
  Number direct = directPower(depth, Number(1.0f));
  SlabPowers once;
  once.down = (Number(1.0f) - leaves.loss) * depth * direct;
  once.up = leaves.backward * direct * decayIntegral(Number(2.0f), max(thickness - depth, Number(0.0f)));
  return once;
}

// (S3) Diffuse radiance of SPP, the same for all directions of a half: forward half, then backward half  [1/sr].
SHARED_FN SlabPowers sppDiffuseRadiance(SlabPowers powers, Number direct) {
  Number per_steradian = Number(0.15915494309189535f);  // 1 / 2 pi
  SlabPowers radiance;
  radiance.down = max(powers.down - direct, Number(0.0f)) * per_steradian;
  radiance.up = powers.up * per_steradian;
  return radiance;
}

// (S4) Irradiance of a leaf, both sides together, per one-sided area: direct light on its projection, and half of what
// passes each way, because a leaf of any orientation gathers a half-sphere's uniform radiance alike.
SHARED_FN Number leafIrradiance(Number projection, Number direct, SlabPowers powers) {
  return projection * direct + Number(0.5f) * (max(powers.down - direct, Number(0.0f)) + powers.up);
}

// (S5) G_s of Shinya et al. 2013 Eqs. 24 to 26: the share of the slab's light in one direction that the real crown
// cannot send, because its edge lies nearer than the slab's face. With L the way to the slab's face and h that to the
// edge, G_s = (J(L) - J(min(h, L))) / J(L), J(x) = integral of e^-al over 0 .. x, a = 1 - cosine / mu0; written so that
// a may be zero, negative or huge.
//   cosine  between the sample direction, away from the place, and the direction back to the light's plane  [1]
//   edge    h: optical distance to the edge of the foliage in that direction                                [1], >= 0
SHARED_FN Number shareBeyondEdge(Number cosine, Number edge, Number depth, Number thickness, Number mu0) {
  Number w = min(thickness, Number(1.0e7f));
  Number normal_way = select(cosine > Number(0.0f), min(depth, w), max(w - depth, Number(0.0f)));
  Number face = min(normal_way / max(abs(cosine), Number(1.0e-7f)), Number(1.0e7f));
  Number a = Number(1.0f) - cosine / mu0;
  Number beyond = max(face - edge, Number(0.0f));
  Number share = exp(-max(a, Number(0.0f)) * edge) * decayIntegral(abs(a), beyond) / decayIntegral(abs(a), face);
  return select(beyond > Number(0.0f), share, Number(0.0f));
}

// (S6) SPPG, Eq. 28: the slab's light where the crown is like a slab (G = 1), direct light alone where it is not (G = 0).
SHARED_FN SlabPowers compensated(SlabPowers powers, Number direct, Number compensation) {
  SlabPowers result;
  result.down = direct + compensation * (powers.down - direct);
  result.up = compensation * powers.up;
  return result;
}

// Irradiance of a surface's two sides [F].
struct SidesLight {
  Number same;   // the side that the eye sees
  Number other;
};

// (S7) Direct light on both sides.
//   to_light_cosine   between the surface's normal on the eye's side and the direction back to the light  [1], -1 .. 1
//   visible_direct    direct light that reaches the surface: 1 in full light                              [1]
SHARED_FN SidesLight directOnSides(Number to_light_cosine, Number visible_direct) {
  SidesLight light;
  light.same = max(to_light_cosine, Number(0.0f)) * visible_direct;
  light.other = max(-to_light_cosine, Number(0.0f)) * visible_direct;
  return light;
}

// (S7) Light of the two diffuse half-spheres on both sides.
//   slant_cosine      between the surface's normal on the eye's side and the slab's upward normal         [1], -1 .. 1
//   diffuse           powers without the direct light
SHARED_FN SidesLight halvesOnSides(Number slant_cosine, SlabPowers diffuse) {
  Number mean = Number(0.25f) * (diffuse.down + diffuse.up);
  Number slanted = Number(0.25f) * (diffuse.down - diffuse.up) * slant_cosine;
  SidesLight light;
  light.same = mean + slanted;
  light.other = mean - slanted;
  return light;
}

// (S7) Radiance that leaves a surface towards the eye  [1/sr].
SHARED_FN Number lambertRadiance(SidesLight light, Number reflectance, Number transmittance) {
  return Number(0.31830988618379067f) * (reflectance * light.same + transmittance * light.other);
}

// (S7) The same of a leaf in the direct light and the two diffuse half-spheres, as above.
SHARED_FN Number leafRadiance(Number to_light_cosine, Number visible_direct, Number slant_cosine, SlabPowers diffuse,
                              Number reflectance, Number transmittance) {
  return lambertRadiance(directOnSides(to_light_cosine, visible_direct), reflectance, transmittance) +
         lambertRadiance(halvesOnSides(slant_cosine, diffuse), reflectance, transmittance);
}
