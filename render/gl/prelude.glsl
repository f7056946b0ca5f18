// The GLSL face of the formulas shared with C++ (spp/slab.hpp is the other): what that text needs and GLSL lacks.
#define SHARED_FN
#define Number float
#define Length float
#define InverseLength float

// e^x - 1. The series is cut after x^8, whose successor is below 1.1e-8 of the sum for |x| < 1/2; beyond that the
// subtraction loses at most a factor e^x / |e^x - 1| < 2.6 of exp's own relative error.
float expm1(float x) {
  if (abs(x) >= 0.5) return exp(x) - 1.0;
  float series = 1.0 / 40320.0;
  series = series * x + 1.0 / 5040.0;
  series = series * x + 1.0 / 720.0;
  series = series * x + 1.0 / 120.0;
  series = series * x + 1.0 / 24.0;
  series = series * x + 1.0 / 6.0;
  series = series * x + 0.5;
  series = series * x + 1.0;
  return series * x;
}
