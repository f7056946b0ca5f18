// stress_pp_solver [COUNT] [SEED] [FIRST]: solves the random problems FIRST .. FIRST + COUNT - 1 of SEED, half of them
// by Solver and half by solveSlabs, and tells what broke. Exit status 1 if anything did, 2 for wrong usage. The same
// problems for any number of threads; one problem alone: stress_pp_solver 1 SEED INDEX.
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <mutex>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "stress_problems.hpp"

namespace {

using namespace sunfleck;
using namespace sunfleck::stress;
using std::numbers::pi;

// All shares of the light that enters a problem: of the flux that arrives and, in a cavity, of pi B.
constexpr double kEnergyTolerance = 1e-12;
constexpr double kNegativeTolerance = 1e-12;  // a flux below minus this is negative beyond rounding

constexpr std::uint64_t kBatch = 256;  // problems of one batch

enum Rule { kFinite, kNoException, kNotNegative, kEnergy, kCavity, kRules };
constexpr const char* kNames[kRules] = {"non-finite values", "exceptions", "negative fluxes",
                                        "energy residuals above 1e-12", "cavities off by 1e-12"};

// How often each rule was broken and by what problem most: the largest excess, and of equal ones the first problem.
struct Tally {
  struct Worst {
    double excess = -1.;
    std::uint64_t index = 0;
    std::string problem;
  };
  std::uint64_t problems = 0, radiances = 0, negative_radiances = 0;
  std::uint64_t broken[kRules] = {};
  Worst worst[kRules];

  template <typename Describe>
  void note(Rule rule, double excess, bool breaks, std::uint64_t index, Describe&& text) {
    if (breaks) ++broken[rule];
    Worst& w = worst[rule];
    if (excess > w.excess || (excess == w.excess && index < w.index)) w = {excess, index, text()};
  }

