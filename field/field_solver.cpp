#include "field/field_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/require.hpp"
#include "field/detail/lane_anderson.hpp"
#include "field/detail/light_sources.hpp"
#include "field/detail/returning.hpp"

namespace sunfleck {
namespace {

using detail::addTo;
using detail::allLanes;
using detail::kBlock;
using detail::KindOptics;
using detail::kLanes;
using detail::LaneAnderson;
using detail::Lanes;
using detail::LaneSums;
using detail::LightSources;
using detail::overBlocks;
using detail::Returning;

constexpr double kPi = std::numbers::pi;

// The state of up to kLanes problems: the light of each side that did not come straight from a sun. The last entry of
// each vector is the ground's.
class Solve {
 public:
  Solve(const FieldGeometry& geometry, std::span<const FieldProblem> problems, double recollision,
        const SolverEffort& effort)
      : elements_(geometry.elements),
        exchange_(geometry.exchange),
        kinds_(geometry.kinds),
        problems_(problems),
        periodic_(geometry.periodic),
        recollision_(recollision),
        effort_(effort),
        optics_(opticsOf(problems)),
        returning_(geometry, optics_) {
    for (std::size_t lane = 0; lane < problems_.size(); ++lane) ground_albedo_[lane] = problems_[lane].ground_albedo;
    // The ground is as large as its lines make it.
    ground_area_ = exchange_.line_power / kPi * static_cast<double>(exchange_.all_lines);
    setWeights();
    sources_ = detail::lightSources(geometry, problems_, optics_, returning_, ground_area_);
  }

  std::vector<FieldSolution> run(const Progress& progress) {
    light_ = sources_.source;
    int iteration = 0;
    for (;; ++iteration) {
      step();
      if (done() || iteration + 1 >= effort_.most_iterations) break;
      requireGoOn(progress, share());
      advance();
    }
    iterations_ = iteration + 1;
    return results();
  }

 private:
  std::size_t count() const { return elements_.size(); }
  std::size_t ground() const { return 2 * count(); }

  static std::vector<KindOptics> opticsOf(std::span<const FieldProblem> problems) {
    std::vector<KindOptics> optics(problems.front().optics.size());
    for (std::size_t kind = 0; kind < optics.size(); ++kind)
      for (std::size_t lane = 0; lane < problems.size(); ++lane) {
        optics[kind].reflectance[lane] = problems[lane].optics[kind].reflectance;
        optics[kind].transmittance[lane] = problems[lane].optics[kind].transmittance;
      }
    return optics;
  }

  void setWeights() {
    const FieldAlbedo albedo = largestAlbedo(problems_);
    weight_.resize(2 * count() + 1);
    for (std::size_t i = 0; i < count(); ++i)
      weight_[2 * i] = weight_[2 * i + 1] =
          static_cast<float>(exchange_.lines[i]) * albedo.of_kinds[kinds_[i]].albedo();
    for (const ElementOptics& optics : albedo.of_kinds)
      even_share_.push_back(optics.albedo() > 0.f
                                ? 0.5f + 0.5f * std::abs(optics.reflectance - optics.transmittance) / optics.albedo()
                                : 1.f);
    weight_[ground()] = periodic_ ? static_cast<float>(static_cast<double>(exchange_.all_lines)) * albedo.ground : 0.f;
  }

  // (F4) Radiance that each side sends out by itself: without what goes back where it came from.
  void radiate() {
    radiance_.resize(2 * count());
    const auto over_pi = static_cast<float>(1. / kPi);
    overBlocks(count(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const KindOptics& optics = optics_[kinds_[i]];
        const Lanes reflectance = over_pi * (1.f - returning_.back[i]) * optics.reflectance,
                    transmittance = over_pi * optics.transmittance;
        const Lanes front = light_[2 * i], back = light_[2 * i + 1];
        radiance_[2 * i] = reflectance * front + transmittance * back;
        radiance_[2 * i + 1] = reflectance * back + transmittance * front;
      }
    });
    ground_radiance_ = over_pi * (ground_albedo_ * light_[ground()]);
  }
  // The share of radiance that comes from outside along a line that a side sends back along it.
  Lanes returned(std::size_t side) const { return returning_.back[side / 2] * optics_[kinds_[side / 2]].reflectance; }

  // (F5) The square of a difference of an element's light in the norm in which scattering and exchange are symmetric.
  void addSquares(std::size_t element, const Lanes& front, const Lanes& back, LaneSums& squares) const {
    const Lanes weight = allLanes(weight_[2 * element]);
    const float even = even_share_[kinds_[element]];
    addTo(squares, weight * (even * (front * front + back * back) + 2.f * (1.f - even) * front * back));
  }

