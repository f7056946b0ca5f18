#include "render/compare/stand_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "grid/foliage_stand.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"
#include "render/compare/log_plot.hpp"
#include "render/compare/machine_name.hpp"

namespace sunfleck {
namespace {

constexpr std::size_t kRepeated = 64;  // trees: larger stands are prepared once

using Tree = std::shared_ptr<const TreeMesh>;

// `count` trees, in turn of each species, in a square, as far apart as the widest is wide.
class BenchedStand {
 public:
  BenchedStand(const std::vector<Tree>& trees, std::size_t count) : trees_(trees) {
    for (const Tree& tree : trees) {
      const glm::vec3 size = leafBounds(*tree).size();
      spacing_ = std::max({spacing_, size.x, size.y});
      stand.addPrototype(tree);
    }
    const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    for (std::size_t i = 0; i < count; ++i)
      stand.add(i % trees.size(),
                spacing_ * glm::vec3(static_cast<float>(i % side), static_cast<float>(i / side), 0.f));
    turnSun(0.5f);
    std::vector<glm::vec3> sky;
    for (const Direction& direction : stand.sampleDirections())
      sky.push_back(direction.z > 0.f ? glm::vec3(0.2f, 0.3f, 0.5f) : glm::vec3(0.05f));
    stand.setSky(sky);
  }
  void turnSun(float zenith) {
    const Direction sun = sunlight(zenith, 0.3f);
    stand.setLights(std::span(&sun, 1));
  }
  void prepareLight() {
    for (std::size_t prototype = 0; prototype < trees_.size(); ++prototype) stand.lightMap(prototype, 0);
  }
  void prepare() { stand.prepareCompensation(stand.allInstances()); }
  void prepareSky() { stand.prepareSkyLight(stand.allInstances()); }
  void moveOne() {
    const std::size_t middle = stand.instances() / 2;
    stand.move(middle, spacing_ * glm::vec3(1.3f, 1.2f, 0.f));
  }

  FoliageStand stand;

