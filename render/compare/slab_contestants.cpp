#include "render/compare/slab_contestants.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "pp_solver/slab_table.hpp"
#include "pp_solver/solver.hpp"
#include "render/compare/slab_models.hpp"
#include "spp/forward_share.hpp"
#include "spp/slab_arrays.hpp"
#include "spp/slab_tiers.hpp"
#include "spp/stream_slab.hpp"

namespace sunfleck {
namespace {

using std::numbers::pi;
using Answer = SlabContestant::Answer;

void add(Answer& answer, double powers, double flux_down, double flux_up) {
  answer.powers.push_back(powers);
  answer.flux_down.push_back(flux_down);
  answer.flux_up.push_back(flux_up);
}

// Blocks of places of one medium and beam, as a renderer evaluates leaves; depth and slab of each place are new to it.
class TierContestant : public SlabContestant {
 public:
  TierContestant(const SlabCourse& course, const spp::SlabTier& tier)
      : SlabContestant(course), form_(tier.form), first_(kBlockSize), second_(kBlockSize) {
    for (std::size_t i = 0; i < course.slabs.size(); ++i) {
      const pp::SlabCase& slab = course.slabs[i];
      Block& block = blockOf(slab, tier);
      for (std::size_t d = 0; d < course.shares.size(); ++d) {
        block.course_places.push_back(i * course.shares.size() + d);
        block.thickness.push_back(static_cast<float>(slab.thickness));
        block.depth.push_back(static_cast<float>(course.shares[d] * slab.thickness));
      }
    }
    for (Block& block : blocks_)
      for (std::size_t i = 0; block.depth.size() < kBlockSize; ++i) {
        block.thickness.push_back(block.thickness[i]);
        block.depth.push_back(block.depth[i]);
      }
  }

  Answer answer() override {
    const std::size_t directions = course_.sphere.directions();
    Answer answer{.powers = std::vector<double>(course_.places()),
                  .flux_down = answer.powers,
                  .flux_up = answer.powers,
                  .radiances = std::vector<double>(course_.places() * directions)};
    for (const Block& block : blocks_) {
      powers(block);
      for (std::size_t i = 0; i < block.course_places.size(); ++i) {
        const std::size_t place = block.course_places[i];
        answer.powers[place] = double{first_[i]} + double{second_[i]};
        answer.flux_down[place] = double{first_[i]};
        answer.flux_up[place] = double{second_[i]};
        if (hasSppPowers()) continue;
        const auto light = spp::StreamSlab<float>(block.constants, block.thickness[i]).light(block.depth[i]);
        answer.flux_down[place] = double{light.flux_down} / block.of.mu0;
        answer.flux_up[place] = double{light.flux_up} / block.of.mu0;
      }
      for (std::size_t j = 0; j < directions; ++j) {
        const std::vector<float>& found = radiance(block, j);
        for (std::size_t i = 0; i < block.course_places.size(); ++i)
          answer.radiances[block.course_places[i] * directions + j] = double{found[i]};
      }
    }
    return answer;
  }
  std::size_t evaluatePowers() override {
    for (const Block& block : blocks_) {
      powers(block);
      kept_ = double{first_[block.course_places.size()]};
    }
    return blocks_.size() * kBlockSize;
  }
  // In one direction of each half for each block.
  std::size_t evaluateRadiances() override {
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      for (std::size_t half = 0; half < 2; ++half)
        kept_ = double{
            radiance(blocks_[b], ((2 * b + half) * course_.sphere.phis.size() + b) % course_.sphere.directions())[b]};
    return 2 * blocks_.size() * kBlockSize;
  }

 private:
  static constexpr std::size_t kBlockSize = 960;  // what is read and written stays in the nearest cache
  struct Block {
    pp::SlabCase of;  // its medium and beam
    float forward_share;
    spp::StreamConstants constants;
    spp::StreamArrays arrays;
    std::vector<spp::StreamView<float>> views;  // of the course's directions
    std::vector<std::size_t> course_places;     // the first places are these of the course; they recur after
    std::vector<float> depth, thickness;
  };

  Block& blockOf(const pp::SlabCase& slab, const spp::SlabTier& tier) {
    for (Block& block : blocks_)
      if (block.of.asymmetry == slab.asymmetry && block.of.albedo == slab.albedo && block.of.mu0 == slab.mu0)
        return block;
    const spp::StreamConstants constants = constantsOf(tier, {slab.asymmetry, slab.albedo, slab.mu0});
    blocks_.push_back({.of = slab,
                       .forward_share = static_cast<float>(spp::forwardShare(slab.asymmetry, slab.mu0)),
                       .constants = constants,
                       .arrays = spp::StreamArrays(constants)});
    for (const double mu : course_.sphere.mus)
      for (const double phi : course_.sphere.phis)
        blocks_.back().views.push_back(spp::streamView<float>(constants, mu, phi));
    return blocks_.back();
  }
  static spp::StreamConstants constantsOf(const spp::SlabTier& tier, const spp::BeamInMedium& beam) {
    if (tier.form == spp::SlabForm::kStreams) return spp::nStreamConstants(beam, tier.streams, tier.azimuth_orders);
    return tier.form == spp::SlabForm::kTwoStream ? spp::twoStreamConstants(beam) : spp::sppConstants(beam);
  }
  bool hasSppPowers() const { return form_ == spp::SlabForm::kSpp || form_ == spp::SlabForm::kRefinedSpp; }