  // (F4) The light after one more passage, its difference from the light before it, and the sums that Anderson's
  // acceleration and the bound need of it.
  void step() {
    radiate();
    anderson_.begin(ground() + 1);
    struct Found {
      LaneAnderson::Products products;
      LaneSums squares{}, light_squares{}, down{};
    };
    std::vector<Found> found((count() + kBlock - 1) / kBlock);
    const auto take = [&](std::size_t side, const Lanes& passed, Found& of_block) {
      anderson_.take(side, light_[side], passed, weight_[side], of_block.products);
    };
    const std::vector<Lanes>&change = anderson_.change(), &passed = anderson_.passed(), &direct = sources_.direct;
    overBlocks(count(), [&](std::size_t block, std::size_t begin, std::size_t end) {
      Found& of_block = found[block];
      for (std::size_t side = 2 * begin; side < 2 * end; ++side) {
        const std::uint32_t* source = exchange_.sees.data() + exchange_.first[side];
        const std::uint32_t* const last = exchange_.sees.data() + exchange_.first[side + 1];
        Lanes sum{}, other{};
        for (; source + 1 < last; source += 2) {
          sum += radiance_[source[0]];
          other += radiance_[source[1]];
        }
        if (source < last) sum += radiance_[*source];
        sum = returning_.gain[side] * (sum + other) + returning_.own[side] * radiance_[side];
        const std::uint32_t below = exchange_.below[side];
        if (periodic_ && below > 0) {
          sum += static_cast<float>(below) * ground_radiance_;
          addTo(of_block.down, static_cast<float>(below) * (radiance_[side] + returned(side) * ground_radiance_));
        }
        take(side, sources_.source[side] + static_cast<float>(kPi) * detail::perLine(exchange_, side) * sum, of_block);
        if (side % 2 == 0) continue;
        addSquares(side / 2, change[side - 1], change[side], of_block.squares);
        addSquares(side / 2, passed[side - 1] + direct[side - 1], passed[side] + direct[side], of_block.light_squares);
      }
    });
    Found total;
    const auto addFound = [&](const Found& part) {
      addTo(total.squares, part.squares);
      addTo(total.light_squares, part.light_squares);
      addTo(total.down, part.down);
      total.products.add(part.products);
    };
    for (const Found& part : found) addFound(part);
    Lanes down{};
    if (periodic_)
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        down[lane] = static_cast<float>(total.down[lane] * exchange_.line_power / ground_area_);
    Found of_ground;
    take(ground(), sources_.source[ground()] + down, of_ground);
    addTo(of_ground.squares, allLanes(weight_[ground()]) * change[ground()] * change[ground()]);
    addTo(of_ground.light_squares, allLanes(weight_[ground()]) * passed[ground()] * passed[ground()]);
    addFound(of_ground);
    anderson_.end(total.products);
    squares_ = total.squares;
    light_squares_ = total.light_squares;
  }

  // (F5) Bound on the relative error of the light.
  double bound(std::size_t lane) const {
    if (!(light_squares_[lane] > 0.)) return 0.;
    return std::sqrt(squares_[lane] / light_squares_[lane]) / (1. - recollision_);
  }
  bool done() const {
    for (std::size_t lane = 0; lane < problems_.size(); ++lane)
      if (bound(lane) > effort_.error) return false;
    return true;
  }

  // Of the way to the error asked for, as bounds fall by about the same factor each time.
  double share() {
    double largest = 0.;
    for (std::size_t lane = 0; lane < problems_.size(); ++lane) largest = std::max(largest, bound(lane));
    if (!(largest > effort_.error)) return 1.;
    first_bound_ = std::max(first_bound_, largest);
    return std::log(first_bound_ / largest) / std::log(first_bound_ / effort_.error);
  }

  void advance() {
    const LaneAnderson::Mixture mixed = anderson_.mixture(problems_.size());
    overBlocks(count(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t side = 2 * begin; side < 2 * end; ++side) light_[side] = anderson_.next(side, mixed);
    });
    light_[ground()] = anderson_.next(ground(), mixed);
  }

