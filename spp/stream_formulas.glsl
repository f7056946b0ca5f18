// Diffuse light in a slab as a sum of modes, one of which costs two exponentials. Like spp_formulas.glsl, which comes
// before it, this text is C++ and GLSL; the equations stand in docs/EQUATIONS.md. STREAMS, the number of streams in each
// half and of modes, is a constant of the text that includes it.
//
// A mode obeys u' = -v + a e^-Kz, v' = -k^2 u + b e^-Kz; u weighs the sum of the radiances of both halves of the
// sphere, v their difference. No exponent here is positive; equal rates and rates of 0 are limits, not divisions by 0.
//   depth_scale  s      depth in the medium of the modes over true depth                         [1], > 0
//   beam_rate    K      1 / mu0, of leaves G(mu0) / mu0: rate at which the direct light decays   [1], > 0
//   view_rate    m      1 / (depth scale |mu|): rate at which radiance decays towards the eye    [1], > 0

// A place in a slab and the beam there; depths are scaled as the medium of the modes is.
struct SlabPlace {
  Number depth;           // z                                                             [1], 0 .. thickness
  Number rest;            // w - z                                                         [1], 0 .. thickness
  Number thickness;       // w                                                             [1], 0 .. 1e30
  Number beam_rate;       // K
  Number direct;          // e^-Kz
  Number direct_through;  // e^-Kw
};

struct StreamMode {
  Number rate;      // k: rate at which the mode decays                                [1], >= 0
  Number gain;      // g = (b + a K) / (K + k): the beam's part of u is g D(k, K, z)
  Number entering;  // a - g: the beam's part of v at the lit face; where it is small, not the difference of two floats
};

// What a mode is at a place, for a slab of its thickness.
struct ModeShapes {
  Number fade;            // e^-kz
  Number mirrored_fade;   // e^-k(w - z)
  Number fade_through;    // e^-kw
  Number scale;           // 1 / (1 + e^-kw)
  Number even;            // C = cosh(k (w/2 - z)) / cosh(k w/2), the solution without a beam that is symmetric
  Number odd;             // S = sinh(k (z - w/2)) / (k cosh(k w/2)), the antisymmetric one
  Number half_tangent;    // s = tanh(k w/2) / k: S at the other face
  Number gained;          // D(k, K, z)
  Number gained_through;  // D(k, K, w)
};

// How much of both solutions there is in the slab.
struct ModeShare {
  Number even;  // c
  Number odd;   // d
};

struct ModeField {
  Number sum;         // u
  Number difference;  // v
};

// True depth and thickness; what lies outside the slab counts as its face.
SHARED_FN SlabPlace slabPlace(Number depth, Number thickness, Number depth_scale, Number beam_rate) {
  Number w = min(thickness, Number(1.0e30f));
  Number z = depthWithin(depth, thickness, w);
  SlabPlace place;
  place.depth = z * depth_scale;
  place.rest = (w - z) * depth_scale;
  place.thickness = w * depth_scale;
  place.beam_rate = beam_rate;
  place.direct = exp(-beam_rate * place.depth);
  place.direct_through = exp(-beam_rate * place.thickness);
  return place;
}

SHARED_FN ModeShapes modeShapes(Number rate, SHARED_IN(SlabPlace) at) {
  ModeShapes shapes;
  shapes.fade = exp(-rate * at.depth);
  shapes.mirrored_fade = exp(-rate * at.rest);
  shapes.fade_through = shapes.fade * shapes.mirrored_fade;
  shapes.scale = Number(1.0f) / (Number(1.0f) + shapes.fade_through);
  shapes.even = shapes.scale * (shapes.fade + shapes.mirrored_fade);
  shapes.odd = shapes.scale * rateQuotient(Number(0.0f), rate, at.depth - at.rest, shapes.mirrored_fade, shapes.fade);
  shapes.half_tangent =
      shapes.scale * rateQuotient(Number(0.0f), rate, at.thickness, Number(1.0f), shapes.fade_through);
  shapes.gained = rateQuotient(rate, at.beam_rate, at.depth, shapes.fade, at.direct);
  shapes.gained_through = rateQuotient(rate, at.beam_rate, at.thickness, shapes.fade_through, at.direct_through);
  return shapes;
}

