#include "render/compare/slab_contestants.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <numbers>

#include "pp_solver/slab_table.hpp"
#include "pp_solver/solver.hpp"
#include "render/compare/slab_models.hpp"
#include "scattering/double_gauss.hpp"
#include "spp/forward_share.hpp"
#include "spp/slab_tiers.hpp"
#include "spp/stream_slab.hpp"

namespace sunfleck {
namespace {

using std::numbers::pi;
using Answer = SlabContestant::Answer;
using Slab = spp::StreamSlab<float>;

void add(Answer& answer, double powers, double flux_down, double flux_up) {
  answer.powers.push_back(powers);
  answer.flux_down.push_back(flux_down);
  answer.flux_up.push_back(flux_up);
}

class SppContestant : public SlabContestant {
 public:
  explicit SppContestant(const SlabCourse& course) : SlabContestant(course) {
    for (const pp::SlabCase& slab : course.slabs) {
      const auto forward_share = static_cast<float>(spp::forwardShare(slab.asymmetry, slab.mu0));
      for (const double share : course.shares)
        places_.push_back({static_cast<float>(share * slab.thickness), static_cast<float>(slab.thickness),
                           static_cast<float>(slab.mu0), static_cast<float>(slab.albedo), forward_share});
    }
  }
  Answer answer() override {
    Answer answer;
    for (const Place& place : places_) {
      const spp::SlabPowers powers = at(place);
      add(answer, powers.down + powers.up, powers.down, powers.up);
      const auto radiance = spp::sppDiffuseRadiance(powers, spp::directPower(place.depth, place.mu0));
      for (const double mu : course_.mus)
        answer.radiances.insert(answer.radiances.end(), course_.phis.size(), mu > 0. ? radiance.down : radiance.up);
    }
    return answer;
  }
  std::size_t evaluatePowers() override {
    float sum = 0.F;
    for (const Place& place : places_) sum += at(place).down;
    kept_ = sum;
    return places_.size();
  }
  std::size_t evaluateRadiances() override {
    float sum = 0.F;
    for (const Place& place : places_)
      sum += spp::sppDiffuseRadiance(at(place), spp::directPower(place.depth, place.mu0)).down;
    kept_ = sum;
    return places_.size();
  }

 private:
  struct Place {
    float depth, thickness, mu0, albedo, forward_share;
  };
  static spp::SlabPowers at(const Place& place) {
    return spp::sppPowers(place.depth, place.thickness, place.mu0, place.albedo, place.forward_share);
  }
  std::vector<Place> places_;
};

class StreamContestant : public SlabContestant {
 public:
  StreamContestant(const SlabCourse& course, const spp::SlabTier& tier) : SlabContestant(course) {
    for (const pp::SlabCase& slab : course.slabs) {
      const spp::StreamConstants constants = constantsOf(tier, slab);
      Ready ready{Slab(constants, static_cast<float>(slab.thickness)), {}, {}};
      for (const double share : course.shares) ready.depths.push_back(static_cast<float>(share * slab.thickness));
      for (const double mu : course.mus)
        for (const double phi : course.phis) ready.views.push_back(ready.slab.view(mu, phi));
      slabs_.push_back(std::move(ready));
    }
  }
  Answer answer() override {
    Answer answer;
    for (std::size_t i = 0; i < slabs_.size(); ++i)
      for (const float depth : slabs_[i].depths) {
        const auto light = slabs_[i].slab.light(depth);
        const double mu0 = course_.slabs[i].mu0;
        add(answer, light.power_down + light.power_up, double{light.flux_down} / mu0, double{light.flux_up} / mu0);
        for (const Slab::View& view : slabs_[i].views)
          answer.radiances.push_back(slabs_[i].slab.refinedRadiance(depth, view));
      }
    return answer;
  }
  std::size_t evaluatePowers() override {
    float sum = 0.F;
    for (const Ready& ready : slabs_)
      for (const float depth : ready.depths) sum += ready.slab.light(depth).power_down;
    kept_ = sum;
    return course_.places();
  }
  std::size_t evaluateRadiances() override {
    float sum = 0.F;
    for (const Ready& ready : slabs_)
      for (std::size_t d = 0; d < ready.depths.size(); ++d)
        sum += ready.slab.refinedRadiance(ready.depths[d], ready.views[d * 13 % ready.views.size()]);
    kept_ = sum;
    return course_.places();
  }

