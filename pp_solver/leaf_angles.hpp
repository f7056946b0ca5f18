#pragma once

#include <vector>

namespace sunfleck::pp {

// How leaves are inclined; their azimuths are uniform. The density g(theta) [1/rad] is over the inclination theta of
// the leaf's normal to the vertical, 0 .. pi/2, and integrates to 1 (Ross 1981).
class LeafAngles {
 public:
  // de Wit 1965, Bunnik 1978
  static LeafAngles spherical();     // sin theta: as the surface of a sphere
  static LeafAngles planophile();    // mostly flat
  static LeafAngles erectophile();   // mostly upright
  static LeafAngles plagiophile();   // mostly oblique
  static LeafAngles extremophile();  // flat or upright
  static LeafAngles uniform();       // all inclinations alike
  // Campbell 1990: as the surface of an ellipsoid; ratio = horizontal over vertical axis, 1 is spherical, > 0.
  static LeafAngles ellipsoidal(double ratio);
  // Goel & Strebel 1984: beta distribution of 2 theta / pi with this mean and standard deviation of theta [rad].
  static LeafAngles beta(double mean, double deviation);
  // Densities (any unit) at inclinations [rad] rising strictly within 0 .. pi/2, joined by straight lines.
  static LeafAngles table(std::vector<double> inclinations, std::vector<double> densities);

  // One of the names above that needs no number ("spherical" ...). Throws InvalidInput for another.
  static LeafAngles named(const char* name);

  // Quadrature over the inclination: sum of weights is 1.
  struct Node {
    double inclination;  // [rad]
    double weight;       // [1]
  };
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  std::vector<Node> nodes_;
};

}  // namespace sunfleck::pp