// u and v of one mode, or their means over a line of sight, by those of its parts.
//   gained     what the beam makes of u: g D(k, K, z)
//   even, odd  C and S
//   direct     e^-Kz
SHARED_FN ModeField modeSum(StreamMode mode, ModeShare share, Number gained, Number even, Number odd, Number direct) {
  ModeField field;
  field.sum = gained + share.even * even + share.odd * odd;
  field.difference =
      mode.entering * direct + mode.rate * gained - share.even * (mode.rate * (mode.rate * odd)) - share.odd * even;
  return field;
}

// (S9) u and v of one mode.
SHARED_FN ModeField modeField(StreamMode mode, ModeShare share, SHARED_IN(ModeShapes) shapes, SHARED_IN(SlabPlace) at) {
  return modeSum(mode, share, mode.gain * shapes.gained, shapes.even, shapes.odd, at.direct);
}

// (D(p, q, z) - D(p, r, z)) / (r - q) for rates that may be equal, symmetric in all three, given their exponentials.
SHARED_FN Number rateQuotientOfThree(Number p, Number q, Number r, Number z, Number ep, Number eq, Number er) {
  Number low = min(p, min(q, r));
  Number high = max(p, max(q, r));
  Number middle = max(min(p, q), min(max(p, q), r));
  Number fade_low = max(ep, max(eq, er));
  Number fade_high = min(ep, min(eq, er));
  Number fade_middle = max(min(ep, eq), min(max(ep, eq), er));
  Number x = (low - middle) * z;
  Number y = (high - middle) * z;
  // D(low, middle, z) and D(middle, high, z) are z e^-middle z times the series at x and y; close together they would
  // cancel, and the quotient of differences of the series takes their place.
  Number sum = Number(kDecaySeries[kSeriesDegree]);
  Number slope = Number(0.0f);
  for (int n = kSeriesDegree - 1; n >= 0; --n) {
    slope = slope * y + sum;
    sum = sum * x + Number(kDecaySeries[n]);
  }
  Number whole = z * fade_middle;
  Number from_low =
      select(x > Number(-0.5f), whole * sum, (fade_low - fade_middle) * (Number(1.0f) / (middle - low)));
  Number to_high = select(y < Number(0.5f), whole * decaySeries(y),
                          (fade_middle - fade_high) * (Number(1.0f) / (high - middle)));
  return select(y - x < Number(0.5f), -(whole * z) * slope, (from_low - to_high) * (Number(1.0f) / (high - low)));
}

// (S10) Means over a line of sight: of the direct light e^-Kt along one that comes down to `depth`, weighted
// m e^-m(z-t), and along one that comes up to it. `view_fade`: e^-mz, and e^-m(w - z).
SHARED_FN Number beamAlongDownward(SHARED_IN(SlabPlace) at, Number view_rate, Number view_fade) {
  return view_rate * rateQuotient(at.beam_rate, view_rate, at.depth, at.direct, view_fade);
}
SHARED_FN Number beamAlongUpward(SHARED_IN(SlabPlace) at, Number view_rate, Number view_fade) {
  return view_rate * rateQuotient(Number(0.0f), view_rate + at.beam_rate, at.rest, at.direct,
                                  view_fade * at.direct_through);
}

