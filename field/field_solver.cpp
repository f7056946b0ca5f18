#include "field/field_solver.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/require.hpp"
#include "field/detail/returning.hpp"

namespace sunfleck {
namespace {

using detail::kBlock;
using detail::KindOptics;
using detail::kLanes;
using detail::Lanes;
using detail::overBlocks;
using detail::Returning;
using Sums = std::array<double, kLanes>;

constexpr std::size_t kHistory = 6;  // of Anderson's acceleration
constexpr double kPi = std::numbers::pi;

Lanes all(float value) {
  return value - Lanes{};
}

void addTo(Sums& sums, const Lanes& values) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += double{values[lane]};
}

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
    makeSource();
  }

  std::vector<FieldSolution> run(const Progress& progress) {
    light_ = source_;
    std::size_t kept = 0;  // differences of the history
    int iteration = 0;
    for (;; ++iteration) {
      step(kept, iteration > 0);
      if (iteration > 0 && kept < kHistory) ++kept;
      if (done() || iteration + 1 >= effort_.most_iterations) break;
      requireGoOn(progress, share());
      advance(kept);
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

  // Irradiance by lines of a side per sum over them of radiance, in units of 1 / pi.
  float perLine(std::size_t side) const { return 1.f / static_cast<float>(std::max(exchange_.lines[side / 2], 1u)); }

  // Light before it is scattered from element to element: suns' light scattered once; light of the sky and, without a
  // period, of the ground.
  void makeSource() {
    source_.assign(2 * count() + 1, Lanes{});
    direct_.assign(2 * count(), Lanes{});
    for (std::size_t lane = 0; lane < problems_.size(); ++lane) {
      const DirectLight* const sun = problems_[lane].direct;
      if (!sun) continue;
      // Scaled so that its power is what the elements, as large as their lines make them, pass on.
      double by_lines = 0.;
      for (std::size_t side = 0; side < ground(); ++side)
        by_lines += double{sun->irradiance[side]} * exchange_.lines[side / 2] * exchange_.line_power / kPi;
      scale_[lane] = by_lines > 0. ? static_cast<float>(sun->power / by_lines) : 0.f;
      balance_[lane].in = sun->power + sun->ground_power;
      for (std::size_t side = 0; side < ground(); ++side) direct_[side][lane] = scale_[lane] * sun->irradiance[side];
      if (periodic_) source_[ground()][lane] = static_cast<float>(sun->ground_power / ground_area_);
    }
    for (std::size_t first = 0; first < problems_.size();) {
      std::size_t last = first + 1;
      while (last < problems_.size() && problems_[last].direct == problems_[first].direct) ++last;
      if (problems_[first].direct && problems_[first].scattered_once.empty()) addFirstScattering(first, last);
      first = last;
    }
    for (std::size_t lane = 0; lane < problems_.size(); ++lane) {
      if (problems_[lane].direct && !problems_[lane].scattered_once.empty()) addScatteredOnce(lane);
      addOutside(lane);
    }
  }

  // (F6) Light of a lane's sun, scattered once, as the problem tells it.
  void addScatteredOnce(std::size_t lane) {
    const FieldProblem& problem = problems_[lane];
    for (std::size_t side = 0; side < ground(); ++side) {
      const ElementOptics& optics = problem.optics[kinds_[side / 2]];
      const float mean = optics.reflectance * problem.direct->irradiance[side] +
                         optics.transmittance * problem.direct->irradiance[side ^ 1];
      source_[side][lane] +=
          scale_[lane] * perLine(side) *
          (returning_.gain[side][lane] * problem.scattered_once[side] + returning_.own[side][lane] * mean);
    }
  }

  // (F6) Light of the sun that is common to lanes [first, last), scattered once.
  void addFirstScattering(std::size_t first, std::size_t last) {
    const DirectLight& sun = *problems_[first].direct;
    const LitPlaces* const lit = problems_[first].lit;
    Lanes scale{};
    for (std::size_t lane = first; lane < last; ++lane) scale[lane] = scale_[lane];
    const std::span<const float> spread = lit ? lit->spread : sun.irradiance;
    // What is sent by a place of each side, where light comes to the element as told, times pi.
    constexpr std::size_t kWays = 3;
    std::vector<Lanes> sent(kWays * ground());
    overBlocks(count(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t side = 2 * begin; side < 2 * end; ++side) {
        const KindOptics& optics = optics_[kinds_[side / 2]];
        Lanes* const of_side = &sent[kWays * side];
        of_side[LitPlaces::kDark] =
            scale * (optics.reflectance * spread[side] + optics.transmittance * spread[side ^ 1]);
        if (!lit) continue;
        const bool back = side % 2 == 1;
        const Lanes reflected = scale * optics.reflectance * lit->irradiance[side],
                    transmitted = scale * optics.transmittance * lit->irradiance[side ^ 1];
        of_side[LitPlaces::kFront] = of_side[LitPlaces::kDark] + (back ? transmitted : reflected);
        of_side[LitPlaces::kBack] = of_side[LitPlaces::kDark] + (back ? reflected : transmitted);
      }
    });
    const auto sentAt = [&](std::size_t side, std::uint32_t crossing) {
      return sent[kWays * side + (lit ? lit->at[crossing] : LitPlaces::kDark)];
    };
    const auto mean = [&](std::size_t side) {
      const KindOptics& optics = optics_[kinds_[side / 2]];
      return optics.reflectance * sun.irradiance[side] + optics.transmittance * sun.irradiance[side ^ 1];
    };
    std::vector<Sums> up((count() + kBlock - 1) / kBlock), down(up.size());
    overBlocks(count(), [&](std::size_t block, std::size_t begin, std::size_t end) {
      for (std::size_t side = 2 * begin; side < 2 * end; ++side) {
        Lanes sum{};
        for (std::uint64_t i = exchange_.first[side]; i < exchange_.first[side + 1]; ++i)
          sum += sentAt(exchange_.sees[i], exchange_.seen_at[i]);
        source_[side] += perLine(side) * (returning_.gain[side] * sum + returning_.own[side] * (scale * mean(side)));
        for (std::uint64_t i = exchange_.first_outside[side]; i < exchange_.first_outside[side + 1]; ++i)
          addTo((exchange_.directions[exchange_.outside[i]].z > 0.f ? down : up)[block],
                sentAt(side, exchange_.open_at[i]));
      }
    });
    for (std::size_t lane = first; lane < last; ++lane) {
      double upward = 0., downward = 0.;
      for (const Sums& part : up) upward += part[lane];
      for (const Sums& part : down) downward += part[lane];
      balance_[lane].out_up += upward * exchange_.line_power / kPi;
      if (periodic_)
        source_[ground()][lane] += static_cast<float>(downward * exchange_.line_power / kPi / ground_area_);
      else
        balance_[lane].out_down += downward * exchange_.line_power / kPi;
    }
  }

  // Radiance of the ground around a stand without period.
  double groundBeyond(std::size_t lane) const {
    return periodic_ ? 0. : double{problems_[lane].ground_albedo} * double{problems_[lane].ground_open} / kPi;
  }

  void addOutside(std::size_t lane) {
    const FieldProblem& problem = problems_[lane];
    if (!problem.arriving.empty()) {
      double power = 0.;
      for (std::size_t side = 0; side < ground(); ++side) {
        source_[side][lane] += problem.arriving[side];
        power += double{problem.arriving[side]} * exchange_.lines[side / 2];
      }
      balance_[lane].in += power * exchange_.line_power / kPi;
    }
    const double of_ground = groundBeyond(lane);
    if (problem.outside.empty() && of_ground == 0.) return;
    std::vector<double> entering((count() + kBlock - 1) / kBlock);
    overBlocks(count(), [&](std::size_t block, std::size_t begin, std::size_t end) {
      for (std::size_t side = 2 * begin; side < 2 * end; ++side) {
        double sum = of_ground * exchange_.below[side];
        if (!problem.outside.empty())
          for (std::uint64_t i = exchange_.first_outside[side]; i < exchange_.first_outside[side + 1]; ++i)
            sum += double{problem.outside[exchange_.outside[i]]};
        if (sum == 0.) continue;
        entering[block] += sum;
        source_[side][lane] += static_cast<float>(kPi * sum / exchange_.lines[side / 2]);
      }
    });
    double free = 0.;
    if (periodic_ && !problem.outside.empty())
      for (std::size_t axis = 0; axis < exchange_.free_lines.size(); ++axis)
        free += static_cast<double>(exchange_.free_lines[axis]) *
                double{problem.outside[axis] + problem.outside[axis + exchange_.free_lines.size()]};
    source_[ground()][lane] += static_cast<float>(free * exchange_.line_power / std::max(ground_area_, 1e-30));
    balance_[lane].in +=
        exchange_.line_power * (std::accumulate(entering.begin(), entering.end(), 0.) + (periodic_ ? free : 0.));
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
  void addSquares(std::size_t element, const Lanes& front, const Lanes& back, Sums& squares) const {
    const Lanes weight = all(weight_[2 * element]);
    const float even = even_share_[kinds_[element]];
    addTo(squares, weight * (even * (front * front + back * back) + 2.f * (1.f - even) * front * back));
  }

  // (F4) The light after one more passage, its difference from the light before it, and the sums that Anderson's
  // acceleration needs of it.
  void step(std::size_t kept, bool has_former) {
    radiate();
    const std::size_t sides = ground() + 1;
    passed_.resize(sides);
    change_.resize(sides);
    if (has_former) {
      // The oldest difference makes room.
      if (kept == kHistory) {
        std::rotate(change_steps_.begin(), change_steps_.begin() + 1, change_steps_.end());
        std::rotate(passed_steps_.begin(), passed_steps_.begin() + 1, passed_steps_.end());
        for (std::size_t j = 1; j < kHistory; ++j)
          for (std::size_t l = 1; l <= j; ++l) with_steps_[j - 1][l - 1] = with_steps_[j][l];
        std::rotate(with_change_.begin(), with_change_.begin() + 1, with_change_.end());
        --kept;
      }
      change_steps_[kept].resize(sides);
      passed_steps_[kept].resize(sides);
      ++kept;
    }
    struct Found {
      std::array<Sums, kHistory> with_change{};  // <step_j, change>
      Sums newest_square{};                      // <newest step, newest step>
      Sums squares{}, light_squares{}, down{};
    };
    std::vector<Found> found((count() + kBlock - 1) / kBlock);
    const auto take = [&](std::size_t side, const Lanes& passed, Found& of_block) {
      const Lanes change = passed - light_[side];
      if (has_former) {
        change_steps_[kept - 1][side] = change - change_[side];
        passed_steps_[kept - 1][side] = passed - passed_[side];
      }
      change_[side] = change;
      passed_[side] = passed;
      if (kept == 0) return;
      const Lanes weight = all(weight_[side]);
      const Lanes weighted = weight * change, newest = change_steps_[kept - 1][side];
      for (std::size_t j = 0; j < kept; ++j) addTo(of_block.with_change[j], weighted * change_steps_[j][side]);
      addTo(of_block.newest_square, weight * newest * newest);
    };
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
        take(side, source_[side] + static_cast<float>(kPi) * perLine(side) * sum, of_block);
        if (side % 2 == 0) continue;
        addSquares(side / 2, change_[side - 1], change_[side], of_block.squares);
        addSquares(side / 2, passed_[side - 1] + direct_[side - 1], passed_[side] + direct_[side],
                   of_block.light_squares);
      }
    });
    Found total;
    const auto sum = [](Sums& to, const Sums& from) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) to[lane] += from[lane];
    };
    const auto addFound = [&](const Found& part) {
      sum(total.squares, part.squares);
      sum(total.light_squares, part.light_squares);
      sum(total.down, part.down);
      for (std::size_t j = 0; j < kHistory; ++j) sum(total.with_change[j], part.with_change[j]);
      sum(total.newest_square, part.newest_square);
    };
    for (const Found& part : found) addFound(part);
    Lanes down{};
    if (periodic_)
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        down[lane] = static_cast<float>(total.down[lane] * exchange_.line_power / ground_area_);
    Found of_ground;
    take(ground(), source_[ground()] + down, of_ground);
    addTo(of_ground.squares, all(weight_[ground()]) * change_[ground()] * change_[ground()]);
    addTo(of_ground.light_squares, all(weight_[ground()]) * passed_[ground()] * passed_[ground()]);
    addFound(of_ground);
    // The newest step leads from the change before to this one.
    for (std::size_t j = 0; j + 1 < kept; ++j)
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        with_steps_[kept - 1][j][lane] = total.with_change[j][lane] - with_change_[j][lane];
    if (kept > 0) with_steps_[kept - 1][kept - 1] = total.newest_square;
    with_change_ = total.with_change;
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

  // Coefficients of the history that leave the least change, of one problem: the normal equations by Cholesky, as far
  // as the differences are independent.
  std::array<double, kHistory> mixing(std::size_t lane, std::size_t kept) const {
    std::array<std::array<double, kHistory>, kHistory> factor{};
    std::array<double, kHistory> y{}, mixing{};
    std::array<bool, kHistory> used{};
    for (std::size_t j = 0; j < kept; ++j) {
      double right = with_change_[j][lane];
      for (std::size_t l = 0; l < j; ++l) {
        double sum = with_steps_[j][l][lane];
        for (std::size_t k = 0; k < l; ++k) sum -= factor[j][k] * factor[l][k];
        factor[j][l] = used[l] ? sum / factor[l][l] : 0.;
        right -= factor[j][l] * y[l];
      }
      double square = with_steps_[j][j][lane];
      for (std::size_t l = 0; l < j; ++l) square -= factor[j][l] * factor[j][l];
      used[j] = square > 1e-10 * with_steps_[j][j][lane] && square > 0.;  // the sums are of single precision
      factor[j][j] = used[j] ? std::sqrt(square) : 1.;
      y[j] = used[j] ? right / factor[j][j] : 0.;
    }
    for (std::size_t j = kept; j-- > 0;) {
      double sum = y[j];
      for (std::size_t l = j + 1; l < kept; ++l) sum -= factor[l][j] * mixing[l];
      mixing[j] = used[j] ? sum / factor[j][j] : 0.;
    }
    return mixing;
  }

  void advance(std::size_t kept) {
    std::array<Lanes, kHistory> mixed{};
    for (std::size_t lane = 0; lane < problems_.size(); ++lane) {
      const auto of_lane = mixing(lane, kept);
      for (std::size_t j = 0; j < kept; ++j) mixed[j][lane] = static_cast<float>(of_lane[j]);
    }
    const auto next = [&](std::size_t side) {
      Lanes light = passed_[side];
      for (std::size_t j = 0; j < kept; ++j) light -= mixed[j] * passed_steps_[j][side];
      light_[side] = light;
    };
    overBlocks(count(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t side = 2 * begin; side < 2 * end; ++side) next(side);
    });
    next(ground());
  }

  std::vector<FieldSolution> results() {
    std::vector<FieldSolution> solutions(problems_.size());
    light_ = passed_;
    radiate();
    const double area_per_line = exchange_.line_power / kPi;
    for (std::size_t lane = 0; lane < problems_.size(); ++lane) {
      FieldSolution& solution = solutions[lane];
      const FieldProblem& problem = problems_[lane];
      solution.scattered.resize(ground());
      FieldBalance& balance = balance_[lane];
      double below = 0., above = 0.;
      for (std::size_t side = 0; side < ground(); ++side) {
        const std::size_t element = side / 2;
        // An element that no line meets takes after the one before it.
        solution.scattered[side] = exchange_.lines[element] == 0 && element > 0 ? solution.scattered[side - 2]
                                                                                : std::max(0.f, light_[side][lane]);
        const ElementOptics& optics = problem.optics[kinds_[element]];
        const double absorbed = (1. - double{optics.reflectance} - double{optics.transmittance}) *
                                double{light_[side][lane] + direct_[side][lane]} * exchange_.lines[element] *
                                area_per_line;
        (element < elements_.leaf_elements ? balance.absorbed_leaves : balance.absorbed_wood) += absorbed;
        const auto outside = exchange_.first_outside[side + 1] - exchange_.first_outside[side];
        double from_below = (periodic_ ? double{ground_radiance_[lane]} : groundBeyond(lane)) * exchange_.below[side],
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
  std::array<float, kLanes> scale_{};  // of direct light
  double ground_area_ = 0.;
  std::vector<float> weight_;      // of each side in sums of squares
  std::vector<float> even_share_;  // of each kind: (rho + tau + |rho - tau|) / (2 (rho + tau))
  std::vector<Lanes> source_, direct_, light_, passed_, change_, radiance_;
  std::array<std::vector<Lanes>, kHistory> change_steps_, passed_steps_;
  std::array<Sums, kHistory> with_change_{};
  std::array<std::array<Sums, kHistory>, kHistory> with_steps_{};  // <step_j, step_l> at [j][l], l <= j
  Sums squares_{}, light_squares_{};
  std::array<FieldBalance, kLanes> balance_{};
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
