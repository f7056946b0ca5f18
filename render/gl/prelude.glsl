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

// (-1)^n / (n + 1)!: the series of (1 - e^-x) / x, cut where less than half a rounding is left for |x| < 1/2.
const int kSeriesDegree = 7;
const float kDecaySeries[8] = float[8](1.0, -1.0 / 2.0, 1.0 / 6.0, -1.0 / 24.0, 1.0 / 120.0, -1.0 / 720.0, 1.0 / 5040.0,
                                       -1.0 / 40320.0);