// (S10) The same means of u and v of one mode; `beam` is that of the direct light.
SHARED_FN ModeField modeAlongDownward(StreamMode mode, ModeShare share, SHARED_IN(ModeShapes) shapes,
                                      SHARED_IN(SlabPlace) at, Number view_rate, Number view_fade, Number beam) {
  Number k = mode.rate;
  Number even = shapes.scale * (rateQuotient(k, view_rate, at.depth, shapes.fade, view_fade) +
                                rateQuotient(Number(0.0f), view_rate + k, at.depth, shapes.mirrored_fade,
                                             view_fade * shapes.fade_through));
  Number odd = shapes.odd + shapes.half_tangent * view_fade - even;
  even *= view_rate;
  Number gained = mode.gain * view_rate *
                  rateQuotientOfThree(k, at.beam_rate, view_rate, at.depth, shapes.fade, at.direct, view_fade);
  return modeSum(mode, share, gained, even, odd, beam);
}
SHARED_FN ModeField modeAlongUpward(StreamMode mode, ModeShare share, SHARED_IN(ModeShapes) shapes,
                                    SHARED_IN(SlabPlace) at, Number view_rate, Number view_fade, Number beam) {
  Number k = mode.rate;
  Number even = shapes.scale * (rateQuotient(k, view_rate, at.rest, shapes.mirrored_fade, view_fade) +
                                rateQuotient(Number(0.0f), view_rate + k, at.rest, shapes.fade,
                                             view_fade * shapes.fade_through));
  Number odd = shapes.odd - shapes.half_tangent * view_fade + even;
  even *= view_rate;
  Number gained = mode.gain * (view_rate * (shapes.gained - view_fade * shapes.gained_through) + beam) *
                  (Number(1.0f) / (view_rate + k));
  return modeSum(mode, share, gained, even, odd, beam);
}

// One number for each mode.
struct ModeNumbers {
  Number of[STREAMS];
};

// A symmetric, positive definite matrix, row after row.
struct ModeMatrix {
  Number of[STREAMS * STREAMS];
};

// The modes of a medium under a beam for one order of the azimuth. With X, Y their shares in the sum and the difference
// of the two halves of each stream (docs/EQUATIONS.md, S9):
struct StreamModes {
  StreamMode mode[STREAMS];
  ModeMatrix sum_of_difference;  // X^-1 Y
  ModeMatrix difference_of_sum;  // Y^-1 X
};

// Solves (1 + M diag t) x = right, t >= 0. With M positive definite no pivot is below 1, and what stays of M symmetric.
SHARED_FN ModeNumbers solvedModes(ModeMatrix M, SHARED_IN(ModeNumbers) t, ModeNumbers right) {
  ModeNumbers inverse_pivot;
#pragma GCC unroll 8
  for (int j = 0; j < STREAMS; ++j) {
    inverse_pivot.of[j] = Number(1.0f) / (Number(1.0f) + M.of[j * STREAMS + j] * t.of[j]);
    Number weight = t.of[j] * inverse_pivot.of[j];
#pragma GCC unroll 8
    for (int i = j + 1; i < STREAMS; ++i) {
      Number factor = weight * M.of[j * STREAMS + i];
      right.of[i] -= factor * right.of[j];
#pragma GCC unroll 8
      for (int l = i; l < STREAMS; ++l) M.of[i * STREAMS + l] -= factor * M.of[j * STREAMS + l];
    }
  }
#pragma GCC unroll 8
  for (int j = STREAMS - 1; j >= 0; --j) {
#pragma GCC unroll 8
    for (int i = j + 1; i < STREAMS; ++i) right.of[j] -= M.of[j * STREAMS + i] * (t.of[i] * right.of[i]);
    right.of[j] *= inverse_pivot.of[j];
  }
  return right;
}

// The modes at a place and their shares in the slab.
struct SlabModes {
  ModeShapes shapes[STREAMS];
  ModeShare share[STREAMS];
};