  std::vector<FieldSolution> results() {
    std::vector<FieldSolution> solutions(problems_.size());
    light_ = anderson_.passed();
    radiate();
    const double area_per_line = exchange_.line_power / kPi;
    for (std::size_t lane = 0; lane < problems_.size(); ++lane) {
      FieldSolution& solution = solutions[lane];
      const FieldProblem& problem = problems_[lane];
      solution.scattered.resize(ground());
      FieldBalance& balance = sources_.balance[lane];
      double below = 0., above = 0.;
      for (std::size_t side = 0; side < ground(); ++side) {
        const std::size_t element = side / 2;
        // An element that no line meets takes after the one before it.
        solution.scattered[side] = exchange_.lines[element] == 0 && element > 0 ? solution.scattered[side - 2]
                                                                                : std::max(0.f, light_[side][lane]);
        const ElementOptics& optics = problem.optics[kinds_[element]];
        const double absorbed = (1. - double{optics.reflectance} - double{optics.transmittance}) *
                                double{light_[side][lane] + sources_.direct[side][lane]} * exchange_.lines[element] *
                                area_per_line;
        (element < elements_.leaf_elements ? balance.absorbed_leaves : balance.absorbed_wood) += absorbed;
        const auto outside = exchange_.first_outside[side + 1] - exchange_.first_outside[side];
        double from_below =
                   (periodic_ ? double{ground_radiance_[lane]} : detail::openGround(problem)) * exchange_.below[side],
               from_above = 0.;
        if (!problem.outside.empty())
          for (std::uint64_t i = exchange_.first_outside[side]; i < exchange_.first_outside[side + 1]; ++i)
            from_above += double{problem.outside[exchange_.outside[i]]};
        const auto back = double{returned(side)[lane]};
        below += double{radiance_[side][lane]} * exchange_.below[side] + back * from_below;
        above +=
            double{radiance_[side][lane]} * static_cast<double>(outside - exchange_.below[side]) + back * from_above;
      }
      balance.out_up += exchange_.line_power * above;
      if (periodic_) {
        solution.ground = double{light_[ground()][lane]};
        balance.absorbed_ground = (1. - double{problem.ground_albedo}) * solution.ground * ground_area_;
        const auto free = std::accumulate(exchange_.free_lines.begin(), exchange_.free_lines.end(), std::uint64_t{0});
        balance.out_up += exchange_.line_power * static_cast<double>(free) * double{ground_radiance_[lane]};
      } else {
        solution.ground = double{problem.ground_open};
        balance.out_down += exchange_.line_power * below;
      }
      solution.balance = balance;
      solution.iterations = iterations_;
      solution.error_bound = bound(lane);
      solution.converged = solution.error_bound <= effort_.error;
    }
    return solutions;
  }

  const FieldElements& elements_;
  const LineExchange& exchange_;
  std::span<const std::uint32_t> kinds_;
  std::span<const FieldProblem> problems_;
  bool periodic_;
  double recollision_;
  SolverEffort effort_;
  std::vector<KindOptics> optics_;  // of each kind
  Returning returning_;
  Lanes ground_albedo_{}, ground_radiance_{};
  double ground_area_ = 0.;
  std::vector<float> weight_;      // of each side in sums of squares
  std::vector<float> even_share_;  // of each kind: (rho + tau + |rho - tau|) / (2 (rho + tau))
  LightSources sources_;
  LaneAnderson anderson_;
  std::vector<Lanes> light_, radiance_;
  LaneSums squares_{}, light_squares_{};
  int iterations_ = 0;
  double first_bound_ = 0.;
};

}  // namespace

FieldAlbedo largestAlbedo(std::span<const FieldProblem> problems) {
  FieldAlbedo albedo;
  for (const FieldProblem& problem : problems) {
    albedo.of_kinds.resize(problem.optics.size());
    for (std::size_t kind = 0; kind < problem.optics.size(); ++kind) {
      const ElementOptics& optics = problem.optics[kind];
      ElementOptics& most = albedo.of_kinds[kind];
      most.reflectance = std::max(most.reflectance, optics.reflectance);
      most.transmittance = std::max(most.transmittance, optics.transmittance);
    }
    albedo.ground = std::max(albedo.ground, problem.ground_albedo);
  }
  return albedo;
}

// (F4)
std::vector<FieldSolution> solveField(const FieldGeometry& geometry, std::span<const FieldProblem> problems,
                                      double recollision, const SolverEffort& effort, const Progress& progress) {
  if (!(recollision < 1. - 1e-6))
    throw InvalidInput(
        "leaf albedo within 1e-6 of 1: must be less where light can neither leave nor be absorbed: there is no steady "
        "state");
  std::vector<FieldSolution> solutions;
  for (std::size_t first = 0; first < problems.size(); first += kLanes) {
    Solve solve(geometry, problems.subspan(first, std::min(kLanes, problems.size() - first)), recollision, effort);
    const auto share = [&](std::size_t problem) {
      return static_cast<double>(problem) / static_cast<double>(problems.size());
    };
    const Progress part = partOf(progress, share(first), share(std::min(first + kLanes, problems.size())));
    for (FieldSolution& solution : solve.run(part)) solutions.push_back(std::move(solution));
  }
  return solutions;
}

}  // namespace sunfleck
