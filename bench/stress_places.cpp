#include "bench/stress_places.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <numbers>

#include "core/random.hpp"
#include "spp/forward_share.hpp"
#include "spp/mode_numbers.hpp"
#include "spp/slab.hpp"
#include "spp/stream_view.hpp"

namespace sunfleck::stress {
namespace {

using std::numbers::pi;

struct Draw {
  Random random;

  double uniform() { return double{random.uniform()}; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  int upTo(int count) { return std::min(static_cast<int>(uniform() * count), count - 1); }
  bool oneIn(int count) { return upTo(count) == 0; }

  double albedo() {
    switch (upTo(6)) {
      case 0:
        return 1.;
      case 1:
        return 1. - 0x1p-24;
      case 2:
        return oneIn(4) ? 0. : uniform();
      case 3:
        return 1. - std::pow(10., uniform(-15., 0.));
      default:
        return double{static_cast<float>(uniform())};
    }
  }
  double asymmetry() {
    switch (upTo(5)) {
      case 0:
        return 0.;
      case 1:
        return oneIn(2) ? 0.999 : -0.999;
      default:
        return uniform(-0.999, 0.999);
    }
  }
  // In (0, 1]: of a beam or a line of sight. `rates`: of what it may be in resonance with.
  double cosine(const std::vector<double>& rates) {
    switch (upTo(6)) {
      case 0:
        return 1.;
      case 1:
        return oneIn(3) ? 1e-7 : std::pow(10., uniform(-7., 0.));
      case 2:
      case 3: {
        const double rate = rates[static_cast<std::size_t>(upTo(static_cast<int>(rates.size())))];
        const double shift = oneIn(2) ? 0. : std::ldexp(oneIn(2) ? 1. : -1., -upTo(50));
        const double resonant = (1. + shift) / rate;
        return resonant > 1e-7 && resonant <= 1. ? resonant : uniform(0.01, 1.);
      }
      default:
        return uniform(0.001, 1.);
    }
  }
  float thickness() {
    switch (upTo(10)) {
      case 0:
        return 0.f;
      case 1:
        return std::numeric_limits<float>::infinity();
      case 2:
        return static_cast<float>(std::pow(10., uniform(-30., 30.)));
      case 3:
        return oneIn(2) ? 1e-30f : 1e30f;
      case 4:
      case 5:
        return static_cast<float>(std::pow(10., uniform(-4., 5.)));
      default:
        return static_cast<float>(uniform(0., 20.));
    }
  }
  float depth(float thickness) {
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    const float end = std::min(thickness, 1e30f);
    switch (upTo(8)) {
      case 0:
        return oneIn(2) ? 0.f : -std::numeric_limits<float>::denorm_min();
      case 1:
        return oneIn(2) ? thickness : std::nextafter(thickness, kInfinite);
      case 2:
        return static_cast<float>(std::min(double{end}, std::pow(10., uniform(-30., 30.))));
      case 3:
        return std::max(0.f, std::nextafter(end, 0.f));
      case 4:
        return static_cast<float>(std::min(double{end}, uniform(0., 10.)));
      default:
        return static_cast<float>(double{end} * uniform());
    }
  }
};

template <int kN>
std::vector<StressLight> exactStreams(const StressPlaces& drawn, const spp::StreamConstants& constants) {
  using Formulas = spp::StreamFormulas<double, kN>;
  const std::vector<double> numbers = spp::modeNumbers<double>(constants);
  std::vector<typename Formulas::StreamModes> orders(constants.orders.size());
  std::memcpy(orders.data(), numbers.data(), numbers.size() * sizeof(double));
  const spp::PowerWeights powers = spp::powerWeights(constants);
  const auto view = spp::streamView<double>(constants, drawn.mu, drawn.azimuth);
  const auto weightsOf = [](const std::vector<double>& sum, const std::vector<double>& difference, std::size_t order) {
    typename Formulas::ModeWeights weights;
    std::copy_n(sum.begin() + static_cast<std::ptrdiff_t>(order * kN), kN, weights.sum);
    std::copy_n(difference.begin() + static_cast<std::ptrdiff_t>(order * kN), kN, weights.difference);
    return weights;
  };
  const auto power_weights = weightsOf(powers.power_sum, powers.power_difference, 0);
  std::vector<StressLight> result;
  for (std::size_t i = 0; i < drawn.depth.size(); ++i) {
    const auto at = Formulas::slabPlace(double{drawn.depth[i]}, double{drawn.thickness[i]}, constants.depth_scale,
                                        constants.beam_rate);
    const auto light = Formulas::streamPowers(orders[0], power_weights, at);
    const bool downward = drawn.mu > 0.;
    const double fade = std::exp(-view.rate * (downward ? at.depth : at.rest));
    const double beam =
        downward ? Formulas::beamAlongDownward(at, view.rate, fade) : Formulas::beamAlongUpward(at, view.rate, fade);
    double radiance = view.beam_source * beam;
    for (std::size_t m = 0; m < orders.size(); ++m)
      radiance += Formulas::streamRadiance(orders[m], weightsOf(view.seen_sum, view.seen_difference, m), at, downward,
                                           view.rate, fade, beam);
    result.push_back({light.down, light.up, std::max(radiance, 0.)});
  }
  return result;
}

std::vector<StressLight> exactSpp(const StressPlaces& drawn) {
  const auto mu0 = double{static_cast<float>(drawn.mu0)}, albedo = double{static_cast<float>(drawn.albedo)},
             share = double{drawn.forwardShare()};
  std::vector<StressLight> result;
  for (std::size_t i = 0; i < drawn.depth.size(); ++i) {
    const double depth = double{drawn.depth[i]}, thickness = double{drawn.thickness[i]};
    const auto light = spp::precise::sppPowers(depth, thickness, mu0, albedo, share);
    const double direct = spp::precise::directPower(std::clamp(depth, 0., thickness), mu0);
    const auto sent = spp::precise::sppDiffuseRadiance(light, direct);
    result.push_back({light.down, light.up, drawn.mu > 0. ? sent.down : sent.up});
  }
  return result;
}

}  // namespace

float StressPlaces::forwardShare() const {
  return static_cast<float>(spp::forwardShare(asymmetry, mu0));
}

spp::StreamConstants StressPlaces::constants() const {
  const spp::BeamInMedium beam(asymmetry, albedo, mu0);
  if (form == kSppModes) return spp::sppConstants(beam);
  if (form == kTwoStream) return spp::twoStreamConstants(beam);
  return spp::nStreamConstants(beam, streams(), orders);
}

StressPlaces drawPlaces(std::uint64_t seed, std::uint64_t index, std::size_t count) {
  Draw draw{Random(seed, index)};
  StressPlaces drawn;
  drawn.form = static_cast<Form>(index % kForms);
  drawn.asymmetry = draw.asymmetry();
  drawn.albedo = draw.albedo();
  if (drawn.form >= kNStream1) drawn.orders = 1 + draw.upTo(std::min(3, 2 * drawn.streams()));
  std::vector<double> rates{1.};
  if (drawn.form != kSpp) {  // a mode's rate does not hang on the beam, but for SPP
    const spp::StreamConstants constants = drawn.constants();
    for (const spp::StreamModes& modes : constants.orders)
      for (const double rate : modes.rate) rates.push_back(rate * constants.depth_scale);
  }
  drawn.mu0 = draw.cosine(rates);
  rates.push_back(1. / drawn.mu0);
  drawn.mu = (draw.oneIn(2) ? 1. : -1.) * draw.cosine(rates);
  drawn.azimuth = draw.oneIn(3) ? 0. : draw.uniform(0., 2. * pi);
  for (std::size_t i = 0; i < count; ++i) {
    drawn.thickness.push_back(draw.thickness());
    drawn.depth.push_back(draw.depth(drawn.thickness.back()));
  }
  return drawn;
}

std::vector<StressLight> exactLight(const StressPlaces& drawn) {
  if (drawn.form == kSpp) return exactSpp(drawn);
  const spp::StreamConstants constants = drawn.constants();
  switch (drawn.streams()) {
    case 1:
      return exactStreams<1>(drawn, constants);
    case 2:
      return exactStreams<2>(drawn, constants);
    case 3:
      return exactStreams<3>(drawn, constants);
    case 4:
      return exactStreams<4>(drawn, constants);
    default:
      return exactStreams<8>(drawn, constants);
  }
}

StressLight lightError(const StressLight& found, const StressLight& exact) {
  return {std::abs(found.down - exact.down), std::abs(found.up - exact.up),
          std::abs(found.radiance - exact.radiance) / std::max(1., exact.radiance)};
}

std::string describe(const StressPlaces& drawn, std::size_t place) {
  char text[300];
  std::snprintf(text, sizeof text, "%s: g %.17g albedo %.17g mu0 %.17g orders %d mu %.17g azimuth %g w %.9g z %.9g",
                kFormNames[drawn.form], drawn.asymmetry, drawn.albedo, drawn.mu0, drawn.orders, drawn.mu, drawn.azimuth,
                double{drawn.thickness[place]}, double{drawn.depth[place]});
  return text;
}

}  // namespace sunfleck::stress
