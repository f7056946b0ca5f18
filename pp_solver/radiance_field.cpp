#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/require.hpp"
#include "pp_solver/detail/first_scattering.hpp"
#include "pp_solver/detail/state.hpp"
#include "pp_solver/hot_spot.hpp"

namespace sunfleck::pp {
namespace {

using detail::BasisRows;
using detail::LayerRows;
using detail::ScaledLayer;
using detail::StackRows;

constexpr double kPi = std::numbers::pi;
constexpr double kAureole = 10. * kPi / 180.;  // how far from the beam the aureole is corrected [rad]
constexpr int kPeakMoments = 1024;             // as many moments of a peak are looked at

// Second divided difference of e^-xz at a, b, b.
double secondDifference(double a, double b, double z) {
  const double x = (a - b) * z;
  if (std::abs(x) > 0.5) return (z * std::exp(-b * z) - detail::onceDown(a, b, z)) / (a - b);
  double sum = 0., term = 0.5;  // z^2 e^-bz times the sum of (-x)^l / (l + 2)!
  for (int l = 0; l < 16; ++l) {
    sum += term;
    term *= -x / (l + 3.);
  }
  return z * z * std::exp(-b * z) * sum;
}

bool isFunction(const Sky& sky) {
  return std::holds_alternative<std::function<double(double, double)>>(sky);
}

// Where light is asked for: within each layer, the depths and what they are the answer to.
struct Levels {
  std::vector<double> z;    // scaled, from the layer's top; the first is 0, the last the bottom of a finite layer
  std::vector<int> output;  // index of the depth asked for, or -1
};

// Diffuse light that follows one direction, down and up, of each lane.
class Tracer {
  // What delta-M leaves out above a depth, of all layers together: omega f, and the moments of the peak, f_l / f.
  struct Peak {
    double scattered = 0.;
    std::vector<double> moments;
  };

 public:
  Tracer(Solver::State& state, std::span<const double> depths, std::span<const double> mus,
         std::span<const double> phis, std::span<double> result)
      : s_(state), depths_(depths), mus_(mus), phis_(phis), result_(result) {
    for (const double mu : mus) cosines_.push_back(std::abs(mu));
    std::sort(cosines_.begin(), cosines_.end());
    cosines_.erase(std::unique(cosines_.begin(), cosines_.end()), cosines_.end());
    levels_.resize(s_.layers.size());
    for (std::size_t p = 0; p < s_.layers.size(); ++p) levels_[p] = {{0.}, {-1}};
    for (std::size_t d = 0; d < depths.size(); ++d) {
      const auto [p, inside] = s_.placeAt(depths[d]);
      levels_[p].z.push_back(inside * s_.layers[p].scale);
      levels_[p].output.push_back(static_cast<int>(d));
    }
    for (std::size_t p = 0; p < s_.layers.size(); ++p)
      if (!std::isinf(s_.layers[p].thickness)) {
        levels_[p].z.push_back(s_.layers[p].thickness);
        levels_[p].output.push_back(-1);
      }
    for (std::size_t p = 0; p < s_.layers.size(); ++p)
      if (s_.layers[p].leaves) s_.tables[p]->setViews(cosines_);
    std::fill(result.begin(), result.end(), 0.);
  }

  void addModes(bool sine);
  void addWhole();    // what needs no azimuth series: sky seen directly, first scattering
  void addAureole();  // near the forward direction, downward
  void addHotSpot();  // at the top, upward

 private:
  // Extinction per scaled depth along the view, over |mu|.
  double viewRate(std::size_t p, double mu) const { return s_.projectionOf(p, mu) / mu; }
  double phaseInto(std::size_t p, double mu, double azimuth) const;
  void addBundle(const BasisRows& rows, bool sine, std::vector<double>& added);
  void followDirection(const BasisRows& rows, StackRows& stack, double mu, bool sine, double* down, double* up);
  void viewThroughLayer(const BasisRows& rows, LayerRows& row, std::size_t p, double mu, bool sine, double* down,
                        double* up);
  int modesWithLight() const;
  Peak peakAbove(double depth) const;

