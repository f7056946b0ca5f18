// The GLSL face of the formulas shared with C++ (spp/slab.hpp is the other): what that text needs and GLSL lacks.
#define SHARED_FN
#define SHARED_IN(Type) Type
#define SHARED_CONSTANT const
#define Number float
#define Length float
#define InverseLength float

float select(bool condition, float a, float b) {
  return condition ? a : b;
}

// Of a relative error below 1.2e-7 (Press et al., Numerical Recipes: erfcc).
float erfc(float x) {
  float z = abs(x);
  float t = 1.0 / (1.0 + 0.5 * z);
  float tail = t * exp(-z * z - 1.26551223 +
                       t * (1.00002368 + t * (0.37409196 + t * (0.09678418 + t * (-0.18628806 + t * (0.27886807 +
                       t * (-1.13520398 + t * (1.48851587 + t * (-0.82215223 + t * 0.17087277)))))))));
  return x < 0.0 ? 2.0 - tail : tail;
}

// (-1)^n / (n + 1)!: the series of (1 - e^-x) / x, cut where less than half a rounding is left for |x| < 1/2.
const int kSeriesDegree = 7;
const float kDecaySeries[8] = float[8](1.0, -1.0 / 2.0, 1.0 / 6.0, -1.0 / 24.0, 1.0 / 120.0, -1.0 / 720.0, 1.0 / 5040.0,
                                       -1.0 / 40320.0);
