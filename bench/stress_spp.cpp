// stress_spp [COUNT] [SEED] [FIRST]: evaluates the closed forms over arrays at COUNT random and corner places, those of
// the media FIRST, FIRST + 1, ... of SEED, and compares with double precision. Exit status 1 if anything broke, 2 for
// wrong usage. The same places for any number of threads.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <mutex>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "core/random.hpp"
#include "spp/forward_share.hpp"
#include "spp/mode_numbers.hpp"
#include "spp/slab_arrays.hpp"

namespace {

using namespace sunfleck;
using std::numbers::pi;

constexpr std::uint64_t kPlaces = 4096;  // of one medium
// For light of power 1; radiance above 1, which strong forward scattering has, is held relative to itself.
constexpr double kTolerance = 5e-6;
// Where nearly all light is thrown straight back, v of the slowest mode of the first azimuth order is a difference of
// numbers near 1 that weighs 20 and more in radiance: 8.2e-6 was met, above 5e-6 in 14 of 200 million places.
constexpr double kBackwardTolerance = 1e-5;
double radianceTolerance(int streams, double asymmetry) {
  return streams > 2 && asymmetry < -0.99 ? kBackwardTolerance : kTolerance;
}
// A half-space of isotropic scatterers that absorb nothing has P+ = 2.52 deep inside, under a sun overhead. Scatterers
// that throw all light back hold more of it, 8.7 met for g = -0.999.
constexpr double kMostPower = 10.;

enum Form { kSpp, kSppModes, kTwoStream, kNStream1, kNStream2, kNStream3, kNStream4, kNStream8, kForms };
constexpr const char* kNames[kForms] = {"spp", "spp, modes", "twostream", "n = 1", "n = 2", "n = 3", "n = 4", "n = 8"};
constexpr int kStreams[kForms] = {1, 1, 1, 1, 2, 3, 4, 8};

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

struct Drawn {
  Form form;
  double asymmetry = 0., albedo = 0., mu0 = 0.5;
  int orders = 1;
  double mu = 1., azimuth = 0.;
  std::vector<float> depth, thickness;

