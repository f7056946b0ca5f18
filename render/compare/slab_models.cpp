#include "render/compare/slab_models.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "render/reference/slab_trace.hpp"
#include "spp/forward_share.hpp"
#include "spp/slab.hpp"
#include "spp/stream_slab.hpp"

namespace sunfleck {
namespace {

class ExactSlab : public SlabSolution {
 public:
  explicit ExactSlab(const SlabSetup& setup) : solver_(setup.settings), streams_(setup.settings.streams) {
    solver_.solve(setup.problem);
  }
  SlabBudget budget() const override {
    return {solver_.reflectance(), solver_.transmittance(), solver_.direct(), solver_.absorptance()};
  }
  double incident() const override { return solver_.incident(); }
  pp::Fluxes fluxes(double depth) const override { return solver_.fluxes(depth); }
  void radiances(std::span<const double> depths, std::span<const double> mus, std::span<const double> phis,
                 std::span<double> result) override {
    solver_.radiances(depths, mus, phis, result);
    modes_ = std::max(modes_, solver_.azimuthModes());
  }
  int streams() const override { return streams_; }
  std::optional<double> residual() override { return solver_.residual(modes_); }

 private:
  pp::Solver solver_;
  int streams_;
  int modes_ = 1;  // azimuth modes that have been used
};

// Direct light alone: all that SS knows.
class DirectSlab : public SlabSolution {
 public:
  explicit DirectSlab(const SlabSetup& setup) : slab_(*setup.homogeneous) {}
  SlabBudget budget() const override {
    const double direct = spp::precise::directPower(slab_.thickness, slab_.mu0);
    return {0., direct, direct, 1. - direct};
  }
  double incident() const override { return slab_.mu0; }
  pp::Fluxes fluxes(double depth) const override {
    const double direct = spp::precise::directPower(depth, slab_.mu0);
    return {.direct = slab_.mu0 * direct, .mean_intensity = direct / (4. * std::numbers::pi)};
  }
  void radiances(std::span<const double>, std::span<const double>, std::span<const double>,
                 std::span<double> result) override {
    std::ranges::fill(result, 0.);
  }
  int streams() const override { return 0; }

 private:
  pp::SlabCase slab_;
};

// SPP as it is printed, without the refinement: radiance is the same for all directions of a half.
class SimplifiedSlab : public SlabSolution {
 public:
  explicit SimplifiedSlab(const SlabSetup& setup)
      : slab_(*setup.homogeneous), forward_share_(spp::forwardShare(slab_.asymmetry, slab_.mu0)) {}
  // Powers are relative to F = P+(0), and fluxes are mu0 times powers: the factor cancels in shares.
  SlabBudget budget() const override {
    const double reflectance = at(0.).up, transmittance = at(slab_.thickness).down;
    return {reflectance, transmittance, spp::precise::directPower(slab_.thickness, slab_.mu0),
            std::max(0., 1. - reflectance - transmittance)};
  }
  double incident() const override { return slab_.mu0; }
  pp::Fluxes fluxes(double depth) const override {
    const auto powers = at(depth);
    const double direct = spp::precise::directPower(depth, slab_.mu0);
    return {.up = slab_.mu0 * powers.up,
            .down = slab_.mu0 * std::max(0., powers.down - direct),
            .direct = slab_.mu0 * direct,
            .mean_intensity = (powers.down + powers.up) / (4. * std::numbers::pi)};
  }
  void radiances(std::span<const double> depths, std::span<const double> mus, std::span<const double> phis,
                 std::span<double> result) override {
    auto out = result.begin();
    for (const double depth : depths) {
      const auto radiance = spp::precise::sppDiffuseRadiance(at(depth), spp::precise::directPower(depth, slab_.mu0));
      for (const double mu : mus) out = std::fill_n(out, phis.size(), mu > 0. ? radiance.down : radiance.up);
    }
  }
  int streams() const override { return 2; }