// (S9) No diffuse light enters: u + X^-1 Y v = 0 at the lit face, u - X^-1 Y v = 0 at the other. Half their sum knows
// the even shares alone, and half their difference, times Y^-1 X, the odd ones.
SHARED_FN SlabModes slabModes(SHARED_IN(StreamModes) modes, SHARED_IN(SlabPlace) at) {
  SlabModes slab;
  ModeNumbers tangent, squared_tangent, gained, even_source, odd_source;
#pragma GCC unroll 8
  for (int j = 0; j < STREAMS; ++j) {
    StreamMode mode = modes.mode[j];
    slab.shapes[j] = modeShapes(mode.rate, at);
    tangent.of[j] = slab.shapes[j].half_tangent;
    squared_tangent.of[j] = mode.rate * (mode.rate * tangent.of[j]);
    gained.of[j] = mode.gain * slab.shapes[j].gained_through;
    even_source.of[j] = mode.entering * (Number(1.0f) - at.direct_through) - mode.rate * gained.of[j];
    odd_source.of[j] = mode.entering * (Number(1.0f) + at.direct_through) + mode.rate * gained.of[j];
  }
  ModeNumbers even, odd;
#pragma GCC unroll 8
  for (int i = 0; i < STREAMS; ++i) {
    even.of[i] = gained.of[i];
    odd.of[i] = odd_source.of[i];
#pragma GCC unroll 8
    for (int j = 0; j < STREAMS; ++j) {
      even.of[i] += modes.sum_of_difference.of[i * STREAMS + j] * even_source.of[j];
      odd.of[i] -= modes.difference_of_sum.of[i * STREAMS + j] * gained.of[j];
    }
  }
  even = solvedModes(modes.sum_of_difference, squared_tangent, even);
  odd = solvedModes(modes.difference_of_sum, tangent, odd);
#pragma GCC unroll 8
  for (int j = 0; j < STREAMS; ++j) {
    slab.share[j].even = Number(-0.5f) * even.of[j];
    slab.share[j].odd = Number(0.5f) * odd.of[j];
  }
  return slab;
}

// What each mode's u and v weigh in a result: in the powers, or in what a direction receives.
struct ModeWeights {
  Number sum[STREAMS];
  Number difference[STREAMS];
};

// (S9) P+, direct light included, and P-. `weights`: shares of the modes in P+ + P- and in P+ - P-.
SHARED_FN SlabPowers streamPowers(SHARED_IN(StreamModes) modes, SHARED_IN(ModeWeights) weights,
                                  SHARED_IN(SlabPlace) at) {
  SlabModes slab = slabModes(modes, at);
  Number sum = Number(0.0f);
  Number difference = Number(0.0f);
#pragma GCC unroll 8
  for (int j = 0; j < STREAMS; ++j) {
    ModeField field = modeField(modes.mode[j], slab.share[j], slab.shapes[j], at);
    sum += weights.sum[j] * field.sum;
    difference += weights.difference[j] * field.difference;
  }
  SlabPowers powers;
  powers.down = at.direct + max(Number(0.5f) * (sum + difference), Number(0.0f));
  powers.up = max(Number(0.5f) * (sum - difference), Number(0.0f));
  return powers;
}

// (S10) What the modes of one order of the azimuth send along a direction, once the light scattered once, beam_source
// times `beam` (beamAlongDownward, beamAlongUpward), is set apart  [1/sr]; may be negative.
SHARED_FN Number streamRadiance(SHARED_IN(StreamModes) modes, SHARED_IN(ModeWeights) seen, SHARED_IN(SlabPlace) at,
                                bool downward, Number view_rate, Number view_fade, Number beam) {
  SlabModes slab = slabModes(modes, at);
  Number radiance = Number(0.0f);
#pragma GCC unroll 8
  for (int j = 0; j < STREAMS; ++j) {
    ModeField mean;
    if (downward)
      mean = modeAlongDownward(modes.mode[j], slab.share[j], slab.shapes[j], at, view_rate, view_fade, beam);
    else
      mean = modeAlongUpward(modes.mode[j], slab.share[j], slab.shapes[j], at, view_rate, view_fade, beam);
    radiance += seen.sum[j] * mean.sum + seen.difference[j] * mean.difference;
  }
  return radiance;
}
