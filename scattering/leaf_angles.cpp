#include "scattering/leaf_angles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr double kUpright = 0.5 * std::numbers::pi;

// A point of a rule on (0, 1), by its distances from both ends, which keep their digits.
struct Point {
  double from_start, from_end, weight;
};

// Double exponential rule of Takahasi & Mori 1974: what the ends do, a root or an integrable pole, costs nothing.
std::vector<Point> doubleExponential(double step) {
  constexpr double kReach = 5.7;  // leaves out 1e-200 at each end: 1e-20 of the steepest beta distribution
  std::vector<Point> points;
  const int half = static_cast<int>(kReach / step);
  for (int k = -half; k <= half; ++k) {
    const double t = k * step, e = std::numbers::pi * std::sinh(t);
    const double start = 1. / (1. + std::exp(-e)), end = 1. / (1. + std::exp(e));
    points.push_back({start, end, step * std::numbers::pi * std::cosh(t) * start * end});
  }
  return points;
}

// Points of a rule with which a density is weighed [rad], its weight included.
struct Sample {
  double inclination, weight;
};

template <typename Density>
void addPanel(std::vector<Sample>& samples, const std::vector<Point>& points, const Density& density, double a,
              double b) {
  for (const Point& p : points) {
    const double from_a = (b - a) * p.from_start, from_b = (b - a) * p.from_end;
    const double inclination = from_a < from_b ? a + from_a : b - from_b;
    const double weight = p.weight * (b - a) * density(inclination, (kUpright - b) + from_b);
    if (weight > 0.) samples.push_back({inclination, weight});
  }
}

// Gauss's rule for the measure that `samples` stand for: the three-term recurrence of its orthonormal polynomials by
// Stieltjes' procedure, its nodes the eigenvalues of the recurrence's tridiagonal matrix, by counting those below a
// place (Sturm), its weights Christoffel's numbers (Gautschi 2004).
std::vector<Sample> gaussRule(const std::vector<Sample>& samples, int count) {
  double total = 0.;
  for (const Sample& s : samples) total += s.weight;
  std::vector<double> now(samples.size(), 1. / std::sqrt(total)), before(samples.size(), 0.);
  std::vector<double> centre(static_cast<std::size_t>(count)), link(static_cast<std::size_t>(count));  // link[0] unused
  for (std::size_t k = 0; k < centre.size(); ++k) {
    double mean = 0.;
    for (std::size_t i = 0; i < samples.size(); ++i)
      mean += samples[i].weight * samples[i].inclination * now[i] * now[i];
    centre[k] = mean;
    if (k + 1 == centre.size()) break;
    double square = 0.;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double next = (samples[i].inclination - centre[k]) * now[i] - (k > 0 ? link[k] * before[i] : 0.);
      before[i] = now[i];
      now[i] = next;
      square += samples[i].weight * next * next;
    }
    link[k + 1] = std::sqrt(square);
    for (double& value : now) value /= link[k + 1];
  }

  const auto below = [&](double x) {
    std::size_t negative = 0;
    double pivot = 1.;
    for (std::size_t k = 0; k < centre.size(); ++k) {
      pivot = centre[k] - x - (k > 0 ? link[k] * link[k] / pivot : 0.);
      if (pivot == 0.) pivot = 1e-300;
      if (pivot < 0.) ++negative;
    }
    return negative;
  };
  std::vector<Sample> rule;
  double sum = 0.;
  for (std::size_t r = 0; r < centre.size(); ++r) {
    double low = 0., high = kUpright;
    for (double middle = 0.5 * high; low < middle && middle < high; middle = 0.5 * (low + high))
      (below(middle) > r ? high : low) = middle;
    double value = 1., previous = 0., squares = 1.;
    for (std::size_t k = 0; k + 1 < centre.size(); ++k) {
      const double next = ((low - centre[k]) * value - (k > 0 ? link[k] * previous : 0.)) / link[k + 1];
      previous = value;
      value = next;
      squares += value * value;
    }
    rule.push_back({low, 1. / squares});
    sum += rule.back().weight;
  }
  for (Sample& node : rule) node.weight /= sum;
  return rule;
}

