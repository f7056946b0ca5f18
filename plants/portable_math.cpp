#include "plants/detail/portable_math.hpp"

#include <cmath>

// After fdlibm (Sun Microsystems 1993): its reductions and its polynomials.
namespace sunfleck::detail::portable {
namespace {

// An angle as k quarter turns and a rest within an eighth turn, the rest as a sum of two numbers.
struct Reduced {
  double high, low;  // [rad]
  int quarter;       // k modulo 4
};

// By pi / 2 in two parts of 33 bits and what is left of it.
Reduced reduced(double angle) {
  constexpr double kTwoOverPi = 6.36619772367581382433e-01;
  constexpr double kFirst = 1.57079632673412561417e+00;
  constexpr double kSecond = 6.07710050630396597660e-11, kRest = 2.02226624879595063154e-21;
  const double turns = std::nearbyint(angle * kTwoOverPi);
  const double coarse = angle - turns * kFirst;
  const double step = turns * kSecond;
  const double fine = coarse - step;
  const double correction = turns * kRest - ((coarse - fine) - step);
  const double high = fine - correction;
  return {high, (fine - high) - correction, static_cast<int>(static_cast<long long>(turns) & 3)};
}

double sineNearZero(double x, double low) {
  const double z = x * x;
  const double cubed = z * x;
  const double r =
      8.33333333332248946124e-03 +
      z * (-1.98412698298579493134e-04 +
           z * (2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
  return x - ((z * (0.5 * low - cubed * r) - low) - cubed * -1.66666666666666324348e-01);
}

double cosineNearZero(double x, double low) {
  const double z = x * x;
  const double r = z * (4.16666666666666019037e-02 +
                        z * (-1.38888888888741095749e-03 +
                             z * (2.48015872894767294178e-05 +
                                  z * (-2.75573143513906633035e-07 +
                                       z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
  const double half = 0.5 * z;
  const double w = 1. - half;
  return w + (((1. - w) - half) + (z * r - x * low));
}

double sineOf(const Reduced& angle) {
  const double size = angle.quarter % 2 == 0 ? sineNearZero(angle.high, angle.low)  //
                                             : cosineNearZero(angle.high, angle.low);
  return angle.quarter < 2 ? size : -size;
}

// Of a number >= 0.
double arctangentOf(double x) {
  struct Part {
    double high, low;
  };
  constexpr Part kHalf{4.63647609000806093515e-01, 2.26987774529616870924e-17};   // atan 0.5
  constexpr Part kOne{7.85398163397448278999e-01, 3.06161699786838301793e-17};    // atan 1
  constexpr Part kLarge{9.82793723247329054082e-01, 1.39033110312309984516e-17};  // atan 1.5
  constexpr Part kEnd{1.57079632679489655800e+00, 6.12323399573676603587e-17};    // pi / 2
  Part offset{0., 0.};
  if (x >= 2.4375) {
    offset = kEnd;
    x = -1. / x;
  } else if (x >= 1.1875) {
    offset = kLarge;
    x = (x - 1.5) / (1. + 1.5 * x);
  } else if (x >= 0.6875) {
    offset = kOne;
    x = (x - 1.) / (x + 1.);
  } else if (x >= 0.4375) {
    offset = kHalf;
    x = (2. * x - 1.) / (2. + x);
  }
  const double z = x * x;
  const double w = z * z;
  const double odd = z * (3.33333333333329318027e-01 +
                          w * (1.42857142725034663711e-01 +
                               w * (9.09088713343650656196e-02 +
                                    w * (6.66107313738753120669e-02 +
                                         w * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02)))));
  const double even =
      w *
      (-1.99999999998764832476e-01 +
       w * (-1.11111104054623557880e-01 +
            w * (-7.69187620504482999495e-02 + w * (-5.83357013379057348645e-02 + w * -3.65315727442169155270e-02))));
  return offset.high - ((x * (odd + even) - offset.low) - x);
}

constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;

double logarithm(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);  // [0.5, 1)
  if (mantissa < 0.70710678118654752440) {
    mantissa *= 2.;
    --exponent;
  }
  const double f = mantissa - 1.;
  const double s = f / (2. + f);
  const double z = s * s;
  const double w = z * z;
  const double r =
      z * (6.666666666666735130e-01 +
           w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01))) +
      w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const double half = 0.5 * f * f;
  const double k = exponent;
  return k * kLn2High - ((half - (s * (half + r) + k * kLn2Low)) - f);
}

double exponential(double x) {
  if (x > 709.) return std::ldexp(1., 1023);  // the largest that trees could ask for is far below
  if (x < -740.) return 0.;
  const double k = std::nearbyint(x * 1.44269504088896338700e+00);
  const double high = x - k * kLn2High, low = k * kLn2Low;
  const double rest = high - low;
  const double t = rest * rest;
  const double c =
      rest -
      t * (1.66666666666666019037e-01 +
           t * (-2.77777777770155933842e-03 +
                t * (6.61375632143793436117e-05 + t * (-1.65339022054652515390e-06 + t * 4.13813679705723846039e-08))));
  return std::ldexp(1. - ((low - (rest * c) / (2. - c)) - high), static_cast<int>(k));
}

}  // namespace

double sine(double angle) {
  return sineOf(reduced(angle));
}

double cosine(double angle) {
  Reduced turned = reduced(angle);
  turned.quarter = (turned.quarter + 1) % 4;
  return sineOf(turned);
}

double arctangent(double y, double x) {
  constexpr double kPi = 3.1415926535897931160e+00, kPiLow = 1.2246467991473531772e-16;
  const double up = std::abs(y), right = std::abs(x);
  if (up == 0. && right == 0.) return 0.;
  const double acute = right == 0. ? 0.5 * kPi : arctangentOf(up / right);
  const double upper = x < 0. ? kPi - (acute - kPiLow) : acute;
  return y < 0. ? -upper : upper;
}

double arccosine(double cosine) {
  return arctangent(std::sqrt((1. - cosine) * (1. + cosine)), cosine);
}

double power(double base, double exponent) {
  if (exponent == 0.) return 1.;
  if (base == 0.) return 0.;
  return exponential(exponent * logarithm(base));
}

double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}

}  // namespace sunfleck::detail::portable