 private:
  spp::precise::SlabPowers at(double depth) const {
    return spp::precise::sppPowers(depth, slab_.thickness, slab_.mu0, slab_.albedo, forward_share_);
  }
  pp::SlabCase slab_;
  double forward_share_;
};

// The closed forms made of modes, their radiance refined by one integral along the line of sight.
class RefinedSlab : public SlabSolution {
 public:
  RefinedSlab(const SlabSetup& setup, spp::StreamConstants constants)
      : case_(*setup.homogeneous), streams_(2 * constants.streams()), slab_(std::move(constants), case_.thickness) {}
  SlabBudget budget() const override {
    const double reflectance = slab_.reflectance(), transmittance = slab_.transmittance();
    return {reflectance, transmittance, spp::precise::directPower(case_.thickness, case_.mu0),
            std::max(0., 1. - reflectance - transmittance)};
  }
  double incident() const override { return case_.mu0; }
  pp::Fluxes fluxes(double depth) const override {
    const auto light = slab_.light(depth);
    const double direct = case_.mu0 * light.direct;
    return {.up = light.flux_up,
            .down = std::max(0., light.flux_down - direct),
            .direct = direct,
            .mean_intensity = (light.power_down + light.power_up) / (4. * std::numbers::pi)};
  }
  void radiances(std::span<const double> depths, std::span<const double> mus, std::span<const double> phis,
                 std::span<double> result) override {
    for (std::size_t i = 0; i < mus.size(); ++i)
      for (std::size_t j = 0; j < phis.size(); ++j) {
        const auto view = slab_.view(mus[i], phis[j]);
        for (std::size_t d = 0; d < depths.size(); ++d)
          result[(d * mus.size() + i) * phis.size() + j] = slab_.refinedRadiance(depths[d], view);
      }
  }
  int streams() const override { return streams_; }

 private:
  pp::SlabCase case_;
  int streams_;
  spp::StreamSlab<double> slab_;
};

// Monte Carlo. Each question is a run of its own with the same seed; what it costs goes with the directions asked for.
class SampledSlab : public SlabSolution {
 public:
  explicit SampledSlab(const SlabSetup& setup)
      : slab_{.asymmetry = setup.homogeneous->asymmetry,
              .albedo = setup.homogeneous->albedo,
              .thickness = setup.homogeneous->thickness,
              .mu0 = setup.homogeneous->mu0},
        effort_(setup.effort),
        total_(traceSlab(slab_, {}, effort_)) {}
  SlabBudget budget() const override {
    return {total_.reflectance.value, total_.transmittance.value, total_.direct, total_.absorptance.value};
  }
  std::optional<SlabBudget> standardErrors() const override {
    return SlabBudget{total_.reflectance.standard_error, total_.transmittance.standard_error, 0.,
                      total_.absorptance.standard_error};
  }
  double incident() const override { return slab_.mu0; }
  pp::Fluxes fluxes(double depth) const override {
    const SlabTraceResult traced = traceSlab(slab_, {.depths = {depth}}, effort_);
    const double direct = slab_.mu0 * spp::precise::directPower(depth, slab_.mu0);
    return {.up = traced.flux_up[0].value, .down = traced.flux_down[0].value - direct, .direct = direct};
  }
  void radiances(std::span<const double> depths, std::span<const double> mus, std::span<const double> phis,
                 std::span<double> result) override {
    SlabMeasures measures;
    for (const double depth : depths)
      for (const double mu : mus)
        for (const double phi : phis) measures.views.push_back({.depth = depth, .mu = mu, .azimuth = phi});
    const SlabTraceResult traced = traceSlab(slab_, measures, effort_);
    std::ranges::transform(traced.radiance, result.begin(), &Estimate::value);
  }
  int streams() const override { return 0; }

