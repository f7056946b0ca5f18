// Diffuse light in a slab as a sum of modes, one of which costs a few exponentials. Like spp_formulas.glsl, which comes
// before it, this text is C++ and GLSL; the equations stand in docs/EQUATIONS.md.
//
// A mode obeys u' = -v + a e^-Kz, v' = -k^2 u + b e^-Kz; u weighs the sum of the radiances of both halves of the
// sphere, v their difference. No exponent here is positive; equal rates and rates of 0 are limits, not divisions by 0.
//   depth        z      optical depth below the lit face, scaled as the medium of the modes is  [1], 0 .. thickness
//   thickness    w      optical thickness of the slab, scaled alike                             [1], 0 .. 1e15
//   beam_rate    K      1 / mu0: rate at which the direct light decays                          [1], >= 1
//   view_rate    m      1 / (depth scale |mu|): rate at which radiance decays towards the eye   [1], > 0

struct StreamMode {
  Number rate;        // k: rate at which the mode decays                                [1], >= 0
  Number odd_source;  // a
  Number gain;        // g = (b + a K) / (K + k): the beam's part of u is g D(k, K, z)
};

// A mode in a slab of some thickness.
struct SlabMode {
  StreamMode mode;
  Number even;  // c: share of the part symmetric about the middle of the slab
  Number odd;   // d: share of the antisymmetric part
};

struct ModeField {
  Number sum;         // u
  Number difference;  // v
};

// D(p, q, z) = (e^-pz - e^-qz) / (q - p), which is z e^-pz where p = q.
SHARED_FN Number rateQuotient(Number p, Number q, Number z) {
  return z * exp(-min(p, q) * z) * decayMean(abs(q - p) * z);
}

// (D(p, q, z) - D(p, r, z)) / (r - q) for rates that may be equal; symmetric in all three. Where they are close the
// difference would lose its digits: there a series, whose first term left out is below 1e-16 of the sum.
SHARED_FN Number rateQuotientOfThree(Number p, Number q, Number r, Number z) {
  Number low = min(p, min(q, r));
  Number high = max(p, max(q, r));
  Number middle = max(min(p, q), min(max(p, q), r));
  if ((high - low) * z >= Number(0.5f))
    return (rateQuotient(low, middle, z) - rateQuotient(middle, high, z)) / (high - low);
  Number a = (low - middle) * z;
  Number b = (low - high) * z;
  Number power = Number(1.0f);
  Number homogeneous = Number(1.0f);  // sum of a^i b^(n-i) over i = 0 .. n
  Number factor = Number(0.5f);       // 1 / (n + 2)!
  Number sum = factor;
  for (int n = 1; n <= 12; ++n) {
    power *= a;
    homogeneous = b * homogeneous + power;
    factor /= Number(n + 2);
    sum += factor * homogeneous;
  }
  return z * z * exp(-low * z) * sum;
}

// tanh(k w / 2) / k, which is w / 2 where k = 0.
SHARED_FN Number halfTangent(Number rate, Number thickness) {
  return thickness * decayMean(rate * thickness) / (Number(1.0f) + exp(-rate * thickness));
}

// The symmetric and the antisymmetric solution without a beam: cosh(k (w/2 - z)) / cosh(k w/2), and
// sinh(k (z - w/2)) / (k cosh(k w/2)).
SHARED_FN ModeField modeShapes(Number rate, Number depth, Number thickness) {
  Number rest = thickness - depth;
  Number scale = exp(-rate * min(depth, rest)) / (Number(1.0f) + exp(-rate * thickness));
  Number apart = abs(rest - depth);
  ModeField shapes;
  shapes.sum = scale * (Number(1.0f) + exp(-rate * apart));
  shapes.difference = scale * (depth < rest ? -apart : apart) * decayMean(rate * apart);
  return shapes;
}

