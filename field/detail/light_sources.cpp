#include "field/detail/light_sources.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace sunfleck::detail {
namespace {

constexpr double kPi = std::numbers::pi;

class Making {
 public:
  Making(const FieldGeometry& geometry, std::span<const FieldProblem> problems, std::span<const KindOptics> optics,
         const Returning& returning, double ground_area, LightSources& into)
      : elements_(geometry.elements),
        exchange_(geometry.exchange),
        kinds_(geometry.kinds),
        periodic_(geometry.periodic),
        problems_(problems),
        optics_(optics),
        returning_(returning),
        ground_area_(ground_area),
        into_(into) {}

  void make() {
    into_.source.assign(2 * count() + 1, Lanes{});
    into_.direct.assign(2 * count(), Lanes{});
    for (std::size_t lane = 0; lane < problems_.size(); ++lane) {
      const DirectLight* const sun = problems_[lane].direct;
      if (!sun) continue;
      // Scaled so that its power is what the elements, as large as their lines make them, pass on.
      double by_lines = 0.;
      for (std::size_t side = 0; side < ground(); ++side)
        by_lines += double{sun->irradiance[side]} * exchange_.lines[side / 2] * exchange_.line_power / kPi;
      into_.scale[lane] = by_lines > 0. ? static_cast<float>(sun->power / by_lines) : 0.f;
      into_.balance[lane].in = sun->power + sun->ground_power;
      for (std::size_t side = 0; side < ground(); ++side)
        into_.direct[side][lane] = into_.scale[lane] * sun->irradiance[side];
      if (periodic_) into_.source[ground()][lane] = static_cast<float>(sun->ground_power / ground_area_);
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

 private:
  std::size_t count() const { return elements_.size(); }
  std::size_t ground() const { return 2 * count(); }
  // Radiance of the ground around a stand without period.
  double groundBeyond(const FieldProblem& problem) const { return periodic_ ? 0. : openGround(problem); }

  // (F6) Light of a lane's sun, scattered once, as the problem tells it.
  void addScatteredOnce(std::size_t lane) {
    const FieldProblem& problem = problems_[lane];
    for (std::size_t side = 0; side < ground(); ++side) {
      const ElementOptics& optics = problem.optics[kinds_[side / 2]];
      const float mean = optics.reflectance * problem.direct->irradiance[side] +
                         optics.transmittance * problem.direct->irradiance[side ^ 1];
      into_.source[side][lane] +=
          into_.scale[lane] * perLine(exchange_, side) *
          (returning_.gain[side][lane] * problem.scattered_once[side] + returning_.own[side][lane] * mean);
    }
  }

  // (F6) Light of the sun that is common to lanes [first, last), scattered once.
  void addFirstScattering(std::size_t first, std::size_t last) {
    const DirectLight& sun = *problems_[first].direct;
    const LitPlaces* const lit = problems_[first].lit;
    Lanes scale{};
    for (std::size_t lane = first; lane < last; ++lane) scale[lane] = into_.scale[lane];
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
    std::vector<LaneSums> up((count() + kBlock - 1) / kBlock), down(up.size());
    overBlocks(count(), [&](std::size_t block, std::size_t begin, std::size_t end) {
      for (std::size_t side = 2 * begin; side < 2 * end; ++side) {
        Lanes sum{};
        for (std::uint64_t i = exchange_.first[side]; i < exchange_.first[side + 1]; ++i)
          sum += sentAt(exchange_.sees[i], exchange_.seen_at[i]);
        into_.source[side] +=
            perLine(exchange_, side) * (returning_.gain[side] * sum + returning_.own[side] * (scale * mean(side)));
        for (std::uint64_t i = exchange_.first_outside[side]; i < exchange_.first_outside[side + 1]; ++i)
          addTo((exchange_.directions[exchange_.outside[i]].z > 0.f ? down : up)[block],
                sentAt(side, exchange_.open_at[i]));
      }
    });
    for (std::size_t lane = first; lane < last; ++lane) {
      double upward = 0., downward = 0.;
      for (const LaneSums& part : up) upward += part[lane];
      for (const LaneSums& part : down) downward += part[lane];
      into_.balance[lane].out_up += upward * exchange_.line_power / kPi;
      if (periodic_)
        into_.source[ground()][lane] += static_cast<float>(downward * exchange_.line_power / kPi / ground_area_);
      else
        into_.balance[lane].out_down += downward * exchange_.line_power / kPi;
    }
  }

  void addOutside(std::size_t lane) {
    const FieldProblem& problem = problems_[lane];
    if (!problem.arriving.empty()) {
      double power = 0.;
      for (std::size_t side = 0; side < ground(); ++side) {
        into_.source[side][lane] += problem.arriving[side];
        power += double{problem.arriving[side]} * exchange_.lines[side / 2];
      }
      into_.balance[lane].in += power * exchange_.line_power / kPi;
    }
    const double of_ground = groundBeyond(problems_[lane]);
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
        into_.source[side][lane] += static_cast<float>(kPi * sum / exchange_.lines[side / 2]);
      }
    });
    double free = 0.;
    if (periodic_ && !problem.outside.empty())
      for (std::size_t axis = 0; axis < exchange_.free_lines.size(); ++axis)
        free += static_cast<double>(exchange_.free_lines[axis]) *
                double{problem.outside[axis] + problem.outside[axis + exchange_.free_lines.size()]};
    into_.source[ground()][lane] += static_cast<float>(free * exchange_.line_power / std::max(ground_area_, 1e-30));
    into_.balance[lane].in +=
        exchange_.line_power * (std::accumulate(entering.begin(), entering.end(), 0.) + (periodic_ ? free : 0.));
  }

  const FieldElements& elements_;
  const LineExchange& exchange_;
  std::span<const std::uint32_t> kinds_;
  bool periodic_;
  std::span<const FieldProblem> problems_;
  std::span<const KindOptics> optics_;
  const Returning& returning_;
  double ground_area_;
  LightSources& into_;
};

}  // namespace

double openGround(const FieldProblem& problem) {
  return double{problem.ground_albedo} * double{problem.ground_open} / kPi;
}

LightSources lightSources(const FieldGeometry& geometry, std::span<const FieldProblem> problems,
                          std::span<const KindOptics> optics, const Returning& returning, double ground_area) {
  LightSources made;
  Making(geometry, problems, optics, returning, ground_area, made).make();
  return made;
}

}  // namespace sunfleck::detail