// A density of the inclination that needs no care near the ends.
template <typename Function>
auto plain(Function function) {
  return [function](double from_flat, double) { return function(from_flat); };
}

}  // namespace

// (P20)
LeafAngles::LeafAngles(Density density, std::vector<double> breaks) {
  // Between samples polynomials of degree 2 kNodes must be smooth: with 200 steps to a unit the nodes are right to
  // rounding, with 100 they are not.
  static const std::vector<Point> points = doubleExponential(1. / 200.);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) addPanel(samples, points, density, breaks[i], breaks[i + 1]);
  auto rule = std::make_shared<Rule>();
  rule->total = 0.;
  for (const Sample& s : samples) rule->total += s.weight;
  for (const Sample& s : gaussRule(samples, kNodes))
    rule->nodes.push_back({s.inclination, std::cos(s.inclination), std::sin(s.inclination), s.weight});
  rule->density = std::move(density);
  rule->breaks = std::move(breaks);
  rule_ = std::move(rule);
}

double LeafAngles::density(double inclination) const {
  if (!(rule_->breaks.front() <= inclination && inclination <= rule_->breaks.back())) return 0.;
  return rule_->density(inclination, kUpright - inclination) / rule_->total;
}

double LeafAngles::mean(const std::function<double(double)>& value, double kink) const {
  static const std::vector<Point> points = doubleExponential(1. / 14.);
  std::vector<double> breaks = rule_->breaks;
  if (breaks.front() < kink && kink < breaks.back())
    breaks.insert(std::lower_bound(breaks.begin(), breaks.end(), kink), kink);
  double sum = 0.;
  std::vector<Sample> samples;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    samples.clear();
    addPanel(samples, points, rule_->density, breaks[i], breaks[i + 1]);
    for (const Sample& s : samples) sum += s.weight * value(s.inclination);
  }
  return sum / rule_->total;
}

LeafAngles LeafAngles::spherical() {
  static const LeafAngles angles(plain([](double t) { return std::sin(t); }), {0., kUpright});
  return angles;
}

LeafAngles LeafAngles::planophile() {
  static const LeafAngles angles([](double, double rest) { return std::sin(rest) * std::sin(rest); }, {0., kUpright});
  return angles;
}

LeafAngles LeafAngles::erectophile() {
  static const LeafAngles angles(plain([](double t) { return std::sin(t) * std::sin(t); }), {0., kUpright});
  return angles;
}

LeafAngles LeafAngles::plagiophile() {
  static const LeafAngles angles(plain([](double t) { return std::sin(2. * t) * std::sin(2. * t); }), {0., kUpright});
  return angles;
}

LeafAngles LeafAngles::extremophile() {
  static const LeafAngles angles(plain([](double t) { return std::cos(2. * t) * std::cos(2. * t); }), {0., kUpright});
  return angles;
}

LeafAngles LeafAngles::uniform() {
  static const LeafAngles angles(plain([](double) { return 1.; }), {0., kUpright});
  return angles;
}

LeafAngles LeafAngles::ellipsoidal(double ratio) {
  require(1e-3 <= ratio && ratio <= 1e3, "ellipsoidal leaf angles: ratio", ratio, "within 1e-3 .. 1e3");
  // Campbell 1990; the rule normalises it.
  const auto density = [ratio](double t, double rest) {
    const double cosine = std::sin(rest), sine = std::sin(t);
    const double square = cosine * cosine + ratio * ratio * sine * sine;
    return sine / (square * square);
  };
  // Poles of the density come as near as 1 / ratio to the horizontal, or ratio to the vertical.
  std::vector<double> breaks{0.};
  if (ratio < 0.2 || ratio > 5.)
    for (double part : {0.1, 1., 10.}) breaks.push_back(std::atan(part / ratio));
  breaks.push_back(kUpright);
  return {density, breaks};
}

