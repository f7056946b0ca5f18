// From radiances to what a screen shows. This text is C++ (render/tone_mapping.hpp) and GLSL, on single precision:
// values in, values out; literals with f; no branch on a Number but select().

// The curves by their number.
const int kClampCurve = 0;   // light as it is, cut at the screen's brightest
const int kFilmicCurve = 1;  // an S: shadows a little deeper, highlights that fade into white

// ACES filmic curve as K. Narkowicz 2016 fits it: 0 to 0, without end to 1.033, where it is cut.
SHARED_FN Number filmicLight(Number light) {
  return light * (Number(2.51f) * light + Number(0.03f)) /
         (light * (Number(2.43f) * light + Number(0.59f)) + Number(0.14f));
}

// Light that the screen shows [1], 0 .. 1, of exposed radiance [1]. What is not a number shows as black; beyond 1e6 the
// filmic curve has ended.
SHARED_FN Number shownLight(int curve, Number light) {
  Number above = select(light > Number(0.0f), light, Number(0.0f));
  Number shaped = select(curve == kFilmicCurve, filmicLight(min(above, Number(1.0e6f))), above);
  return min(shaped, Number(1.0f));
}

// IEC 61966-2-1: linear light to the code of an sRGB picture, both 0 .. 1.
SHARED_FN Number srgbCode(Number light) {
  return select(light <= Number(0.0031308f), Number(12.92f) * light,
                Number(1.055f) * pow(light, Number(1.0f) / Number(2.4f)) - Number(0.055f));
}

// The other way: the light that a code stands for.
SHARED_FN Number srgbLight(Number code) {
  return select(code <= Number(0.04045f), code / Number(12.92f),
                pow((code + Number(0.055f)) / Number(1.055f), Number(2.4f)));
}
