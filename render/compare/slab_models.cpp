#include "render/compare/slab_models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "core/require.hpp"
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

// What isSlabUnderBeam() tells.
spp::BeamInMedium beamOf(const SlabSetup& setup) {
  return {setup.problem.layers.front().medium, setup.problem.beam->mu0};
}
double thicknessOf(const SlabSetup& setup) {
  return setup.problem.layers.front().thickness;
}

// Leaf area that light along the beam meets across it, per leaf area: particles stand for leaves of all directions.
double leafProjectionOf(const SlabSetup& setup) {
  const Medium& medium = setup.problem.layers.front().medium;
  return std::holds_alternative<LeafScattering>(medium) ? extinction(medium, setup.problem.beam->mu0) : 0.5;
}

// Direct light alone: all that SS knows.
class DirectSlab : public SlabSolution {
 public:
  explicit DirectSlab(const SlabSetup& setup)
      : mu0_(setup.problem.beam->mu0), thickness_(thicknessOf(setup)), projection_(leafProjectionOf(setup)) {
    extinction_ = extinction(setup.problem.layers.front().medium, mu0_);
  }
  SlabBudget budget() const override {
    const double direct = directAt(thickness_);
    return {0., direct, direct, 1. - direct};
  }
  double incident() const override { return mu0_; }
  pp::Fluxes fluxes(double depth) const override {
    const double direct = directAt(depth);
    return {.direct = mu0_ * direct,
            .mean_intensity = direct / (4. * std::numbers::pi),
            .leaf_irradiance = projection_ * direct};
  }
  void radiances(std::span<const double>, std::span<const double>, std::span<const double>,
                 std::span<double> result) override {
    std::ranges::fill(result, 0.);
  }
  int streams() const override { return 0; }

 private:
  double directAt(double depth) const { return spp::precise::directPower(extinction_ * depth, mu0_); }
  double mu0_, thickness_, projection_, extinction_;
};

// SPP as it is printed, without the refinement: radiance is the same for all directions of a half. Depth is scaled by
// the beam's extinction, which all light has in it.
class SimplifiedSlab : public SlabSolution {
 public:
  explicit SimplifiedSlab(const SlabSetup& setup)
      : mu0_(setup.problem.beam->mu0), thickness_(thicknessOf(setup)), projection_(leafProjectionOf(setup)) {
    const Medium& medium = setup.problem.layers.front().medium;
    extinction_ = extinction(medium, mu0_);
    albedo_ = singleScatteringAlbedo(medium);
    forward_share_ = spp::forwardShare(medium, mu0_);
  }
  // Powers are relative to F = P+(0), and fluxes are mu0 times powers: the factor cancels in shares.
  SlabBudget budget() const override {
    const double reflectance = at(0.).up, transmittance = at(thickness_).down;
    return {reflectance, transmittance, directAt(thickness_), std::max(0., 1. - reflectance - transmittance)};
  }
  double incident() const override { return mu0_; }
  pp::Fluxes fluxes(double depth) const override {
    const auto powers = at(depth);
    const double direct = directAt(depth);
    return {.up = mu0_ * powers.up,
            .down = mu0_ * std::max(0., powers.down - direct),
            .direct = mu0_ * direct,
            .mean_intensity = (powers.down + powers.up) / (4. * std::numbers::pi),
            .leaf_irradiance = projection_ * (powers.down + powers.up)};
  }
  void radiances(std::span<const double> depths, std::span<const double> mus, std::span<const double> phis,
                 std::span<double> result) override {
    auto out = result.begin();
    for (const double depth : depths) {
      const auto radiance = spp::precise::sppDiffuseRadiance(at(depth), directAt(depth));
      for (const double mu : mus) out = std::fill_n(out, phis.size(), mu > 0. ? radiance.down : radiance.up);
    }
  }
  int streams() const override { return 2; }

 private:
  double directAt(double depth) const { return spp::precise::directPower(extinction_ * depth, mu0_); }
  spp::precise::SlabPowers at(double depth) const {
    return spp::precise::sppPowers(extinction_ * depth, extinction_ * thickness_, mu0_, albedo_, forward_share_);
  }
  double mu0_, thickness_, projection_, extinction_, albedo_, forward_share_;
};