 private:
  const std::vector<Tree>& trees_;
  float spacing_ = 0.f;
};

template <typename Work>
double secondsOf(const Work& work) {
  double seconds = 0.;
  {
    const Stopwatch watch(seconds);
    work();
  }
  return seconds;
}

void requireSameWhenMoved(const std::vector<Tree>& trees) {
  BenchedStand moved(trees, 9), afresh(trees, 9);
  moved.prepare();
  moved.moveOne();
  afresh.moveOne();
  moved.prepare();
  afresh.prepare();
  for (const std::size_t i : afresh.stand.allInstances())
    if (!std::ranges::equal(moved.stand.compensation(i, 0), afresh.stand.compensation(i, 0)))
      throw std::runtime_error("a moved tree leaves other G-factors than a stand made afresh: no time is told");
}

StandBenchRow measured(const std::string& name, const std::vector<Tree>& trees, std::size_t count, int most_rounds) {
  const auto once = [&] {
    BenchedStand benched(trees, count);
    FoliageStand& stand = benched.stand;
    StandBenchRow row{.stand = name, .prototypes = trees.size(), .trees = count};
    row.prepare = secondsOf([&] {
      for (std::size_t prototype = 0; prototype < trees.size(); ++prototype) stand.cells(prototype);
    });
    row.light_map = secondsOf([&] { benched.prepareLight(); }) / static_cast<double>(trees.size());
    row.prepare += secondsOf([&] { benched.prepare(); });
    row.sky = secondsOf([&] { benched.prepareSky(); });
    benched.turnSun(0.6f);
    row.turn_sun = secondsOf([&] { benched.prepare(); });
    benched.moveOne();
    row.move_tree = secondsOf([&] {
      benched.prepare();
      benched.prepareSky();
    });
    for (std::size_t prototype = 0; prototype < trees.size(); ++prototype)
      stand.setLeaf(prototype, {LeafOptics{0.06f, 0.03f}, {0.11f, 0.07f}, {0.05f, 0.02f}});
    row.change_leaf = secondsOf([&] {
      benched.prepare();
      benched.prepareSky();
    });
    row.megabytes = static_cast<double>(stand.memoryBytes()) * 1e-6;
    for (std::size_t i = 0; i < count; ++i) {
      const TreeMesh& mesh = *trees[i % trees.size()];
      row.triangles += mesh.leaf_triangles.size() + mesh.wood_triangles.size();
      row.cells += stand.compensation(i, 0).size();
    }
    return row;
  };
  std::vector<StandBenchRow> rounds{once()};
  while (count <= kRepeated && rounds.size() < static_cast<std::size_t>(most_rounds)) rounds.push_back(once());
  StandBenchRow row = rounds.front();
  for (double StandBenchRow::*const time :
       {&StandBenchRow::prepare, &StandBenchRow::sky, &StandBenchRow::light_map, &StandBenchRow::turn_sun,
        &StandBenchRow::move_tree, &StandBenchRow::change_leaf}) {
    std::ranges::sort(rounds, {}, time);
    row.*time = rounds[rounds.size() / 2].*time;
  }
  return row;
}

}  // namespace

StandBench benchStands(std::size_t most_trees, int rounds, const Progress& progress) {
  const auto grown = [](const std::string& name) { return std::make_shared<const TreeMesh>(grow(species(name), 1)); };
  struct Case {
    std::string name;
    std::vector<Tree> trees;
    std::size_t count;
  };
  std::vector<Case> cases;
  for (const std::string name : {"cherry", "maple"})
    for (const std::size_t count : {16, 64})
      if (count <= most_trees) cases.push_back({fmt::format("{} {}", count, name), {grown(name)}, count});
  std::vector<Tree> all;
  for (const std::string name : {"black_oak", "cherry", "maple", "quaking_aspen"}) all.push_back(grown(name));
  for (std::size_t count = 16; count <= most_trees; count *= 4) {
    // The largest is as large as asked for.
    const std::size_t trees = count * 4 > most_trees ? most_trees : count;
    cases.push_back({fmt::format("{} of {} species", trees, all.size()), all, trees});
  }

  requireSameWhenMoved(all);
  StandBench bench{.machine = machineName(), .rows = {}};
  double work = 0., done = 0.;
  for (const Case& one : cases) work += static_cast<double>(one.count) + 100.;
  for (const Case& one : cases) {
    if (!goOn(progress, done / work)) return {};
    bench.rows.push_back(measured(one.name, one.trees, one.count, rounds));
    done += static_cast<double>(one.count) + 100.;
  }
  return bench;
}

std::optional<PaperStand> paperStand(const std::string& stand) {
  // Shinya et al. 2013, Table 4: Core2 Quad Q8200, GeForce GTX 295, 22 sample directions.
  struct Entry {
    const char* stand;
    PaperStand paper;
  };
  for (const Entry& entry : {Entry{"16 cherry", {0.117, 0.025, 0.0039}}, Entry{"64 cherry", {0.533, 0.1, 0.0039}},
                             Entry{"16 maple", {0.0953, 0.02, 0.0067}}, Entry{"64 maple", {0.426, 0.08, 0.0067}}})
    if (stand == entry.stand) return entry.paper;
  return std::nullopt;
}

std::string standBenchCsv(const StandBench& bench) {
  std::string csv =
      "stand,prototypes,trees,triangles,cells,prepare_s,sky_s,light_map_s,turn_sun_s,move_tree_s,change_leaf_s,"
      "megabytes\n";
  for (const StandBenchRow& r : bench.rows)
    csv += fmt::format("{},{},{},{},{},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g}\n", r.stand, r.prototypes,
                       r.trees, r.triangles, r.cells, r.prepare, r.sky, r.light_map, r.turn_sun, r.move_tree,
                       r.change_leaf, r.megabytes);
  return csv;
}

std::string standBenchPlot(const StandBench& bench) {
  LogPanel panel{
      .title = "Stands of all species", .x_title = "trees", .y_title = "wall time [s]", .rising = true, .curves = {}};
  struct Shown {
    const char *label, *colour;
    double StandBenchRow::*time;
  };
  for (const Shown& shown : {Shown{"prepare all (steps 2, 3)", "#762a83", &StandBenchRow::prepare},
                             Shown{"turn the sun (step 5, G)", "#e08214", &StandBenchRow::turn_sun},
                             Shown{"change the sky (step 4)", "#2166ac", &StandBenchRow::sky},
                             Shown{"move one tree", "#1b7837", &StandBenchRow::move_tree}}) {
    LogCurve curve{.label = shown.label, .colour = shown.colour, .points = {}};
    for (const StandBenchRow& row : bench.rows)
      if (row.prototypes > 1)
        curve.points.push_back({.x = static_cast<double>(row.trees), .y = row.*shown.time, .mark = ""});
    panel.curves.push_back(std::move(curve));
  }
  return logPlot("What a stand costs to prepare and to change", bench.machine, {panel}, 1);
}

}  // namespace sunfleck
