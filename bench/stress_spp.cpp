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
#include <limits>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "bench/stress_places.hpp"
#include "spp/slab_arrays.hpp"

namespace {

using namespace sunfleck;
using stress::StressLight;
using stress::StressPlaces;

constexpr std::uint64_t kPlaces = 4096;  // of one medium
constexpr double kTolerance = 5e-6;      // of what lightError() tells
// Where nearly all light is thrown straight back, v of the slowest mode of the first azimuth order is a difference of
// numbers near 1 that weighs 20 and more in radiance: 8.2e-6 was met, above 5e-6 in 14 of 200 million places.
constexpr double kBackwardTolerance = 1e-5;
double radianceTolerance(const StressPlaces& drawn) {
  return drawn.streams() > 2 && drawn.asymmetry < -0.99 ? kBackwardTolerance : kTolerance;
}
// A half-space of isotropic scatterers that absorb nothing has P+ = 2.52 deep inside, under a sun overhead. Scatterers
// that throw all light back hold more of it, 8.7 met for g = -0.999.
constexpr double kMostPower = 10.;

// What went wrong with one form, and how far it was off at worst.
struct Tally {
  struct Worst {
    double error = -1.;
    std::uint64_t medium = 0;
    std::string place;
  };
  std::uint64_t places = 0, not_finite = 0, out_of_bounds = 0, off = 0;
  Worst power, radiance;

  static void note(Worst& worst, double error, std::uint64_t medium, const StressPlaces& drawn, std::size_t place) {
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

Tally judged(const StressPlaces& drawn, std::uint64_t medium, const std::vector<StressLight>& exact,
             const std::vector<float>& down, const std::vector<float>& up, const std::vector<float>& radiance) {
  Tally tally{.places = exact.size()};
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const StressLight found{double{down[i]}, double{up[i]}, double{radiance[i]}};
    if (!std::isfinite(found.down + found.up + found.radiance)) {
      ++tally.not_finite;
      Tally::note(tally.power, std::numeric_limits<double>::infinity(), medium, drawn, i);
      continue;
    }
    const double most = drawn.form == stress::kSpp ? 1. + kTolerance : kMostPower;
    if (!(std::min({found.down, found.up, found.radiance}) >= 0. && found.down <= most && found.up <= most))
      ++tally.out_of_bounds;
    const StressLight error = lightError(found, exact[i]);
    const double power = std::max(error.down, error.up);
    if (!(power <= kTolerance && error.radiance <= radianceTolerance(drawn))) ++tally.off;
    Tally::note(tally.power, power, medium, drawn, i);
    Tally::note(tally.radiance, error.radiance, medium, drawn, i);
  }
  return tally;
}

Tally evaluated(std::uint64_t seed, std::uint64_t index) {
  const StressPlaces drawn = stress::drawPlaces(seed, index, kPlaces);
  std::vector<float> down(kPlaces), up(kPlaces), radiance(kPlaces);
  if (drawn.form == stress::kSpp) {
    const auto mu0 = static_cast<float>(drawn.mu0), albedo = static_cast<float>(drawn.albedo),
               share = drawn.forwardShare();
    spp::sppPowers(drawn.depth, drawn.thickness, mu0, albedo, share, down, up);
    const bool downward = drawn.mu > 0.;
    std::vector<float> other_half(kPlaces);
    spp::sppRadiance(drawn.depth, drawn.thickness, mu0, albedo, share, downward ? radiance : other_half,
                     downward ? other_half : radiance);
  } else {
    const spp::StreamConstants constants = drawn.constants();
    const spp::StreamArrays arrays(constants);
    arrays.powers(drawn.depth, drawn.thickness, down, up);
    arrays.refinedRadiance(drawn.depth, drawn.thickness, spp::streamView<float>(constants, drawn.mu, drawn.azimuth),
                           radiance);
  }
  return judged(drawn, index, exactLight(drawn), down, up, radiance);
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
  Tally tallies[stress::kForms];
  std::mutex tallying;
  tbb::parallel_for(first, first + (count + kPlaces - 1) / kPlaces, [&, seed = seed](std::uint64_t index) {
    const Tally tally = evaluated(seed, index);
    const std::lock_guard lock(tallying);
    tallies[index % stress::kForms].add(tally);
  });
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  bool broken = false;
  std::uint64_t places = 0;
  for (int form = 0; form < stress::kForms; ++form) {
    const Tally& tally = tallies[form];
    places += tally.places;
    broken |= tally.not_finite + tally.out_of_bounds + tally.off > 0;
    std::printf("%-10s %llu places, not finite %llu, out of bounds %llu, off by too much %llu\n",
                stress::kFormNames[form], static_cast<unsigned long long>(tally.places),
                static_cast<unsigned long long>(tally.not_finite), static_cast<unsigned long long>(tally.out_of_bounds),
                static_cast<unsigned long long>(tally.off));
    std::printf("  powers to %.2g, medium %llu: %s\n", tally.power.error,
                static_cast<unsigned long long>(tally.power.medium), tally.power.place.c_str());
    std::printf("  radiance to %.2g, medium %llu: %s\n", tally.radiance.error,
                static_cast<unsigned long long>(tally.radiance.medium), tally.radiance.place.c_str());
  }
  std::printf("%llu places in %.1f s\n", static_cast<unsigned long long>(places), seconds.count());
  return broken ? 1 : 0;
}
