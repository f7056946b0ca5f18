#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "core/random.hpp"
#include "core/require.hpp"
#include "pp_solver/detail/slab_samples.hpp"
#include "pp_solver/detail/slab_table_data.hpp"
#include "pp_solver/detail/table_axis.hpp"
#include "pp_solver/slab_table.hpp"

namespace sunfleck::pp {
namespace {

using detail::PowerViews;
using detail::SlabSampler;
using detail::SlabTableData;
using detail::Views;

constexpr double kPi = std::numbers::pi;
constexpr std::array<int, 4> kFirstNodes{10, 9, 8, 9};
constexpr int kMostStreams = 128, kOnceNodes = 96, kRestNodes = 20;
constexpr double kLeastError = 1e-6;  // below it single precision has no say
constexpr std::uint64_t kSeed = 20130501;

struct Interrupted {};

// Runs work(sampler, i) for all i < count in parallel, each thread with a sampler of its own, and tells `progress`.
template <typename Work>
void forEach(std::size_t count, const Medium& medium, int streams, double tolerance, const Progress& progress,
             double begin, double end, const Work& work) {
  constexpr std::size_t batches = 32;
  tbb::enumerable_thread_specific<SlabSampler> samplers([&] { return SlabSampler(medium, streams, tolerance); });
  for (std::size_t b = 0; b < batches; ++b) {
    if (!goOn(progress, begin + (end - begin) * static_cast<double>(b) / batches)) throw Interrupted();
    tbb::parallel_for(count * b / batches, count * (b + 1) / batches,
                      [&](std::size_t i) { work(samplers.local(), i); });
  }
}

double coordinate(int node, int nodes) {
  return static_cast<double>(node) / (nodes - 1);
}

double cosineAt(double t) {
  return std::max(detail::cosineFrom(t), detail::kLeastCosine);
}

std::vector<double> cosinesOf(int nodes) {
  std::vector<double> cosines;
  for (int i = 0; i < nodes; ++i) cosines.push_back(cosineAt(coordinate(i, nodes)));
  return cosines;
}

std::vector<double> depthsOf(int nodes, double thickness, double shift = 0.) {
  std::vector<double> depths;
  for (int j = 0; j + (shift > 0.) < nodes; ++j)
    depths.push_back(detail::DepthAxis::depth(thickness, (j + shift) / (nodes - 1.)));
  return depths;
}

// The look-up's errors at some places, by comparison with a sampler.
struct Compared {
  double radiance = 0., power = 0.;                // largest
  double radiance_square = 0., power_square = 0.;  // sums
  std::size_t radiances = 0, powers = 0;

  void add(const Compared& other) {
    radiance = std::max(radiance, other.radiance);
    power = std::max(power, other.power);
    radiance_square += other.radiance_square;
    power_square += other.power_square;
    radiances += other.radiances;
    powers += other.powers;
  }
  double largest() const { return std::max(radiance, power); }
};

class Builder {
 public:
  Builder(const Medium& medium, const SlabTableSettings& settings, const Progress& progress)
      : medium_(medium), settings_(settings), progress_(progress), axis_(settings.max_thickness) {
    nodes_ = kFirstNodes;
    streams_ = settings.streams;
    goal_ = settings.max_error;
    detail_ = std::max(goal_ > 0. ? goal_ : 1e-3, kLeastError) / 40.;
    first_ = detail::FirstScattering::of(medium);
  }

  std::shared_ptr<const SlabTableData> build();

 private:
  void findModes();
  std::shared_ptr<SlabTableData> make(double begin, double end) const;
  std::array<double, 4> alongAxes(const SlabTable& table, double begin, double end) const;
  SlabTableErrors heldOut(const SlabTable& table, double begin, double end) const;
  Compared compare(const SlabTable& table, SlabSampler& sampler, double w, double mu0,
                   const std::vector<double>& depths, const std::vector<double>& cosines,
                   const std::vector<double>& azimuths, bool powers) const;
  bool refine(const std::array<double, 4>& along, double bound);
  double tolerance() const { return 0.1 * detail_; }
  std::size_t bytesOf(const std::array<int, 4>& nodes) const {
    const SlabTableData shape{.nodes = nodes, .modes = modes_};
    return sizeof(float) * (shape.sourceSize() + shape.powerSize() + first_.phase.size() + first_.kernel.size() +
                            first_.projection.size());
  }