// The closed forms made of modes, their radiance refined by one integral along the line of sight.
class RefinedSlab : public SlabSolution {
 public:
  RefinedSlab(const SlabSetup& setup, spp::StreamConstants constants)
      : mu0_(setup.problem.beam->mu0),
        thickness_(thicknessOf(setup)),
        streams_(2 * constants.streams()),
        slab_(std::move(constants), thickness_) {
    require(mu0_ >= spp::kLeastCosine, "mu0", mu0_,
            fmt::format("at least {:g} for a refined closed form", spp::kLeastCosine));
  }
  SlabBudget budget() const override {
    const double reflectance = slab_.reflectance(), transmittance = slab_.transmittance();
    return {reflectance, transmittance, slab_.light(thickness_).direct, std::max(0., 1. - reflectance - transmittance)};
  }
  double incident() const override { return mu0_; }
  pp::Fluxes fluxes(double depth) const override {
    const auto light = slab_.light(depth);
    const double direct = mu0_ * light.direct;
    return {.up = light.flux_up,
            .down = std::max(0., light.flux_down - direct),
            .direct = direct,
            .mean_intensity = (light.power_down + light.power_up) / (4. * std::numbers::pi),
            .leaf_irradiance = light.leaf_irradiance};
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
  double mu0_, thickness_;
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

std::unique_ptr<SlabSolution> refinedSpp(const SlabSetup& setup) {
  return std::make_unique<RefinedSlab>(setup, spp::sppConstants(beamOf(setup)));
}
std::unique_ptr<SlabSolution> twoStream(const SlabSetup& setup) {
  return std::make_unique<RefinedSlab>(setup, spp::twoStreamConstants(beamOf(setup)));
}
auto nStream(int streams, int azimuth_orders) {
  return [streams, azimuth_orders](const SlabSetup& setup) -> std::unique_ptr<SlabSolution> {
    return std::make_unique<RefinedSlab>(setup, spp::nStreamConstants(beamOf(setup), streams, azimuth_orders));
  };
}

template <typename Solution>
std::unique_ptr<SlabSolution> solved(const SlabSetup& setup) {
  return std::make_unique<Solution>(setup);
}

template <typename Solve>
SlabModel closedForm(std::string name, std::string label, Solve solve) {
  return {.name = std::move(name),
          .label = std::move(label),
          .scope = SlabScope::slab_under_beam,
          .gives_radiance = true,
          .is_sample = false,
          .solve = std::move(solve)};
}

const std::vector<SlabModel>& models() {
  static const std::vector<SlabModel> all{
      {.name = "pp",
       .label = "exact",
       .scope = SlabScope::any,
       .gives_radiance = true,
       .is_sample = false,
       .solve = solved<ExactSlab>},
      closedForm("ss", "direct light alone", solved<DirectSlab>),
      closedForm("spp", "simplified plane-parallel, unrefined", solved<SimplifiedSlab>),
      closedForm("sppr", "simplified plane-parallel, refined", refinedSpp),
      closedForm("twostream", "hemispheric two-stream, refined", twoStream),
      // what a shader can afford
      closedForm("nstream", "two streams and azimuth orders, refined", nStream(2, 2)),
      // the closest that the closed forms come at a bearable price
      closedForm("best", "four streams, all azimuth orders, refined", nStream(4, 8)),
      {.name = "mc",
       .label = "Monte Carlo",
       .scope = SlabScope::henyey_greenstein,
       .gives_radiance = true,
       .is_sample = true,
       .solve = solved<SampledSlab>},
  };
  return all;
}

// nstream:N and nstream:N:ORDERS.
const std::vector<SlabModel>& streamModels() {
  static const std::vector<SlabModel> all = [] {
    constexpr int kMostStreams = 8;
    std::vector<SlabModel> list;
    for (int n = 1; n <= kMostStreams; ++n) {
      const auto add = [&](const std::string& suffix, int orders) {
        list.push_back(closedForm(fmt::format("nstream:{}{}", n, suffix),
                                  fmt::format("{} stream{}, {} azimuth order{}, refined", n, n == 1 ? "" : "s", orders,
                                              orders == 1 ? "" : "s"),
                                  nStream(n, orders)));
      };
      add("", 2);
      add(":all", 2 * n);
      for (int orders = 1; orders <= 2 * n; ++orders) add(fmt::format(":{}", orders), orders);
    }
    return list;
  }();
  return all;
}

}  // namespace

SlabSetup slabUnderBeam(Medium medium, double thickness, double mu0, const pp::Settings& settings) {
  return {.problem = {.layers = {{.thickness = thickness, .medium = std::move(medium)}}, .beam = pp::Beam{.mu0 = mu0}},
          .settings = settings};
}

SlabSetup homogeneousSlab(const pp::SlabCase& slab, const pp::Settings& settings) {
  SlabSetup setup =
      slabUnderBeam(Particles{.albedo = slab.albedo, .phase = PhaseFunction::henyeyGreenstein(slab.asymmetry)},
                    slab.thickness, slab.mu0, settings);
  setup.homogeneous = slab;
  return setup;
}

bool isSlabUnderBeam(const pp::Problem& problem) {
  const auto dark = [](const pp::Sky& sky) {
    const double* radiance = std::get_if<double>(&sky);
    return radiance && *radiance == 0.;
  };
  if (problem.layers.size() != 1 || !problem.beam || !dark(problem.above) || !dark(problem.below)) return false;
  const pp::Layer& layer = problem.layers.front();
  const auto* leaves = std::get_if<LeafScattering>(&layer.medium);
  return layer.emission_top == 0. && layer.emission_bottom == 0. && problem.beam->irradiance == 1. &&
         problem.beam->azimuth == 0. && problem.ground.albedo == 0. && !problem.ground.brdf &&
         problem.ground.emission == 0. && !(leaves && leaves->hot_spot > 0.);
}

bool takes(const SlabModel& model, const SlabSetup& setup) {
  if (model.scope == SlabScope::any) return true;
  return model.scope == SlabScope::henyey_greenstein ? setup.homogeneous.has_value() : isSlabUnderBeam(setup.problem);
}

std::span<const SlabModel> slabModels() {
  return models();
}

const SlabModel& exactSlabModel() {
  return models().front();
}

const SlabModel* findSlabModel(std::string_view name) {
  for (const std::vector<SlabModel>* list : {&models(), &streamModels()}) {
    const auto found = std::ranges::find(*list, name, &SlabModel::name);
    if (found != list->end()) return &*found;
  }
  return nullptr;
}

}  // namespace sunfleck