  Solver::State& s_;
  std::span<const double> depths_, mus_, phis_;
  std::span<double> result_;
  std::vector<double> cosines_;  // |mu|, each once
  std::vector<Levels> levels_;
  detail::RowMemory memory_;
};

int Tracer::modesWithLight() const {
  const bool sky = isFunction(s_.problem.above) || isFunction(s_.problem.below);
  int modes = 1;
  for (std::size_t p = 0; p < s_.layers.size(); ++p) {
    if (s_.layers[p].leaves) {
      modes = s_.settings.streams;
    } else {
      const auto& particles = std::get<Particles>(s_.problem.layers[p].medium);
      if (particles.albedo > 0. && (s_.beam > 0. || sky)) modes = std::max(modes, particles.phase.orders());
    }
  }
  if (s_.problem.ground.brdf) modes = std::max(modes, s_.problem.ground.brdf_modes);
  return std::min(modes, s_.settings.streams);
}

// What one layer adds between its edge and each level, [level * lanes + lane].
void Tracer::viewThroughLayer(const BasisRows& rows, LayerRows& row, std::size_t p, double mu, bool sine, double* down,
                              double* up) {
  const int lanes = rows.lanes, streams = s_.settings.streams;
  const ScaledLayer& layer = s_.layers[p];
  const auto& path = s_.pathOf(rows);
  const auto count = static_cast<std::size_t>(levels_[p].z.size());
  const double m = viewRate(p, mu);
  double *even = memory_.take(rows.row), *odd = memory_.take(rows.row), *rate = memory_.take(lanes);
  double *depth = memory_.take(count * lanes), *scratch = memory_.take(2 * rows.row);
  double share = 1.;
  if (row.given_modes) {
    share = s_.nodeView(rows, p, mu, even, odd);
  } else {
    double *scatter = memory_.take(static_cast<std::size_t>(streams) * lanes), *cosine = memory_.take(lanes),
           *first = memory_.take(lanes);
    for (int lane = 0; lane < lanes; ++lane) {
      const int mode = static_cast<int>(rows.mode[lane]);
      for (int j = 0; mode + j < streams; ++j) scatter[j * lanes + lane] = layer.scatter[mode + j];
      cosine[lane] = mu;
      first[lane] = legendreStart(rows, lane, mu);
    }
    path.scatterRows(rows, scatter, cosine, first, even, odd);
  }
  std::fill(rate, rate + lanes, m);
  for (std::size_t i = 0; i < count; ++i) std::fill_n(depth + i * lanes, lanes, levels_[p].z[i]);
  path.viewLayer(rows, row, {even, odd, rate, static_cast<int>(count), depth, down, up}, scratch);
  for (std::size_t i = 0; i < count * lanes; ++i) {
    down[i] *= share;
    up[i] *= share;
  }
  for (int lane = 0; lane < lanes; ++lane) {
    if (row.planck_top[lane] == 0. && row.planck_bottom[lane] == 0.) continue;
    const double slope = s_.planckSlope(row, lane), w = s_.layers[p].thickness;
    double turned = -mu * slope;  // h along mu (P14)
    if (row.given_modes) {
      for (int i = 0; i < s_.n; ++i) turned += odd[i] * row.drift[i] / rows.mu_root[i];
      turned *= share;
    } else {
      turned /= row.loss[1 * lanes + lane];
    }
    const double top = row.planck_top[lane] + turned, bottom = row.planck_bottom[lane] - turned;
    for (std::size_t i = 0; i < count; ++i) {
      const double z = levels_[p].z[i];
      down[i * lanes + lane] += slope * z - top * std::expm1(-m * z);
      up[i * lanes + lane] += std::isinf(w) ? bottom : slope * (z - w) - bottom * std::expm1(-m * (w - z));
    }
  }
  if (s_.settings.corrections || sine || s_.beam == 0.) return;
  for (int lane = 0; lane < lanes; ++lane) {
    double same, opposite;  // source of the beam's first scattering into mu, downward and upward
    s_.beamSource(rows, lane, p, mu, same, opposite);
    for (std::size_t i = 0; i < count; ++i) {
      down[i * lanes + lane] += same * m * detail::onceDown(row.rate[lane], m, levels_[p].z[i]);
      up[i * lanes + lane] += opposite * m * detail::onceUp(row.rate[lane], m, levels_[p].z[i], layer.thickness);
    }
  }
}

// The light of one direction at each depth asked for, [output * lanes + lane].
void Tracer::followDirection(const BasisRows& rows, StackRows& stack, double mu, bool sine, double* down, double* up) {
  const int lanes = rows.lanes;
  const std::size_t layers = s_.layers.size();
  std::vector<double*> down_in(layers), up_in(layers);
  for (std::size_t p = 0; p < layers; ++p) {
    down_in[p] = memory_.take(levels_[p].z.size() * lanes);
    up_in[p] = memory_.take(levels_[p].z.size() * lanes);
    viewThroughLayer(rows, stack.layer[p], p, mu, sine, down_in[p], up_in[p]);
  }
  for (int lane = 0; lane < lanes; ++lane) {
    double carried = 0.;
    for (std::size_t p = 0; p < layers; ++p) {
      const double m = viewRate(p, mu), entering = carried;
      for (std::size_t i = 0; i < levels_[p].z.size(); ++i) {
        carried = entering * std::exp(-m * levels_[p].z[i]) + down_in[p][i * lanes + lane];
        if (levels_[p].output[i] >= 0) down[levels_[p].output[i] * lanes + lane] = carried;
      }
    }
    carried = s_.groundRadiance(rows, stack, lane, mu, sine);
    for (std::size_t p = layers; p-- > 0;) {
      const double m = viewRate(p, mu), w = s_.layers[p].thickness, entering = carried;
      for (std::size_t i = levels_[p].z.size(); i-- > 0;) {
        const double z = levels_[p].z[i];
        carried = (std::isinf(w) ? 0. : entering * std::exp(-m * (w - z))) + up_in[p][i * lanes + lane];
        if (levels_[p].output[i] >= 0) up[levels_[p].output[i] * lanes + lane] = carried;
      }
    }
  }
}

void Tracer::addBundle(const BasisRows& rows, bool sine, std::vector<double>& added) {
  s_.solveBundle(rows, s_.bundle_stack, sine);
  const int lanes = rows.lanes;
  const double phi0 = s_.problem.beam ? s_.problem.beam->azimuth : 0.;
  for (const double cosine : cosines_) {
    memory_.clear();
    double *down = memory_.take(depths_.size() * lanes), *up = memory_.take(depths_.size() * lanes);
    followDirection(rows, s_.bundle_stack, cosine, sine, down, up);
    for (std::size_t i = 0; i < mus_.size(); ++i) {
      if (std::abs(mus_[i]) != cosine) continue;
      const double* value = mus_[i] > 0. ? down : up;
      for (std::size_t d = 0; d < depths_.size(); ++d)
        for (int lane = 0; lane < lanes; ++lane) {
          const double m = rows.mode[lane], size = value[d * lanes + lane];
          if (m >= s_.settings.streams) continue;
          added[lane] = std::max(added[lane], std::abs(size));
          for (std::size_t j = 0; j < phis_.size(); ++j) {
            const double angle = m * (phis_[j] - phi0);
            result_[(d * mus_.size() + i) * phis_.size() + j] += size * (sine ? std::sin(angle) : std::cos(angle));
          }
        }
    }
  }
}

void Tracer::addModes(bool sine) {
  const int modes = modesWithLight();
  // Light from a ground or a sky may leave out any number of modes: the series does not end before theirs.
  const int given = isFunction(s_.problem.above) || isFunction(s_.problem.below)
                        ? modes
                        : std::min(modes, s_.problem.ground.brdf ? s_.problem.ground.brdf_modes : 0);
  int small = 0;
  for (int first = sine ? 1 : 0; first < modes;) {
    const BasisRows& rows = s_.bundle(first);
    std::vector<double> added(rows.lanes, 0.);
    addBundle(rows, sine, added);
    double largest = 0.;
    for (const double value : result_) largest = std::max(largest, std::abs(value));
    for (int lane = 0; lane < rows.lanes && first + lane < modes; ++lane)
      small = added[lane] <= s_.settings.azimuth_tolerance * largest ? small + 1 : 0;
    first += rows.lanes;
    s_.modes_used = std::max(s_.modes_used, std::min(first, modes));
    if (small >= 2 && first >= given) break;
  }
}

// (P13) Share of the beam's light, per scaled depth along the view, that one scattering turns into it [1/sr]: by the
// whole phase function, in the scaled medium (TMS of Nakajima & Tanaka 1988).
double Tracer::phaseInto(std::size_t p, double mu, double azimuth) const {
  return scatteredInto(s_.problem.layers[p].medium, mu, s_.mu0, azimuth) /
         (s_.layers[p].scale * s_.projectionOf(p, std::abs(mu)));
}

void Tracer::addWhole() {
  const double phi0 = s_.problem.beam ? s_.problem.beam->azimuth : 0.;
  const auto skyAlong = [](const Sky& sky, double mu, double phi) {
    if (const double* radiance = std::get_if<double>(&sky)) return *radiance;
    const auto& function = std::get<1>(sky);
    return function ? function(mu, phi) : 0.;
  };
  for (std::size_t i = 0; i < mus_.size(); ++i)
    for (std::size_t j = 0; j < phis_.size(); ++j) {
      const bool downward = mus_[i] > 0.;
      const double mu = std::abs(mus_[i]);
      const auto result = [&](int output) -> double& {
        return result_[(static_cast<std::size_t>(output) * mus_.size() + i) * phis_.size() + j];
      };
      double carried = downward ? skyAlong(s_.problem.above, mu, phis_[j])
                                : (std::isinf(s_.depth) ? 0. : skyAlong(s_.problem.below, mu, phis_[j]));
      if (!downward && !std::isinf(s_.depth) && s_.problem.ground.brdf)
        for (int m = 0; m < s_.problem.ground.brdf_modes; ++m)
          carried += s_.beamOnGround() * s_.problem.ground.brdf(m, mu, s_.mu0) * std::cos(m * (phis_[j] - phi0));
      for (std::size_t step = 0; step < s_.layers.size(); ++step) {
        const std::size_t p = downward ? step : s_.layers.size() - 1 - step;
        const ScaledLayer& layer = s_.layers[p];
        const double m = viewRate(p, mu), w = layer.thickness, rate = layer.projection / s_.mu0;
        double source = 0.;
        if (s_.settings.corrections && s_.beam > 0.)
          source = s_.beam * s_.scaledBeam(p) * phaseInto(p, mus_[i], phis_[j] - phi0);
        const double entering = carried;
        const auto at = [&](double z) {
          if (downward) return entering * std::exp(-m * z) + source * m * detail::onceDown(rate, m, z);
          return (std::isinf(w) ? 0. : entering * std::exp(-m * (w - z))) + source * m * detail::onceUp(rate, m, z, w);
        };
        for (std::size_t k = 0; k < levels_[p].z.size(); ++k)
          if (levels_[p].output[k] >= 0) result(levels_[p].output[k]) += at(levels_[p].z[k]);
        carried = downward ? (std::isinf(w) ? 0. : at(w)) : at(0.);
      }
    }
}

Tracer::Peak Tracer::peakAbove(double depth) const {
  Peak peak;
  double path = 0., scattered = 0.;
  std::vector<double> moments(kPeakMoments), sums(kPeakMoments, 0.);
  for (std::size_t p = 0; p < s_.layers.size(); ++p) {
    const ScaledLayer& layer = s_.layers[p];
    const double inside = std::clamp(depth - layer.top, 0., layer.true_thickness);
    path += inside;
    if (layer.scale == 1. || !(inside > 0.)) continue;
    const auto& particles = std::get<Particles>(s_.problem.layers[p].medium);
    const double peaked = (1. - layer.scale) * inside;  // omega f times depth
    scattered += peaked;
    particles.phase.moments(moments);
    const double f = (1. - layer.scale) / layer.albedo;
    for (int l = 0; l < kPeakMoments; ++l) sums[l] += peaked * (l < s_.settings.streams ? 1. : moments[l] / f);
  }
  if (!(scattered > 0.)) return peak;
  peak.scattered = scattered / path;
  while (!sums.empty() && std::abs(sums.back()) < 1e-12 * scattered) sums.pop_back();
  for (const double sum : sums) peak.moments.push_back(sum / scattered);
  return peak;
}

// (P13) The second order of the peak that delta-M takes for unscattered light, near the beam's direction (IMS of
// Nakajima & Tanaka 1988): the scaled beam holds all of it in one direction, in truth it is spread.
void Tracer::addAureole() {
  if (s_.beam == 0.) return;
  const double phi0 = s_.problem.beam->azimuth, sine0 = std::sqrt((1. - s_.mu0) * (1. + s_.mu0));
  for (std::size_t d = 0; d < depths_.size(); ++d) {
    const Peak peak = peakAbove(depths_[d]);
    if (peak.scattered == 0.) continue;
    for (std::size_t i = 0; i < mus_.size(); ++i) {
      if (mus_[i] < 0.) continue;
      const double mu = mus_[i], sines = sine0 * std::sqrt((1. - mu) * (1. + mu));
      const double kappa = (1. - peak.scattered) / s_.mu0;
      const double path = secondDifference(1. / mu, kappa, depths_[d]) / (mu * s_.mu0) * (1. - peak.scattered);
      for (std::size_t j = 0; j < phis_.size(); ++j) {
        const double cosine = std::clamp(sines * std::cos(phis_[j] - phi0) + s_.mu0 * mu, -1., 1.);
        if (std::acos(cosine) > kAureole) continue;
        double sum = 0., now = 1., before = 0.;
        for (std::size_t l = 0; l < peak.moments.size(); ++l) {
          const double order = static_cast<double>(l), part = peak.moments[l];
          sum += (2. * order + 1.) * part * (2. - part) * now;
          const double next = ((2. * order + 1.) * cosine * now - order * before) / (order + 1.);
          before = now;
          now = next;
        }
        result_[(d * mus_.size() + i) * phis_.size() + j] -=
            s_.beam / (4. * kPi) * peak.scattered * peak.scattered / (1. - peak.scattered) * sum * path;
      }
    }
  }
}

// (P22), and what (P11) takes from the light of higher orders, from each direction alike.
void Tracer::addHotSpot() {
  const auto& leaves = std::get<LeafScattering>(s_.problem.layers[0].medium);
  const double w = s_.layers[0].thickness, phi0 = s_.problem.beam->azimuth, albedo = s_.problem.ground.albedo;
  for (std::size_t i = 0; i < mus_.size(); ++i)
    for (std::size_t j = 0; j < phis_.size(); ++j) {
      if (mus_[i] > 0.) continue;
      const SunAndView at{.thickness = w, .mu0 = s_.mu0, .mu = -mus_[i], .azimuth = phis_[j] - phi0};
      const ScatteredOnce once = scatteredOnceTurbid(leaves, at), excess = hotSpotExcess(leaves, at);
      const double ground = albedo / kPi * s_.mu0;
      for (std::size_t d = 0; d < depths_.size(); ++d) {
        if (depths_[d] > 0.) continue;
        double& value = result_[(d * mus_.size() + i) * phis_.size() + j];
        const double first = s_.beam * (once.leaves + ground * once.gap);
        value = first + s_.beam * (excess.leaves + ground * excess.gap) + s_.hot_spot.again * (value - first);
      }
    }
}

}  // namespace

void Solver::radiances(std::span<const double> depths, std::span<const double> mus, std::span<const double> phis,
                       std::span<double> result) {
  State& s = solved();
  require(result.size() == depths.size() * mus.size() * phis.size(), "size of result", result.size(),
          "depths x mus x phis");
  for (const double mu : mus)
    require(std::abs(mu) >= kLeastCosine && std::abs(mu) <= 1., "mu", mu, "in [-1, 1] and not 0 (1e-100 or more)");
  for (const double phi : phis) require(std::isfinite(phi), "phi", phi, "finite");
  s.modes_used = 0;
  Tracer tracer(s, depths, mus, phis, result);
  tracer.addModes(false);
  if (isFunction(s.problem.above) || isFunction(s.problem.below)) tracer.addModes(true);
  tracer.addWhole();
  if (s.settings.corrections) tracer.addAureole();
  if (s.hasHotSpot()) tracer.addHotSpot();
}

}  // namespace sunfleck::pp