  const Medium& medium_;
  const SlabTableSettings& settings_;
  const Progress& progress_;
  detail::ThicknessAxis axis_;
  std::array<int, 4> nodes_;
  int streams_, modes_ = 1;
  double goal_, detail_;  // detail_: what an azimuth mode must add to be kept, as an error of radiance
  detail::FirstScattering first_;
};

// As many azimuth modes as some slabs show.
void Builder::findModes() {
  const int most = std::min(streams_, SlabTableData::kMostModes);
  const std::array<double, 3> thicknesses{axis_.thickness(0.4), axis_.thickness(0.7), settings_.max_thickness};
  const std::array<double, 3> incident{0.2, 0.6, 0.85};
  std::array<int, 9> modes{};
  forEach(9, medium_, streams_, tolerance(), progress_, 0., 0., [&](SlabSampler& sampler, std::size_t i) {
    const double w = thicknesses[i / 3], mu0 = incident[i % 3];
    sampler.solve(w, mu0);
    std::vector<double> sources;
    const double depth = 0.3 * w;
    const Views views = detail::viewsOf(medium_, mu0, {0.1, 0.3, 0.5, 0.7, 0.9}, detail::azimuthsFor(most));
    sampler.sources(views, {&depth, 1}, sources);
    for (std::size_t k = 0; k < sources.size(); ++k)
      if (4. * kPi * std::abs(sources[k]) > detail_) modes[i] = std::max(modes[i], static_cast<int>(k) % most);
  });
  modes_ = 1 + *std::max_element(modes.begin(), modes.end());
}

std::shared_ptr<SlabTableData> Builder::make(double begin, double end) const {
  auto data = std::make_shared<SlabTableData>();
  data->max_thickness = settings_.max_thickness;
  data->nodes = nodes_;
  data->modes = modes_;
  data->streams = streams_;
  data->first = first_;
  const auto [nw, nz, n0, nm] = nodes_;
  const auto modes = static_cast<std::size_t>(modes_), depths = static_cast<std::size_t>(nz);
  const std::size_t row = static_cast<std::size_t>(nm) * modes, w_count = static_cast<std::size_t>(nw),
                    in_count = static_cast<std::size_t>(n0);
  std::vector<double> source(2 * w_count * depths * in_count * row, 0.), power(2 * w_count * depths * in_count, 0.);
  std::vector<Views> views(in_count);
  std::vector<PowerViews> power_views(in_count);
  const double ready = begin + 0.05 * (end - begin);
  forEach(in_count, medium_, streams_, tolerance(), progress_, begin, ready, [&](SlabSampler&, std::size_t k) {
    const double mu0 = cosineAt(coordinate(static_cast<int>(k), n0));
    views[k] = detail::viewsOf(medium_, mu0, cosinesOf(nm), detail::azimuthsFor(modes_));
    power_views[k] = detail::powerViewsOf(medium_, mu0, kOnceNodes, kRestNodes, modes_);
  });
  // Where the slab is empty or the beam runs along it there is no light: those nodes stay 0.
  forEach((w_count - 1) * (in_count - 1), medium_, streams_, tolerance(), progress_, ready, end,
          [&](SlabSampler& sampler, std::size_t i) {
            const std::size_t w = 1 + i / (in_count - 1), k = 1 + i % (in_count - 1);
            const double thickness = axis_.thickness(coordinate(static_cast<int>(w), nw));
            const std::vector<double> z = depthsOf(nz, thickness);
            sampler.solve(thickness, views[k].mu0);
            std::vector<double> values;
            sampler.sources(views[k], z, values);
            for (std::size_t half = 0; half < 2; ++half)
              for (std::size_t d = 0; d < depths; ++d)
                std::copy_n(values.data() + (half * depths + d) * row, row,
                            source.data() + (((half * w_count + w) * depths + d) * in_count + k) * row);
            sampler.powers(power_views[k], z, values);
            for (std::size_t d = 0; d < depths; ++d)
              std::copy_n(values.data() + 2 * d, 2, power.data() + 2 * ((w * depths + d) * in_count + k));
          });
  std::size_t outer = 1;
  for (int axis = 0; axis < 4; ++axis) {
    std::size_t inner = modes;
    for (int a = axis + 1; a < 4; ++a) inner *= static_cast<std::size_t>(nodes_[a]);
    source = detail::splineCoefficients(source, 2 * outer, nodes_[axis], inner);
    if (axis < 3) power = detail::splineCoefficients(power, outer, nodes_[axis], 2 * inner / modes / nm);
    outer *= data->padded(axis);
  }
  data->source.assign(source.begin(), source.end());
  data->power.assign(power.begin(), power.end());
  return data;
}

Compared Builder::compare(const SlabTable& table, SlabSampler& sampler, double w, double mu0,
                          const std::vector<double>& depths, const std::vector<double>& cosines,
                          const std::vector<double>& azimuths, bool powers) const {
  Compared compared;
  Views views{mu0, cosines, azimuths, {}, {}};  // what it lacks is for sources alone
  std::vector<double> exact;
  sampler.solve(w, mu0);
  const auto single = [](double v) { return static_cast<float>(v); };
  std::size_t at = 0;
  if (!cosines.empty()) sampler.radiances(views, depths, exact);
  for (const double sign : {1., -1.})
    for (const double z : depths)
      for (const double mu : cosines)
        for (const double azimuth : azimuths) {
          const float found = table.radiance(single(w), single(z), single(mu0), single(sign * mu), single(azimuth));
          const double error = 4. * kPi * std::abs(static_cast<double>(found) - exact[at++]);
          compared.radiance = std::max(compared.radiance, error);
          compared.radiance_square += error * error;
          ++compared.radiances;
        }
  if (!powers) return compared;
  sampler.powers(detail::powerViewsOf(medium_, mu0, kOnceNodes, kRestNodes + 10, std::max(modes_, 2)), depths, exact);
  for (std::size_t d = 0; d < depths.size(); ++d) {
    const SlabTablePowers found = table.powers(single(w), single(depths[d]), single(mu0));
    for (const double error : {std::abs(static_cast<double>(found.down) - exact[2 * d]),
                               std::abs(static_cast<double>(found.up) - exact[2 * d + 1])}) {
      compared.power = std::max(compared.power, error);
      compared.power_square += error * error;
      ++compared.powers;
    }
  }
  return compared;
}

// The largest errors in the middles of cells along one axis, at nodes along all others.
std::array<double, 4> Builder::alongAxes(const SlabTable& table, double begin, double end) const {
  constexpr std::size_t pairs = 16;
  const std::vector<double> azimuths{0.07, 0.9, 2.2};
  std::array<std::array<double, 4>, 3 * pairs> found{};
  forEach(3 * pairs, medium_, streams_, tolerance(), progress_, begin, end, [&](SlabSampler& sampler, std::size_t i) {
    Random random(kSeed, i);
    const auto pick = [&](int axis, bool middle) {
      const int count = nodes_[axis] - 1;
      const int cell = std::min(count - 1, static_cast<int>(random.uniformDouble() * count));
      return (cell + (middle ? 0.5 : 1.)) / count;
    };
    const std::size_t kind = i % 3;
    const double w = axis_.thickness(pick(0, kind == 1)), mu0 = cosineAt(pick(2, kind == 2));
    const std::vector<double> depths = depthsOf(nodes_[1], w), cosines = cosinesOf(nodes_[3]);
    if (kind == 0) {
      std::vector<double> middles;
      for (int j = 0; j + 1 < nodes_[3]; ++j) middles.push_back(cosineAt((j + 0.5) / (nodes_[3] - 1)));
      found[i][3] = compare(table, sampler, w, mu0, depths, middles, azimuths, false).largest();
      found[i][1] = compare(table, sampler, w, mu0, depthsOf(nodes_[1], w, 0.5), cosines, azimuths, true).largest();
    } else {
      found[i][kind == 1 ? 0 : 2] = compare(table, sampler, w, mu0, depths, cosines, azimuths, true).largest();
    }
  });
  std::array<double, 4> largest{};
  for (const auto& one : found)
    for (std::size_t axis = 0; axis < 4; ++axis) largest[axis] = std::max(largest[axis], one[axis]);
  return largest;
}

SlabTableErrors Builder::heldOut(const SlabTable& table, double begin, double end) const {
  constexpr std::size_t slabs = 144, depth_count = 6, cosine_count = 8;
  std::vector<Compared> found(slabs);
  forEach(slabs, medium_, std::min(256, 2 * streams_), tolerance(), progress_, begin, end,
          [&](SlabSampler& sampler, std::size_t i) {
            Random random(kSeed + 1, i);
            const auto uniform = [&] { return random.uniformDouble(); };
            const auto cosine = [](double c) { return std::max(c, detail::kLeastCosine); };
            const auto coordinateOf = [&](int axis) {  // a middle, or anywhere
              const double cells = nodes_[axis] - 1, t = uniform();
              return i % 3 == 1 ? (std::min(std::floor(t * cells), cells - 1.) + 0.5) / cells : t;
            };
            const bool even = i % 3 == 0;  // places even in w, z, directions; or in the table's coordinates
            const double w = even ? settings_.max_thickness * std::max(uniform(), 1e-6)
                                  : std::max(axis_.thickness(coordinateOf(0)), 1e-8);
            const double mu0 = even ? cosine(uniform()) : cosineAt(coordinateOf(2));
            std::vector<double> depths, cosines, azimuths;
            for (std::size_t d = 0; d < depth_count; ++d)
              depths.push_back(even ? w * uniform() : detail::DepthAxis::depth(w, coordinateOf(1)));
            for (std::size_t m = 0; m < cosine_count; ++m)
              cosines.push_back(even ? cosine(uniform()) : cosineAt(coordinateOf(3)));
            for (int k = 0; k < 4; ++k) azimuths.push_back(kPi * uniform());
            found[i] = compare(table, sampler, w, mu0, depths, cosines, azimuths, true);
          });
  Compared all, evenly;
  for (std::size_t i = 0; i < slabs; ++i) {
    all.add(found[i]);
    if (i % 3 == 0) evenly.add(found[i]);
  }
  return {.radiance_max = all.radiance,
          .power_max = all.power,
          .radiance_rms = std::sqrt(evenly.radiance_square / static_cast<double>(evenly.radiances)),
          .power_rms = std::sqrt(evenly.power_square / static_cast<double>(evenly.powers)),
          .places = static_cast<int>(all.radiances)};
}

// Makes finer what limits the table; false where the size is reached.
bool Builder::refine(const std::array<double, 4>& along, double bound) {
  const double worst = *std::max_element(along.begin(), along.end());
  const double share = goal_ > 0. ? goal_ / (2. * SlabTableErrors::kSafety) : 0.5 * worst;
  std::array<int, 4> finer = nodes_;
  for (std::size_t axis = 0; axis < 4; ++axis) {
    if (along[axis] <= share) continue;
    const double factor = goal_ > 0. ? std::clamp(std::cbrt(1.5 * along[axis] / share), 1.15, 1.8) : 1.3;
    finer[axis] = std::min(SlabTableData::kMostNodes, static_cast<int>(std::ceil(factor * nodes_[axis])));
  }
  const bool not_by_nodes = worst < 0.25 * bound / SlabTableErrors::kSafety;
  if (finer == nodes_ || not_by_nodes) {
    detail_ = std::max(0.3 * detail_, 1e-8);
    if (2 * streams_ <= kMostStreams)
      streams_ *= 2;
    else if (finer == nodes_)
      for (int& n : finer) n = std::min(SlabTableData::kMostNodes, n + (n + 4) / 5);
    findModes();
  }
  if (bytesOf(finer) > settings_.max_bytes || finer == std::array{512, 512, 512, 512}) return false;
  nodes_ = finer;
  return true;
}

std::string aboutOf(const Medium& medium, const detail::FirstScattering& first, const std::string& note) {
  std::ostringstream text;
  if (const auto* leaves = std::get_if<LeafScattering>(&medium)) {
    double mean = 0.;
    for (const LeafAngles::Node& node : leaves->angles.nodes()) mean += node.weight * node.inclination;
    text << "leaves, mean inclination " << 180. / kPi * mean << " degrees, reflectance " << leaves->reflectance
         << ", transmittance " << leaves->transmittance;
  } else {
    text << (first.kind == detail::FirstScattering::Kind::angle ? "particles" : "Henyey-Greenstein particles")
         << ", omega " << std::get<Particles>(medium).albedo << ", g " << first.asymmetry;
  }
  return note.empty() ? text.str() : text.str() + ": " + note;
}

std::shared_ptr<const SlabTableData> Builder::build() {
  findModes();
  std::shared_ptr<SlabTableData> best;
  for (int round = 0;; ++round) {
    const double begin = 1. - std::pow(0.6, round), length = 0.4 * std::pow(0.6, round);
    const auto data = make(begin, begin + 0.6 * length);
    const SlabTable table(data);
    data->errors = heldOut(table, begin + 0.6 * length, begin + 0.8 * length);
    if (!best || data->errors.bound() < best->errors.bound()) best = data;
    if (goal_ > 0. && best->errors.bound() <= goal_) break;
    if (!refine(alongAxes(table, begin + 0.8 * length, begin + length), data->errors.bound())) {
      if (goal_ == 0.) break;
      std::ostringstream rule;
      rule << "at least " << 1.05 * best->errors.bound() << ", what " << settings_.max_bytes << " bytes allow";
      require(false, "max_error", goal_, rule.str());
    }
  }
  if (!goOn(progress_, 1.)) throw Interrupted();
  best->about = aboutOf(medium_, first_, settings_.note);
  return best;
}

void requireTabulated(const Medium& medium, const SlabTableSettings& settings) {
  Problem problem;
  problem.layers.push_back({.thickness = 1., .medium = medium});
  requireSolvable(problem);
  if (const auto* leaves = std::get_if<LeafScattering>(&medium))
    require(leaves->hot_spot == 0., "hot_spot", leaves->hot_spot, "0 in a table");
  require(settings.max_thickness >= 0.01 && settings.max_thickness <= 1000., "max_thickness", settings.max_thickness,
          "in [0.01, 1000]");
  require(settings.max_error == 0. || (settings.max_error >= kLeastError && settings.max_error <= 1e3), "max_error",
          settings.max_error, "0, or in [1e-6, 1000]");
  require(settings.max_bytes >= (std::size_t{1} << 20) && settings.max_bytes <= (std::size_t{4} << 30), "max_bytes",
          settings.max_bytes, "from 1 MiB to 4 GiB");
  require(settings.streams >= 8 && settings.streams <= kMostStreams && settings.streams % 2 == 0, "streams",
          settings.streams, "even, 8 to 128");
  require(settings.note.size() <= 200 &&
              std::all_of(settings.note.begin(), settings.note.end(), [](char c) { return c >= ' ' && c <= '~'; }),
          "note", settings.note.size(), "at most 200 printable characters");
}

}  // namespace

std::optional<SlabTable> SlabTable::build(const Medium& medium, const SlabTableSettings& settings,
                                          const Progress& progress) {
  requireTabulated(medium, settings);
  try {
    return SlabTable(Builder(medium, settings, progress).build());
  } catch (const Interrupted&) {
    return std::nullopt;
  }
}

}  // namespace sunfleck::pp