// (S9) u and v of one mode.
SHARED_FN ModeField modeField(SlabMode slab, Number depth, Number thickness, Number beam_rate) {
  Number k = slab.mode.rate;
  Number direct = exp(-beam_rate * depth);
  Number gained = slab.mode.gain * rateQuotient(k, beam_rate, depth);
  ModeField shapes = modeShapes(k, depth, thickness);
  ModeField field;
  field.sum = gained + slab.even * shapes.sum + slab.odd * shapes.difference;
  field.difference = (slab.mode.odd_source - slab.mode.gain) * direct + k * gained -
                     slab.even * k * k * shapes.difference - slab.odd * shapes.sum;
  return field;
}

// (S10) Mean of the direct light e^-Kt along a line of sight that comes down to `depth`, weighted m e^-m(z-t); and along
// one that comes up to it.
SHARED_FN Number beamAlongDownward(Number depth, Number beam_rate, Number view_rate) {
  return view_rate * rateQuotient(beam_rate, view_rate, depth);
}
SHARED_FN Number beamAlongUpward(Number depth, Number thickness, Number beam_rate, Number view_rate) {
  Number rest = thickness - depth;
  return view_rate * exp(-beam_rate * depth) * rest * decayMean((beam_rate + view_rate) * rest);
}

// (S10) The same means of u and v of one mode.
SHARED_FN ModeField modeAlongDownward(SlabMode slab, Number depth, Number thickness, Number beam_rate,
                                      Number view_rate) {
  Number k = slab.mode.rate;
  Number rest = thickness - depth;
  Number mirrored = depth * exp(-k * rest) * decayMean((view_rate + k) * depth);
  Number even = view_rate * (rateQuotient(k, view_rate, depth) + mirrored) / (Number(1.0f) + exp(-k * thickness));
  Number odd = modeShapes(k, depth, thickness).difference + halfTangent(k, thickness) * exp(-view_rate * depth) -
               even / view_rate;
  Number gained = slab.mode.gain * view_rate * rateQuotientOfThree(k, beam_rate, view_rate, depth);
  Number direct = beamAlongDownward(depth, beam_rate, view_rate);
  ModeField mean;
  mean.sum = gained + slab.even * even + slab.odd * odd;
  mean.difference = (slab.mode.odd_source - slab.mode.gain) * direct + k * gained - slab.even * k * k * odd -
                    slab.odd * even;
  return mean;
}
SHARED_FN ModeField modeAlongUpward(SlabMode slab, Number depth, Number thickness, Number beam_rate,
                                    Number view_rate) {
  Number k = slab.mode.rate;
  Number rest = thickness - depth;
  Number fading = exp(-view_rate * rest);
  Number mirrored = rest * exp(-k * depth) * decayMean((view_rate + k) * rest);
  Number even = view_rate * (rateQuotient(k, view_rate, rest) + mirrored) / (Number(1.0f) + exp(-k * thickness));
  Number odd = modeShapes(k, depth, thickness).difference - halfTangent(k, thickness) * fading + even / view_rate;
  Number direct = beamAlongUpward(depth, thickness, beam_rate, view_rate);
  Number gained = slab.mode.gain *
                  (view_rate * (rateQuotient(k, beam_rate, depth) - fading * rateQuotient(k, beam_rate, thickness)) +
                   direct) /
                  (view_rate + k);
  ModeField mean;
  mean.sum = gained + slab.even * even + slab.odd * odd;
  mean.difference = (slab.mode.odd_source - slab.mode.gain) * direct + k * gained - slab.even * k * k * odd -
                    slab.odd * even;
  return mean;
}

// Henyey and Greenstein's phase function over that of isotropic scattering, 4 pi p, at the cosine of the scattering
// angle  [1].
SHARED_FN Number henyeyGreenstein(Number asymmetry, Number cosine) {
  Number base = (Number(1.0f) - asymmetry) * (Number(1.0f) - asymmetry) +
                Number(2.0f) * asymmetry * (Number(1.0f) - cosine);
  return (Number(1.0f) - asymmetry * asymmetry) / (base * sqrt(base));
}