 private:
  static spp::StreamConstants constantsOf(const spp::SlabTier& tier, const pp::SlabCase& slab) {
    const spp::BeamInMedium medium{slab.asymmetry, slab.albedo, slab.mu0};
    if (tier.form == spp::SlabForm::kRefinedSpp) return spp::sppConstants(medium);
    if (tier.form == spp::SlabForm::kTwoStream) return spp::twoStreamConstants(medium);
    return spp::nStreamConstants(medium, tier.streams, tier.azimuth_orders);
  }
  struct Ready {
    Slab slab;
    std::vector<float> depths;
    std::vector<Slab::View> views;
  };
  std::vector<Ready> slabs_;
};

class TableContestant : public SlabContestant {
 public:
  TableContestant(const SlabCourse& course, std::map<double, pp::SlabTable> tables)
      : SlabContestant(course), tables_(std::move(tables)) {
    for (const pp::SlabCase& slab : course.slabs)
      for (const double share : course.shares)
        places_.push_back({&tables_.at(slab.asymmetry), static_cast<float>(slab.thickness),
                           static_cast<float>(share * slab.thickness), static_cast<float>(slab.mu0)});
  }
  Answer answer() override {
    Answer answer;
    for (const Place& place : places_) {
      const pp::SlabTablePowers powers = place.table->powers(place.thickness, place.depth, place.mu0);
      answer.powers.push_back(powers.down + powers.direct + powers.up);
      for (const double mu : course_.mus)
        for (const double phi : course_.phis) answer.radiances.push_back(radianceAt(place, mu, phi));
    }
    return answer;
  }
  std::size_t evaluatePowers() override {
    float sum = 0.F;
    for (const Place& place : places_) sum += place.table->powers(place.thickness, place.depth, place.mu0).down;
    kept_ = sum;
    return places_.size();
  }
  std::size_t evaluateRadiances() override {
    float sum = 0.F;
    for (std::size_t i = 0; i < places_.size(); ++i)
      sum += radianceAt(places_[i], course_.mus[i % course_.mus.size()], course_.phis[i % course_.phis.size()]);
    kept_ = sum;
    return places_.size();
  }

 private:
  struct Place {
    const pp::SlabTable* table;
    float thickness, depth, mu0;
  };
  static float radianceAt(const Place& place, double mu, double phi) {
    return place.table->radiance(place.thickness, place.depth, place.mu0, static_cast<float>(mu),
                                 static_cast<float>(phi));
  }
  std::map<double, pp::SlabTable> tables_;  // by g
  std::vector<Place> places_;
};

// Solves anew for each evaluation, as each fragment has a slab of its own.
class ExactContestant : public SlabContestant {
 public:
  ExactContestant(const SlabCourse& course, int streams) : SlabContestant(course), solver_({.streams = streams}) {
    for (const pp::SlabCase& slab : course.slabs) problems_.push_back(homogeneousSlab(slab).problem);
  }
  Answer answer() override {
    Answer answer;
    for (std::size_t i = 0; i < problems_.size(); ++i) {
      solver_.solve(problems_[i]);
      std::vector<double> depths;
      for (const double share : course_.shares) {
        depths.push_back(share * course_.slabs[i].thickness);
        const pp::Fluxes fluxes = solver_.fluxes(depths.back());
        const double mu0 = course_.slabs[i].mu0;
        add(answer, 4. * pi * fluxes.mean_intensity, (fluxes.down + fluxes.direct) / mu0, fluxes.up / mu0);
      }
      std::vector<double> radiances(depths.size() * course_.directions());
      solver_.radiances(depths, course_.mus, course_.phis, radiances);
      answer.radiances.insert(answer.radiances.end(), radiances.begin(), radiances.end());
    }
    return answer;
  }
  std::size_t evaluatePowers() override {
    double sum = 0.;
    for (std::size_t i = 0; i < problems_.size(); ++i) {
      solver_.solve(problems_[i]);
      sum += solver_.fluxes(0.25 * course_.slabs[i].thickness).mean_intensity;
    }
    kept_ = sum;
    return problems_.size();
  }
  std::size_t evaluateRadiances() override {
    double sum = 0.;
    for (std::size_t i = 0; i < problems_.size(); ++i) {
      solver_.solve(problems_[i]);
      sum += solver_.radiance(0.25 * course_.slabs[i].thickness, course_.mus[i % course_.mus.size()], 1.);
    }
    kept_ = sum;
    return problems_.size();
  }

