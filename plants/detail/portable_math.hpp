#pragma once

// The functions that trees are grown with, of basic operations and square roots alone, which IEEE 754 rounds in one way
// everywhere: C libraries choose theirs by the processor, and their last bits differ. Within 2 units of the last place
// of the true value, power() within (4 + 2 |y ln x|).
namespace sunfleck::detail::portable {

// Angles [rad], at most 1e5 in size.
double sine(double angle);
double cosine(double angle);

// The angle of the point (x, y) from +x towards +y [rad], in [-pi, pi]; 0 of the origin.
double arctangent(double y, double x);

// [rad], in [0, pi]; `cosine` in [-1, 1].
double arccosine(double cosine);

// base >= 0, finite; 1 where the exponent is 0.
double power(double base, double exponent);

// Length of (x, y); neither square overflows.
double length(double x, double y);

}  // namespace sunfleck::detail::portable