 private:
  TracedSlab slab_;
  TraceEffort effort_;
  SlabTraceResult total_;
};

spp::BeamInMedium mediumOf(const SlabSetup& setup) {
  return {
      .asymmetry = setup.homogeneous->asymmetry, .albedo = setup.homogeneous->albedo, .mu0 = setup.homogeneous->mu0};
}
std::unique_ptr<SlabSolution> refinedSpp(const SlabSetup& setup) {
  return std::make_unique<RefinedSlab>(setup, spp::sppConstants(mediumOf(setup)));
}
std::unique_ptr<SlabSolution> twoStream(const SlabSetup& setup) {
  return std::make_unique<RefinedSlab>(setup, spp::twoStreamConstants(mediumOf(setup)));
}
// Two streams of each half and two orders of the azimuth: what a shader can afford.
std::unique_ptr<SlabSolution> nStream(const SlabSetup& setup) {
  return std::make_unique<RefinedSlab>(setup, spp::nStreamConstants(mediumOf(setup), 2, 2));
}
// The closest that the closed forms come at a bearable price: four streams of each half and all orders.
std::unique_ptr<SlabSolution> fourStreams(const SlabSetup& setup) {
  return std::make_unique<RefinedSlab>(setup, spp::nStreamConstants(mediumOf(setup), 4, 8));
}

template <typename Solution>
std::unique_ptr<SlabSolution> solved(const SlabSetup& setup) {
  return std::make_unique<Solution>(setup);
}

constexpr SlabModel closedForm(std::string_view name, std::string_view label,
                               std::unique_ptr<SlabSolution> (*solve)(const SlabSetup&)) {
  return {
      .name = name, .label = label, .any_problem = false, .gives_radiance = true, .is_sample = false, .solve = solve};
}

constexpr std::array kModels{
    SlabModel{.name = "pp",
              .label = "exact",
              .any_problem = true,
              .gives_radiance = true,
              .is_sample = false,
              .solve = solved<ExactSlab>},
    closedForm("spp", "simplified plane-parallel, unrefined", solved<SimplifiedSlab>),
    closedForm("sppr", "simplified plane-parallel, refined", refinedSpp),
    closedForm("twostream", "hemispheric two-stream, refined", twoStream),
    closedForm("nstream", "two streams and azimuth orders, refined", nStream),
    closedForm("best", "four streams, all azimuth orders, refined", fourStreams),
    SlabModel{.name = "mc",
              .label = "Monte Carlo",
              .any_problem = false,
              .gives_radiance = true,
              .is_sample = true,
              .solve = solved<SampledSlab>},
};

}  // namespace

SlabSetup homogeneousSlab(const pp::SlabCase& slab, const pp::Settings& settings) {
  pp::Layer layer{.thickness = slab.thickness,
                  .medium = Particles{.albedo = slab.albedo, .phase = PhaseFunction::henyeyGreenstein(slab.asymmetry)}};
  return {.problem = {.layers = {std::move(layer)}, .beam = pp::Beam{.mu0 = slab.mu0}},
          .settings = settings,
          .homogeneous = slab};
}

std::unique_ptr<SlabSolution> closedFormSlab(const spp::SlabTier& tier, const SlabSetup& setup) {
  switch (tier.form) {
    case spp::SlabForm::kDirect:
      return std::make_unique<DirectSlab>(setup);
    case spp::SlabForm::kSpp:
      return std::make_unique<SimplifiedSlab>(setup);
    case spp::SlabForm::kRefinedSpp:
      return refinedSpp(setup);
    case spp::SlabForm::kTwoStream:
      return twoStream(setup);
    case spp::SlabForm::kStreams:
      break;
  }
  return std::make_unique<RefinedSlab>(setup,
                                       spp::nStreamConstants(mediumOf(setup), tier.streams, tier.azimuth_orders));
}

std::span<const SlabModel> slabModels() {
  return kModels;
}

const SlabModel& exactSlabModel() {
  return kModels.front();
}

const SlabModel* findSlabModel(std::string_view name) {
  const auto found = std::ranges::find(kModels, name, &SlabModel::name);
  return found == kModels.end() ? nullptr : &*found;
}

}  // namespace sunfleck
