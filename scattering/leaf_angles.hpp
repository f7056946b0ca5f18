#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

namespace sunfleck {

// How leaves are inclined; their azimuths are uniform. The density g(theta) [1/rad] is over the inclination theta of
// the leaf's normal to the vertical, 0 .. pi/2, and integrates to 1 (Ross 1981). A value: copies share one rule.
class LeafAngles {
 public:
  // de Wit 1965, in the trigonometric form of Bunnik 1978
  static LeafAngles spherical();     // sin theta: as the surface of a sphere
  static LeafAngles planophile();    // (2/pi) (1 + cos 2 theta): mostly flat
  static LeafAngles erectophile();   // (2/pi) (1 - cos 2 theta): mostly upright
  static LeafAngles plagiophile();   // (2/pi) (1 - cos 4 theta): mostly oblique
  static LeafAngles extremophile();  // (2/pi) (1 + cos 4 theta): flat or upright
  static LeafAngles uniform();       // 2/pi: all inclinations alike
  // Campbell 1990: as the surface of an ellipsoid; ratio = horizontal over vertical axis [1], 1e-3 .. 1e3; 1 is
  // spherical.
  static LeafAngles ellipsoidal(double ratio);
  // Goel & Strebel 1984: beta distribution of 2 theta / pi with this mean and standard deviation of theta [rad].
  // deviation^2 < mean (pi/2 - mean) is what a beta distribution allows; deviation >= 1e-3, and neither exponent may
  // fall below kLeastBetaExponent, near which almost all leaves are exactly flat or exactly upright.
  static LeafAngles beta(double mean, double deviation);
  // Densities (any unit, >= 0) at two or more inclinations [rad] rising strictly within 0 .. pi/2, joined by straight
  // lines; no leaves outside.
  static LeafAngles table(std::vector<double> inclinations, std::vector<double> densities);

  // One of the names above that needs no number ("spherical" ...). All of these throw InvalidInput.
  static LeafAngles named(std::string_view name);

  // Gauss's rule for the density: exact for polynomials of theta up to degree 2 kNodes - 1. The weights sum to 1.
  struct Node {
    double inclination;   // [rad]
    double cosine, sine;  // of the inclination [1]
    double weight;        // [1]
  };
  const std::vector<Node>& nodes() const { return rule_->nodes; }

  // g [1/rad]; 0 outside 0 .. pi/2, huge at an end where a beta distribution has a pole.
  double density(double inclination) const;

  // Mean of `value`(inclination [rad]) over the leaves, to some 1e-12 where `value` is smooth but for a kink at
  // `kink` [rad]: far more evaluations than nodes().
  double mean(const std::function<double(double inclination)>& value, double kink) const;

  // The same rule, not merely an equal one: what was computed for one is true of the other.
  friend bool operator==(const LeafAngles& a, const LeafAngles& b) { return a.rule_ == b.rule_; }

  static constexpr int kNodes = 64;
  static constexpr double kLeastBetaExponent = 0.1;

 private:
  // g by the distances [rad] of the inclination from 0 and from pi/2, of which the smaller one has all its digits; any
  // unit. Smooth between the breaks, outside of which there are no leaves.
  using Density = std::function<double(double from_flat, double from_upright)>;
  struct Rule {
    Density density;
    std::vector<double> breaks;
    double total = 1.;
    std::vector<Node> nodes;
  };
  LeafAngles(Density density, std::vector<double> breaks);

  std::shared_ptr<const Rule> rule_;
};

}  // namespace sunfleck