LeafAngles LeafAngles::beta(double mean, double deviation) {
  require(0. < mean && mean < kUpright, "beta leaf angles: mean", mean, "between 0 and pi/2 rad");
  require(1e-3 <= deviation && deviation * deviation < mean * (kUpright - mean), "beta leaf angles: deviation",
          deviation, "at least 1e-3 rad, and its square less than mean (pi/2 - mean)");
  const double part = mean / kUpright;
  const double sum = mean * (kUpright - mean) / (deviation * deviation) - 1.;
  const double p = sum * part, q = sum * (1. - part);
  require(std::min(p, q) >= kLeastBetaExponent, "beta leaf angles: exponents of this mean and deviation, the smaller",
          std::min(p, q), "at least 0.1");
  // By logarithms, and relative to the place where the mean is: neither factor can overflow.
  const auto density = [p, q, mean](double t, double rest) {
    const double least = std::numeric_limits<double>::min();
    return std::exp((p - 1.) * std::log(std::max(t, least) / mean) +
                    (q - 1.) * std::log(std::max(rest, least) / (kUpright - mean)));
  };
  std::vector<double> breaks{0.};
  for (double b : {mean - 8. * deviation, mean, mean + 8. * deviation})
    if (0. < b && b < kUpright) breaks.push_back(b);
  breaks.push_back(kUpright);
  return {density, breaks};
}

LeafAngles LeafAngles::table(std::vector<double> inclinations, std::vector<double> densities) {
  const std::size_t count = inclinations.size();
  require(count >= 2, "leaf angle table: number of inclinations", count, "at least 2");
  require(densities.size() == count, "leaf angle table: number of densities", densities.size(),
          "that of the inclinations, " + std::to_string(count));
  double greatest = 0.;
  for (std::size_t i = 0; i < count; ++i) {
    std::string place = " ";
    place += std::to_string(i + 1);
    // A degree table typed as radians may end a rounding beyond pi/2.
    require(inclinations[i] >= 0. && inclinations[i] <= kUpright * (1. + 1e-12),
            "leaf angle table: inclination" + place, inclinations[i], "within 0 .. pi/2 rad");
    inclinations[i] = std::min(inclinations[i], kUpright);
    require(i == 0 || inclinations[i] > inclinations[i - 1], "leaf angle table: inclination" + place, inclinations[i],
            "above the one before");
    require(densities[i] >= 0. && std::isfinite(densities[i]), "leaf angle table: density" + place, densities[i],
            "finite and not negative");
    greatest = std::max(greatest, densities[i]);
  }
  require(greatest > 0., "leaf angle table: largest density", greatest, "above 0");
  require(inclinations.back() - inclinations.front() >= 1e-9, "leaf angle table: range",
          inclinations.back() - inclinations.front(), "at least 1e-9 rad");
  for (double& d : densities) d /= greatest;
  const std::vector<double> breaks = inclinations;
  const auto density = [inclinations = std::move(inclinations), densities = std::move(densities)](double t, double) {
    const auto above = std::upper_bound(inclinations.begin() + 1, inclinations.end() - 1, t);
    const auto i = static_cast<std::size_t>(above - inclinations.begin());
    const double part = std::clamp((t - inclinations[i - 1]) / (inclinations[i] - inclinations[i - 1]), 0., 1.);
    return (1. - part) * densities[i - 1] + part * densities[i];
  };
  return {density, breaks};
}

LeafAngles LeafAngles::named(std::string_view name) {
  if (name == "spherical") return spherical();
  if (name == "planophile") return planophile();
  if (name == "erectophile") return erectophile();
  if (name == "plagiophile") return plagiophile();
  if (name == "extremophile") return extremophile();
  require(name == "uniform", "leaf angles", name,
          "spherical, planophile, erectophile, plagiophile, extremophile or uniform");
  return uniform();
}

}  // namespace sunfleck