 private:
  pp::Solver solver_;
  std::vector<pp::Problem> problems_;
};

}  // namespace

SlabCourse slabCourse() {
  SlabCourse course;
  for (const double asymmetry : {0., 0.5})
    for (const double thickness : {1., 4., 16.})
      for (const double mu0 : {1., 0.5})
        course.slabs.push_back({.asymmetry = asymmetry, .albedo = 0.95, .thickness = thickness, .mu0 = mu0});
  course.shares = {0., 0.25, 0.5, 0.75, 1.};
  const DoubleGauss rule = doubleGauss(12);
  for (std::size_t i = 0; i < rule.mu.size(); ++i)
    for (const double half : {1., -1.}) {
      course.mus.push_back(half * rule.mu[i]);
      course.weights.push_back(0.5 * rule.weight[i]);
    }
  for (int j = 0; j < 6; ++j) course.phis.push_back((j + 0.5) * pi / 6.);
  return course;
}

std::unique_ptr<SlabContestant> tierContestant(const SlabCourse& course, const spp::SlabTier& tier) {
  if (tier.form == spp::SlabForm::kSpp) return std::make_unique<SppContestant>(course);
  return std::make_unique<StreamContestant>(course, tier);
}

std::unique_ptr<SlabContestant> exactContestant(const SlabCourse& course, int streams) {
  return std::make_unique<ExactContestant>(course, streams);
}

std::vector<NamedContestant> slabContestants(const SlabCourse& course, const Progress& progress) {
  using Kind = NamedContestant::Kind;
  std::vector<NamedContestant> contestants;
  for (const spp::SlabTier& tier : spp::slabTiers())
    if (tier.form != spp::SlabForm::kDirect) {
      const bool streams = tier.form == spp::SlabForm::kStreams;
      contestants.push_back({.name = std::string(tier.name),
                             .kind = Kind::kTier,
                             .streams = tier.streams,
                             .azimuth_orders = streams ? tier.azimuth_orders : 0,
                             .own_powers = &tier == &spp::slabTiers()[static_cast<std::size_t>(tier.powers)],
                             .contestant = tierContestant(course, tier)});
    }
  constexpr std::array kTableErrors{0.1, 0.02};  // bounds that the tables are to keep: small and smaller
  double made = 0.;
  for (const double max_error : kTableErrors) {
    std::map<double, pp::SlabTable> tables;
    std::size_t bytes = 0;
    for (const pp::SlabCase& slab : course.slabs)
      if (!tables.contains(slab.asymmetry)) {
        const Particles medium{.albedo = slab.albedo, .phase = PhaseFunction::henyeyGreenstein(slab.asymmetry)};
        auto table = pp::SlabTable::build(medium, {.max_thickness = 16., .max_error = max_error}, [&](double done) {
          return goOn(progress, (made + done) / (2. * kTableErrors.size()));
        });
        if (!table) return {};
        ++made;
        bytes = std::max(bytes, table->bytes());
        tables.emplace(slab.asymmetry, std::move(*table));
      }
    contestants.push_back({.name = fmt::format("table {:.2g} MB", static_cast<double>(bytes) / 1e6),
                           .kind = Kind::kTable,
                           .bytes = bytes,
                           .contestant = std::make_unique<TableContestant>(course, std::move(tables))});
  }
  for (const int streams : {4, 8, 16, 32, 64})
    contestants.push_back({.name = fmt::format("pp:{}", streams),
                           .kind = Kind::kExact,
                           .streams = streams,
                           .contestant = exactContestant(course, streams)});
  return contestants;
}

}  // namespace sunfleck