  void add(const Tally& other) {
    problems += other.problems;
    radiances += other.radiances;
    negative_radiances += other.negative_radiances;
    for (int rule = 0; rule < kRules; ++rule) {
      broken[rule] += other.broken[rule];
      const Worst& w = other.worst[rule];
      if (w.excess > worst[rule].excess || (w.excess == worst[rule].excess && w.index < worst[rule].index))
        worst[rule] = w;
    }
  }
};

// What one problem yields, in shares of the light that enters it.
struct Judged {
  std::vector<double> values;    // all must be finite; in the order in which they are asked for
  bool may_be_negative = false;  // flux, by a phase function cut to a series that is negative somewhere
  double lowest = 0.;            // flux
  double residual = 0.;          // of energy
  double cavity = 0.;            // largest deviation from radiance 1
  double thickness = 0.;         // of all finite layers
  std::uint64_t radiances = 0, negative_radiances = 0;
};

Judged judge(pp::Solver& solver, const StressProblem& drawn) {
  const pp::Problem& problem = drawn.problem;
  solver.solve(problem);
  Judged judged;
  double thickness = 0.;
  for (const pp::Layer& layer : problem.layers) thickness += layer.thickness;
  const bool infinite = std::isinf(thickness);
  for (const pp::Layer& layer : problem.layers)
    if (!std::isinf(layer.thickness)) judged.thickness += layer.thickness;
  judged.may_be_negative = !drawn.settings.delta_m;
  const double emitted = drawn.isothermal ? pi : 0.;
  const double scale = std::max(solver.incident(), emitted);
  judged.values = {solver.incident(), solver.reflectance(), solver.transmittance(), solver.direct(),
                   solver.absorptance()};

  std::vector<double> depths{0., infinite ? 1. : 0.37 * thickness};
  if (!infinite) depths.push_back(thickness);
  std::vector<pp::Fluxes> fluxes;
  // Light between white layers and a white ground builds up to many times what arrives: rounding goes with what there
  // is.
  double inside = scale;
  for (const double depth : depths) {
    const pp::Fluxes& f = fluxes.emplace_back(solver.fluxes(depth));
    inside = std::max({inside, f.up, f.down});
  }
  for (const pp::Fluxes& f : fluxes) {
    for (const double value : {f.up, f.down, f.direct, f.mean_intensity}) judged.values.push_back(value / scale);
    judged.lowest =
        std::min({judged.lowest, f.up / inside, f.down / inside, f.direct / inside, pi * f.mean_intensity / inside});
    if (drawn.isothermal)
      judged.cavity = std::max(
          {judged.cavity, std::abs(f.up / pi - 1.), std::abs(f.down / pi - 1.), std::abs(f.mean_intensity - 1.)});
  }
  if (!drawn.isothermal) {
    const auto net = [](const pp::Fluxes& f) { return f.down + f.direct - f.up; };
    const double lost = infinite ? 0. : net(fluxes.back());
    judged.residual = std::abs(net(fluxes.front()) - lost - solver.absorptance() * solver.incident()) / inside;
    if (!infinite)
      judged.residual = std::max(judged.residual,
                                 std::abs(net(fluxes[0]) - net(fluxes[1]) - solver.absorbed(0., depths[1])) / inside);
  }

  if (!drawn.depths.empty()) {
    std::vector<double> radiances(drawn.depths.size() * drawn.mus.size() * drawn.phis.size());
    solver.radiances(drawn.depths, drawn.mus, drawn.phis, radiances);
    judged.values.insert(judged.values.end(), radiances.begin(), radiances.end());
    judged.radiances = radiances.size();
    judged.negative_radiances = static_cast<std::uint64_t>(
        std::ranges::count_if(radiances, [&](double r) { return r < -kNegativeTolerance * scale; }));
    if (drawn.isothermal)
      for (const double r : radiances) judged.cavity = std::max(judged.cavity, std::abs(r - 1.));
  }
  return judged;
}

template <typename Describe>
void count(Tally& tally, const Judged& judged, bool cavity, std::uint64_t index, Describe&& text) {
  const auto wrong = std::ranges::find_if(judged.values, [](double v) { return !std::isfinite(v); });
  if (wrong != judged.values.end()) {
    const std::string which = "value " + std::to_string(wrong - judged.values.begin()) + ": ";
    tally.note(kFinite, 0., true, index, [&] { return which + text(); });
  }
  if (!judged.may_be_negative)
    tally.note(kNotNegative, -judged.lowest, !(judged.lowest >= -kNegativeTolerance), index, text);
  // A ground is white, a layer loses nothing, to 1e-16: over a thousand million scatterings that tells.
  if (cavity)
    tally.note(kCavity, judged.cavity, !(judged.cavity <= kEnergyTolerance + 1e-15 * judged.thickness), index, text);
  else
    tally.note(kEnergy, judged.residual, !(judged.residual <= kEnergyTolerance), index, text);
  tally.radiances += judged.radiances;
  tally.negative_radiances += judged.negative_radiances;
}

// Solvers keep their memory: one for each setting, used again and again, as a program would.
using Solvers = std::map<std::tuple<int, bool, bool>, pp::Solver>;

void runSingle(Solvers& solvers, Tally& tally, std::uint64_t seed, std::uint64_t index) {
  const StressProblem drawn = drawProblem(seed, index);
  const auto text = [&] { return describe(drawn); };
  ++tally.problems;
  try {
    const pp::Settings& s = drawn.settings;
    pp::Solver& solver = solvers.try_emplace({s.streams, s.delta_m, s.corrections}, s).first->second;
    count(tally, judge(solver, drawn), drawn.isothermal, index, text);
  } catch (const std::exception& e) {
    tally.note(kNoException, 0., true, index, [&] { return std::string(e.what()) + ": " + text(); });
  }
}

void runBatch(Tally& tally, std::uint64_t seed, std::uint64_t batch, const std::vector<std::uint64_t>& indices) {
  const int streams = batchStreams(seed, batch);
  std::vector<pp::SlabCase> cases;
  for (const std::uint64_t index : indices) cases.push_back(drawCase(seed, index, streams));
  std::vector<pp::SlabFluxes> fluxes(cases.size());
  tally.problems += cases.size();
  try {
    pp::solveSlabs(cases, fluxes, streams);
  } catch (const std::exception& e) {
    tally.note(kNoException, 0., true, indices.front(), [&] { return "batch: " + std::string(e.what()); });
    return;
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto& [reflectance, transmittance, direct] = fluxes[i];
    Judged judged;
    judged.values = {reflectance, transmittance, direct};
    judged.lowest = std::min({0., reflectance, transmittance - direct, direct});
    // A batch tells no absorption: all light is back at albedo 1, and never more than all.
    const double sum = reflectance + transmittance;
    judged.residual = cases[i].albedo == 1. ? std::abs(sum - 1.) : std::max(0., sum - 1.);
    count(tally, judged, false, indices[i], [&] { return describe(cases[i], streams); });
  }
}

// Problems of even index go one by one, those of odd index in batches.
void runBlock(Solvers& solvers, Tally& tally, std::uint64_t seed, std::uint64_t block, std::uint64_t first,
              std::uint64_t end) {
  std::vector<std::uint64_t> batch;
  for (std::uint64_t index = std::max(first, block * kBatch); index < std::min(end, (block + 1) * kBatch); ++index) {
    if (index % 2 == 0)
      runSingle(solvers, tally, seed, index);
    else
      batch.push_back(index);
  }
  if (!batch.empty()) runBatch(tally, seed, block, batch);
}

Tally run(std::uint64_t count, std::uint64_t seed, std::uint64_t first) {
  struct Local {
    Solvers solvers;
    Tally tally;
  };
  tbb::enumerable_thread_specific<Local> locals;
  std::atomic<std::uint64_t> done{0};
  std::mutex terminal;
  const bool show = isatty(STDERR_FILENO) != 0;
  const std::uint64_t end = first + count;
  tbb::parallel_for(first / kBatch, (end + kBatch - 1) / kBatch, [&](std::uint64_t block) {
    // A batch inside may let this thread take another block meanwhile: so each has its own tally until it is done.
    Tally tally;
    Solvers solvers = std::move(locals.local().solvers);
    runBlock(solvers, tally, seed, block, first, end);
    Local& local = locals.local();
    if (local.solvers.size() < solvers.size()) local.solvers = std::move(solvers);
    local.tally.add(tally);
    const std::uint64_t now = done += tally.problems;
    if (show && terminal.try_lock()) {
      std::fprintf(stderr, "\r%.1f %%", 100. * static_cast<double>(now) / static_cast<double>(count));
      terminal.unlock();
    }
  });
  if (show) std::fprintf(stderr, "\r\033[K");
  Tally all;
  for (const Local& local : locals) all.add(local.tally);
  return all;
}

std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size() || value > (std::uint64_t{1} << 48)) return {};
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t arguments[3] = {20000, 1, 0};  // COUNT, SEED, FIRST
  for (int i = 1; i < argc; ++i) {
    const auto value = i <= 3 ? number(argv[i]) : std::nullopt;
    if (!value || (i == 1 && *value == 0)) {
      std::fprintf(stderr, "usage: stress_pp_solver [COUNT] [SEED] [FIRST], whole numbers, COUNT above 0\n");
      return 2;
    }
    arguments[i - 1] = *value;
  }
  const auto [count, seed, first] = arguments;
  const auto start = std::chrono::steady_clock::now();
  const Tally tally = run(count, seed, first);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  std::printf("%llu problems, seed %llu, first %llu, %.1f s; radiances %llu, of them negative beyond rounding %llu\n",
              static_cast<unsigned long long>(tally.problems), static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(first), seconds, static_cast<unsigned long long>(tally.radiances),
              static_cast<unsigned long long>(tally.negative_radiances));
  bool broken = false;
  for (int rule = 0; rule < kRules; ++rule) {
    std::printf("%s: %llu\n", kNames[rule], static_cast<unsigned long long>(tally.broken[rule]));
    const Tally::Worst& worst = tally.worst[rule];
    if (worst.excess >= 0. && (worst.excess > 0. || tally.broken[rule] > 0))
      std::printf("  worst %.3g, problem %llu: %s\n", worst.excess, static_cast<unsigned long long>(worst.index),
                  worst.problem.c_str());
    broken = broken || tally.broken[rule] > 0;
  }
  return broken ? 1 : 0;
}