  spp::BeamInMedium beam() const { return {asymmetry, albedo, mu0}; }
};

spp::StreamConstants constantsOf(const Drawn& drawn) {
  if (drawn.form == kSppModes) return spp::sppConstants(drawn.beam());
  if (drawn.form == kTwoStream) return spp::twoStreamConstants(drawn.beam());
  return spp::nStreamConstants(drawn.beam(), kStreams[drawn.form], drawn.orders);
}

Drawn drawMedium(std::uint64_t seed, std::uint64_t index) {
  Draw draw{Random(seed, index)};
  Drawn drawn;
  drawn.form = static_cast<Form>(index % kForms);
  drawn.asymmetry = draw.asymmetry();
  drawn.albedo = draw.albedo();
  if (drawn.form >= kNStream1) drawn.orders = 1 + draw.upTo(std::min(3, 2 * kStreams[drawn.form]));
  std::vector<double> rates{1.};
  if (drawn.form != kSpp) {  // a mode's rate does not hang on the beam, but for SPP
    const spp::StreamConstants constants = constantsOf(drawn);
    for (const spp::StreamModes& modes : constants.orders)
      for (const double rate : modes.rate) rates.push_back(rate * constants.depth_scale);
  }
  drawn.mu0 = draw.cosine(rates);
  rates.push_back(1. / drawn.mu0);
  drawn.mu = (draw.oneIn(2) ? 1. : -1.) * draw.cosine(rates);
  drawn.azimuth = draw.oneIn(3) ? 0. : draw.uniform(0., 2. * pi);
  for (std::uint64_t i = 0; i < kPlaces; ++i) {
    drawn.thickness.push_back(draw.thickness());
    drawn.depth.push_back(draw.depth(drawn.thickness.back()));
  }
  return drawn;
}

std::string describe(const Drawn& drawn, std::size_t place) {
  char text[300];
  std::snprintf(text, sizeof text, "%s: g %.17g albedo %.17g mu0 %.17g orders %d mu %.17g azimuth %g w %.9g z %.9g",
                kNames[drawn.form], drawn.asymmetry, drawn.albedo, drawn.mu0, drawn.orders, drawn.mu, drawn.azimuth,
                double{drawn.thickness[place]}, double{drawn.depth[place]});
  return text;
}

// P+, P- and radiance at one place.
struct Light {
  double down = 0., up = 0., radiance = 0.;
};

template <int kN>
std::vector<Light> exactStreams(const Drawn& drawn, const spp::StreamConstants& constants) {
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
  std::vector<Light> result;
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

std::vector<Light> exactLight(const Drawn& drawn, const spp::StreamConstants& constants) {
  switch (kStreams[drawn.form]) {
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

// What went wrong with one form, and how far it was off at worst.
struct Tally {
  struct Worst {
    double error = -1.;
    std::uint64_t medium = 0;
    std::string place;
  };
  std::uint64_t places = 0, not_finite = 0, out_of_bounds = 0, off = 0;
  Worst power, radiance;

  static void note(Worst& worst, double error, std::uint64_t medium, const Drawn& drawn, std::size_t place) {
    if (error > worst.error || (error == worst.error && medium < worst.medium))
      worst = {error, medium, describe(drawn, place)};
  }
  void add(const Tally& other) {
    places += other.places;
    not_finite += other.not_finite;
    out_of_bounds += other.out_of_bounds;
    off += other.off;
    for (const auto member : {&Tally::power, &Tally::radiance}) {
      const Worst& theirs = other.*member;
      Worst& ours = this->*member;
      if (theirs.error > ours.error || (theirs.error == ours.error && theirs.medium < ours.medium)) ours = theirs;
    }
  }
};

Tally judged(const Drawn& drawn, std::uint64_t medium, const std::vector<Light>& exact, const std::vector<float>& down,
             const std::vector<float>& up, const std::vector<float>& radiance) {
  Tally tally{.places = exact.size()};
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double found[] = {double{down[i]}, double{up[i]}, double{radiance[i]}};
    if (!std::isfinite(found[0] + found[1] + found[2])) {
      ++tally.not_finite;
      Tally::note(tally.power, std::numeric_limits<double>::infinity(), medium, drawn, i);
      continue;
    }
    const double most = drawn.form == kSpp ? 1. + kTolerance : kMostPower;
    if (!(std::min({found[0], found[1], found[2]}) >= 0. && found[0] <= most && found[1] <= most))
      ++tally.out_of_bounds;
    const double power = std::max(std::abs(found[0] - exact[i].down), std::abs(found[1] - exact[i].up));
    const double seen = std::abs(found[2] - exact[i].radiance) / std::max(1., exact[i].radiance);
    if (!(power <= kTolerance && seen <= radianceTolerance(kStreams[drawn.form], drawn.asymmetry))) ++tally.off;
    Tally::note(tally.power, power, medium, drawn, i);
    Tally::note(tally.radiance, seen, medium, drawn, i);
  }
  return tally;
}

Tally evaluated(std::uint64_t seed, std::uint64_t index) {
  const Drawn drawn = drawMedium(seed, index);
  std::vector<float> down(kPlaces), up(kPlaces), radiance(kPlaces);
  if (drawn.form == kSpp) {
    const auto mu0 = static_cast<float>(drawn.mu0), albedo = static_cast<float>(drawn.albedo),
               share = static_cast<float>(spp::forwardShare(drawn.asymmetry, drawn.mu0));
    spp::sppPowers(drawn.depth, drawn.thickness, mu0, albedo, share, down, up);
    const bool downward = drawn.mu > 0.;
    std::vector<float> other_half(kPlaces);
    spp::sppRadiance(drawn.depth, drawn.thickness, mu0, albedo, share, downward ? radiance : other_half,
                     downward ? other_half : radiance);
    std::vector<Light> exact;
    for (std::uint64_t i = 0; i < kPlaces; ++i) {
      const auto light = spp::precise::sppPowers(double{drawn.depth[i]}, double{drawn.thickness[i]}, double{mu0},
                                                 double{albedo}, double{share});
      const double depth = std::clamp(double{drawn.depth[i]}, 0., double{drawn.thickness[i]});
      const auto sent = spp::precise::sppDiffuseRadiance(light, spp::precise::directPower(depth, double{mu0}));
      exact.push_back({light.down, light.up, downward ? sent.down : sent.up});
    }
    return judged(drawn, index, exact, down, up, radiance);
  }
  const spp::StreamConstants constants = constantsOf(drawn);
  const spp::StreamArrays arrays(constants);
  arrays.powers(drawn.depth, drawn.thickness, down, up);
  arrays.refinedRadiance(drawn.depth, drawn.thickness, spp::streamView<float>(constants, drawn.mu, drawn.azimuth),
                         radiance);
  return judged(drawn, index, exactLight(drawn, constants), down, up, radiance);
}

bool parse(const char* text, std::uint64_t& value) {
  const std::string_view all = text;
  const auto [end, error] = std::from_chars(all.begin(), all.end(), value);
  return error == std::errc{} && end == all.end();
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t numbers[3] = {100'000'000, 1, 0};  // COUNT, SEED, FIRST
  for (int i = 1; i < argc; ++i)
    if (i > 3 || !parse(argv[i], numbers[i - 1])) {
      std::fprintf(stderr, "usage: stress_spp [COUNT] [SEED] [FIRST]\n");
      return 2;
    }
  const auto [count, seed, first] = numbers;
  const auto start = std::chrono::steady_clock::now();
  Tally tallies[kForms];
  std::mutex tallying;
  tbb::parallel_for(first, first + (count + kPlaces - 1) / kPlaces, [&, seed = seed](std::uint64_t index) {
    const Tally tally = evaluated(seed, index);
    const std::lock_guard lock(tallying);
    tallies[index % kForms].add(tally);
  });
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  bool broken = false;
  std::uint64_t places = 0;
  for (int form = 0; form < kForms; ++form) {
    const Tally& tally = tallies[form];
    places += tally.places;
    broken |= tally.not_finite + tally.out_of_bounds + tally.off > 0;
    std::printf("%-10s %llu places, not finite %llu, out of bounds %llu, off by too much %llu\n", kNames[form],
                static_cast<unsigned long long>(tally.places), static_cast<unsigned long long>(tally.not_finite),
                static_cast<unsigned long long>(tally.out_of_bounds), static_cast<unsigned long long>(tally.off));
    std::printf("  powers to %.2g, medium %llu: %s\n", tally.power.error,
                static_cast<unsigned long long>(tally.power.medium), tally.power.place.c_str());
    std::printf("  radiance to %.2g, medium %llu: %s\n", tally.radiance.error,
                static_cast<unsigned long long>(tally.radiance.medium), tally.radiance.place.c_str());
  }
  std::printf("%llu places in %.1f s\n", static_cast<unsigned long long>(places), seconds.count());
  return broken ? 1 : 0;
}
