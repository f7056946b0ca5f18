#include "render/compare/slab_models.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "spp/forward_share.hpp"
#include "spp/slab.hpp"

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

template <typename Solution>
std::unique_ptr<SlabSolution> solved(const SlabSetup& setup) {
  return std::make_unique<Solution>(setup);
}

constexpr std::array kModels{
    SlabModel{.name = "pp", .label = "exact", .any_problem = true, .gives_radiance = true, .solve = solved<ExactSlab>},
    SlabModel{.name = "spp",
              .label = "simplified plane-parallel",
              .any_problem = false,
              .gives_radiance = true,
              .solve = solved<SimplifiedSlab>},
};

}  // namespace

SlabSetup homogeneousSlab(const pp::SlabCase& slab, const pp::Settings& settings) {
  pp::Layer layer{
      .thickness = slab.thickness,
      .medium = pp::Particles{.albedo = slab.albedo, .phase = pp::PhaseFunction::henyeyGreenstein(slab.asymmetry)}};
  return {.problem = {.layers = {std::move(layer)}, .beam = pp::Beam{.mu0 = slab.mu0}},
          .settings = settings,
          .homogeneous = slab};
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