  // P+ and P- of the block's places into first_ and second_.
  void powers(const Block& block) {
    if (hasSppPowers())
      spp::sppPowers(block.depth, block.thickness, static_cast<float>(block.of.mu0),
                     static_cast<float>(block.of.albedo), block.forward_share, first_, second_);
    else
      block.arrays.powers(block.depth, block.thickness, first_, second_);
  }
  const std::vector<float>& radiance(const Block& block, std::size_t direction) {
    if (form_ == spp::SlabForm::kSpp) {
      spp::sppRadiance(block.depth, block.thickness, static_cast<float>(block.of.mu0),
                       static_cast<float>(block.of.albedo), block.forward_share, first_, second_);
      return course_.sphere.mus[direction / course_.sphere.phis.size()] > 0. ? first_ : second_;
    }
    block.arrays.refinedRadiance(block.depth, block.thickness, block.views[direction], first_);
    return first_;
  }

  spp::SlabForm form_;
  std::vector<Block> blocks_;
  std::vector<float> first_, second_;  // what is computed for a block
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
      for (const double mu : course_.sphere.mus)
        for (const double phi : course_.sphere.phis) answer.radiances.push_back(radianceAt(place, mu, phi));
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
      sum += radianceAt(places_[i], course_.sphere.mus[i % course_.sphere.mus.size()],
                        course_.sphere.phis[i % course_.sphere.phis.size()]);
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

// Solves anew for each evaluation, as each fragment has a slab of its own; in a batch, for each slab.
class ExactContestant : public SlabContestant {
 public:
  ExactContestant(const SlabCourse& course, int streams)
      : SlabContestant(course), streams_(streams), solver_({.streams = streams}) {
    for (std::size_t i = 0; i < kBatch; ++i) batch_.push_back(course.slabs[i % course.slabs.size()]);
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
      std::vector<double> radiances(depths.size() * course_.sphere.directions());
      solver_.radiances(depths, course_.sphere.mus, course_.sphere.phis, radiances);
      answer.radiances.insert(answer.radiances.end(), radiances.begin(), radiances.end());
    }
    evaluateBatch();
    for (std::size_t i = 0; i < problems_.size(); ++i) {
      const std::size_t lit_face = i * course_.shares.size(), other_face = lit_face + course_.shares.size() - 1;
      // Both sum in different orders; what is left apart in a slab as tame as these is rounding.
      if (!(std::abs(solved_[i].reflectance - answer.flux_up[lit_face]) < 1e-9 &&
            std::abs(solved_[i].transmittance - answer.flux_down[other_face]) < 1e-9))
        throw std::runtime_error(fmt::format("pp:{}: a batch differs from one slab after another", streams_));
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
      sum += solver_.radiance(0.25 * course_.slabs[i].thickness, course_.sphere.mus[i % course_.sphere.mus.size()], 1.);
    }
    kept_ = sum;
    return problems_.size();
  }
  std::size_t evaluateBatch() override {
    one_thread_.execute([&] { pp::solveSlabs(batch_, solved_, streams_); });
    kept_ = solved_.back().reflectance;
    return kBatch;
  }

 private:
  static constexpr std::size_t kBatch = 48;  // fills all lanes
  int streams_;
  pp::Solver solver_;
  std::vector<pp::Problem> problems_;
  std::vector<pp::SlabCase> batch_;
  std::vector<pp::SlabFluxes> solved_ = std::vector<pp::SlabFluxes>(kBatch);
  tbb::task_arena one_thread_{1};
};

}  // namespace

SlabCourse slabCourse() {
  SlabCourse course;
  for (const double asymmetry : {0., 0.5})
    for (const double thickness : {1., 4., 16.})
      for (const double mu0 : {1., 0.5})
        course.slabs.push_back({.asymmetry = asymmetry, .albedo = 0.95, .thickness = thickness, .mu0 = mu0});
  course.shares = {0., 0.25, 0.5, 0.75, 1.};
  course.sphere = sphereRule(6, 6);
  return course;
}

std::unique_ptr<SlabContestant> tierContestant(const SlabCourse& course, const spp::SlabTier& tier) {
  return std::make_unique<TierContestant>(course, tier);
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
