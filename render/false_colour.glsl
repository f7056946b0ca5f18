// Colours for numbers. This text is C++ (render/false_colour.hpp) and GLSL, on single precision.

// Viridis (N. Smith and S. van der Walt 2015, CC0), even to the eye from dark to bright, by a polynomial that M. Zucker
// fitted (CC0): sRGB codes, 0 .. 1, of a share of the range, which is cut at 0 and 1; what is not a number shows as 0.
SHARED_FN vec3 falseColour(Number share) {
  Number t = select(share > Number(0.0f), min(share, Number(1.0f)), Number(0.0f));
  vec3 sum = vec3(-5.435455855934631f, 4.645852612178535f, 26.3124352495832f);
  sum = sum * t + vec3(4.776384997670288f, -13.74514537774601f, -65.35303263337234f);
  sum = sum * t + vec3(6.228269936347081f, 14.17993336680509f, 56.69055260068105f);
  sum = sum * t + vec3(-4.634230498983486f, -5.799100973351585f, -19.33244095627987f);
  sum = sum * t + vec3(-0.3308618287255563f, 0.214847559468213f, 0.09509516302823659f);
  sum = sum * t + vec3(0.1050930431085774f, 1.404613529898575f, 1.384590162594685f);
  sum = sum * t + vec3(0.2777273272234177f, 0.005407344544966578f, 0.3340998053353061f);
  return clamp(sum, vec3(0.0f), vec3(1.0f));
}
