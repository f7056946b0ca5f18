// The field against Monte Carlo: errors by category, per leaf and in all, and times.
//   measure_field TREE... [--paths N] [--keep FOLDER] [--csv FILE] [--suns 0,45,70] [--albedos .5,.95] [--single]
//                 [--periodic] [--no-wood] [--split] [--axes N] [--crossings X] ... | [--cells N] | [--others]
// A tree is a species, a file or "crown", of random leaves. --cells judges the field on cells alone, so many along the
// longest side; --others what knows no 3-D solution: single scattering, the slab without and with compensation, and the
// slab's source along lines (DampedLine). --keep keeps Monte Carlo's results.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include "bench/damped_line.hpp"
#include "bench/kept_trace.hpp"
#include "bench/leaf_errors.hpp"
#include "bench/measurement.hpp"
#include "core/csv_field.hpp"
#include "core/elapsed.hpp"
#include "core/whole_file.hpp"
#include "field/clumping.hpp"
#include "field/grid_field.hpp"
#include "field/leaf_field.hpp"
#include "grid/leaf_depth.hpp"
#include "render/leaf_models.hpp"
#include "render/stand_geometry.hpp"

using namespace sunfleck;

namespace {

constexpr float kAzimuth = 0.5f;  // of the sun [rad]

struct Options {
  std::vector<std::string> trees;
  std::vector<float> suns{0.f, 45.f, 70.f};
  std::vector<float> albedos{0.5f, 0.95f, 0.99f};
  std::uint64_t paths = 4'000'000;
  std::filesystem::path keep, csv;
  bool single = true, periodic = true, wood = true, split = false;
  std::optional<int> cells;
  bool others = false;
  FieldEffort effort;
};

void addOptions(CLI::App& app, Options& options) {
  app.add_option("trees", options.trees)->required();
  app.add_option("--suns", options.suns)->delimiter(',');
  app.add_option("--albedos", options.albedos)->delimiter(',');
  app.add_option("--paths", options.paths);
  app.add_option("--keep", options.keep);
  app.add_option("--csv", options.csv);
  app.add_option("--cells", options.cells);
  app.add_flag("--others", options.others);
  app.add_flag("!--single", options.periodic);
  app.add_flag("!--periodic", options.single);
  app.add_flag("!--no-wood", options.wood);
  app.add_flag("--split", options.split);
  app.add_option("--axes", options.effort.exchange.axes);
  app.add_option("--crossings", options.effort.exchange.crossings);
  app.add_option("--pixels", options.effort.direct.pixels);
  app.add_option("--extent", options.effort.elements.largest_extent);
  app.add_option("--flatness", options.effort.elements.least_flatness);
  app.add_option("--patch", options.effort.elements.wood_patch);
  app.add_option("--error", options.effort.solver.error);
}

// Each leaf triangle cut into four.
void split(TreeMesh& mesh) {
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> leaves;
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
    const glm::uvec3 t = mesh.leaf_triangles[i];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [a, b] : {std::pair(t.x, t.y), std::pair(t.y, t.z), std::pair(t.z, t.x)})
      mesh.vertices.push_back(0.5f * (mesh.vertices[a] + mesh.vertices[b]));
    for (const glm::uvec3& part : {glm::uvec3(t.x, first, first + 2), glm::uvec3(first, t.y, first + 1),
                                   glm::uvec3(first + 2, first + 1, t.z), glm::uvec3(first, first + 1, first + 2)}) {
      triangles.push_back(part);
      leaves.push_back(mesh.leaf_of_triangle[i]);
    }
  }
  mesh.leaf_triangles = triangles;
  mesh.leaf_of_triangle = leaves;
  mesh.patches.clear();  // the field has no use for places in images
  mesh.patch_of_triangle.clear();
}

struct Band {
  float albedo, share;  // of what is scattered, reflected
  LeafOptics leaf() const { return {.reflectance = share * albedo, .transmittance = (1.f - share) * albedo}; }
  std::string name() const { return fmt::format("{:.2f} {}", albedo, share == 0.5f ? "1:1" : "7:3"); }
};

// A tree in the light of a sun, with what Monte Carlo finds.
struct Case {
  std::string name;
  std::shared_ptr<const TreeMesh> mesh;
  Stand stand;
  float zenith = 0.f;  // [degree]
  Direction sun;
  std::vector<Band> bands;
  std::vector<ForwardResult> truth;  // of each band
  std::vector<Category> groups;
};

// What a method finds in a band.
struct Answer {
  std::vector<float> irradiance;  // of each leaf, both sides [1]
  std::vector<float> direct;      // the same of direct light
  int iterations = 0;
  double error_bound = 0., rest = 0.;  // see FieldSolution; light that is lost, of what comes
  double seconds = 0., cpu_seconds = 0.;
};

// Errors in per cent.
struct Row {
  std::string tree, method;
  bool periodic = false;
  float zenith = 0.f;
  Band band{};
  std::uint64_t paths = 0;
  double weighted = 0., weighted_noise = 0., by_category = 0., leaf = 0., leaf_noise = 0., bias = 0., direct = 0.;
  int iterations = 0;
  double error_bound = 0., rest = 0., milliseconds = 0., cpu_milliseconds = 0.;
};

Row judge(const Case& of, std::size_t band, const std::string& method, const Answer& answer) {
  const ForwardResult& truth = of.truth[band];
  const LeafErrors errors = leafErrors(answer.irradiance, truth, of.groups);
  double direct_squares = 0., direct_truth = 0.;
  for (std::size_t i = 0; i < answer.direct.size(); ++i) {
    const Estimate& direct = truth.leaf_direct[i];
    direct_squares += std::pow(double{answer.direct[i]} - direct.value, 2) - std::pow(direct.standard_error, 2);
    direct_truth += direct.value * direct.value;
  }
  const auto without = [](double all, double part) { return std::sqrt(std::max(0., all * all - part * part)); };
  return {.tree = of.name,
          .method = method,
          .periodic = of.stand.period.has_value(),
          .zenith = of.zenith,
          .band = of.bands[band],
          .paths = truth.paths,
          .weighted = errors.weighted,
          .weighted_noise = errors.weighted_noise,
          .by_category = errors.by_category,
          .leaf = without(errors.leaf, errors.leaf_noise),
          .leaf_noise = errors.leaf_noise,
          .bias = errors.bias,
          .direct = 100. * std::sqrt(std::max(0., direct_squares / direct_truth)),
          .iterations = answer.iterations,
          .error_bound = answer.error_bound,
          .rest = answer.rest,
          .milliseconds = 1e3 * answer.seconds,
          .cpu_milliseconds = 1e3 * answer.cpu_seconds};
}

void print(const Row& row) {
  fmt::print(
      "{:<28.28} {} {:2.0f} {} {:<11} w {:5.2f} (noise {:4.2f}) uw {:5.2f} leaf {:5.2f} (noise {:4.2f}) bias {:+5.2f} "
      "direct "
      "{:5.2f} | {:2} iterations bound {:.1e} rest {:+.1e} {:6.1f} ms cpu {:6.1f}\n",
      row.tree, row.periodic ? "periodic" : "single  ", row.zenith, row.band.name(), row.method, row.weighted,
      row.weighted_noise, row.by_category, row.leaf, row.leaf_noise, row.bias, row.direct, row.iterations,
      row.error_bound, row.rest, row.milliseconds, row.cpu_milliseconds);
  std::fflush(stdout);
}

std::string csvOf(const std::vector<Row>& rows) {
  std::string text =
      "tree,stand,sun_deg,albedo,reflected_share,method,paths,weighted_percent,weighted_noise_percent,category_percent,"
      "leaf_percent,leaf_noise_percent,bias_percent,direct_percent,iterations,error_bound,rest,ms,cpu_ms\n";
  for (const Row& row : rows)
    text += fmt::format(
        "{},{},{:g},{:g},{:g},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{},{:.3g},{:.3g},"
        "{:.2f},{:.2f}\n",
        csvField(row.tree), row.periodic ? "periodic" : "single", row.zenith, row.band.albedo, row.band.share,
        row.method, row.paths, row.weighted, row.weighted_noise, row.by_category, row.leaf, row.leaf_noise, row.bias,
        row.direct, row.iterations, row.error_bound, row.rest, row.milliseconds, row.cpu_milliseconds);
  return text;
}

// The median, of an even number the mean of the middle two, and the value farthest from 0.
std::string medianAndWorst(std::vector<double> values) {
  const auto farther = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const double worst = *std::max_element(values.begin(), values.end(), farther);
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return fmt::format("{:.2f} / {:.2f}", 0.5 * (values[(n - 1) / 2] + values[n / 2]), worst);
}

// Of each method, by albedo and in all.
void summarize(const std::vector<Row>& rows) {
  std::map<std::pair<std::string, std::string>, std::vector<const Row*>> groups;
  for (const Row& row : rows) {
    groups[{row.method, fmt::format("albedo {:g}", row.band.albedo)}].push_back(&row);
    groups[{row.method, "all"}].push_back(&row);
  }
  fmt::print("median / worst\n");
  for (const auto& [key, members] : groups) {
    const auto column = [&](const auto& value) {
      std::vector<double> values;
      for (const Row* row : members) values.push_back(static_cast<double>(value(*row)));
      return medianAndWorst(std::move(values));
    };
    fmt::print("{:<12} {:<12} {:3} cases  w {} uw {} leaf {} bias {} direct {} | iterations {} ms {} cpu {}\n",
               key.first, key.second, members.size(), column([](const Row& r) { return r.weighted; }),
               column([](const Row& r) { return r.by_category; }), column([](const Row& r) { return r.leaf; }),
               column([](const Row& r) { return r.bias; }), column([](const Row& r) { return r.direct; }),
               column([](const Row& r) { return r.iterations; }), column([](const Row& r) { return r.milliseconds; }),
               column([](const Row& r) { return r.cpu_milliseconds; }));
  }
}

Case caseOf(const std::string& name, const Options& options, bool periodic, float zenith) {
  TreeMesh mesh = measuredTree(name, 1);
  if (!options.wood) mesh.wood_triangles.clear();
  Case of{.name = name.substr(name.rfind('/') + 1), .zenith = zenith};
  if (periodic) {
    const glm::vec3 size = leafBounds(mesh).size();
    of.stand.period = glm::vec2(size.x, size.y);
  }
  of.sun = sunlight(zenith * std::numbers::pi_v<float> / 180.f, kAzimuth);
  std::vector<TraceLight> lights;
  for (const float albedo : options.albedos)
    for (const float share : {0.5f, 0.7f}) {
      of.bands.push_back({albedo, share});
      lights.push_back({.sun = of.sun, .leaf = of.bands.back().leaf()});
    }
  const Elapsed traced;
  of.truth = keptTrace(mesh, of.stand, lights, options.paths, options.keep);
  fmt::print("{} {} {:.0f}: Monte Carlo of {} paths at hand after {:.0f} s\n", of.name,
             periodic ? "periodic" : "single", zenith, of.truth[0].paths, traced.seconds());
  of.groups = categories(leafDepths(mesh, DeepOpacityMap(mesh, of.sun, 512), of.stand).front());
  if (options.split) split(mesh);
  of.mesh = std::make_shared<const TreeMesh>(std::move(mesh));
  return of;
}

std::vector<Row> judgeLines(const Case& of, const FieldEffort& effort) {
  LeafField field(effort);
  field.setStand(std::array{of.mesh}, of.stand);
  std::vector<Row> rows;
  for (std::size_t band = 0; band < of.bands.size(); ++band) {
    FieldLighting lighting{.suns = {FieldSun{.along = of.sun}}, .kinds = {FieldKind{}}};
    lighting.kinds[0].leaf.fill(of.bands[band].leaf());
    const Elapsed elapsed;
    const FieldResult& result = field.solve(lighting);
    Answer answer{.iterations = result.iterations,
                  .error_bound = result.error_bound,
                  .seconds = elapsed.seconds(),
                  .cpu_seconds = elapsed.cpuSeconds()};
    for (const LeafLight& leaf : result.trees.front()) {
      answer.direct.push_back(leaf.direct[0].front + leaf.direct[0].back);
      answer.irradiance.push_back(answer.direct.back() + leaf.scattered[0].front + leaf.scattered[0].back);
    }
    const FieldBalance& balance = result.balance[0];
    answer.rest = (balance.in - balance.absorbed_leaves - balance.absorbed_wood - balance.absorbed_ground -
                   balance.out_up - balance.out_down) /
                  balance.in;
    print(rows.emplace_back(judge(of, band, "lines", answer)));
  }
  for (const ProductCost& cost : field.costs())
    fmt::print("    {} {} times {:.1f} ms;", cost.name, cost.made,
               1e3 * cost.seconds / std::max<double>(1., static_cast<double>(cost.made)));
  fmt::print(" {} leaves, {} elements, {} of leaves\n", of.mesh->leaf_count, field.elements().size(),
             field.elements().leaf_elements);
  return rows;
}

// Both sides' irradiance of each leaf.
std::vector<float> ofLeaves(const Case& of, const FieldElements& elements, const std::vector<float>& sides) {
  std::vector<float> sums(elements.size());
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = sides[2 * i] + sides[2 * i + 1];
  return leafMeans(elements, of.mesh->leaf_count, sums);
}

std::vector<Row> judgeCells(const Case& of, const FieldEffort& effort, int cells) {
  const Elapsed making;
  const FieldElements elements = fieldElements(*of.mesh, effort.elements);
  const PlacedElements tree{.mesh = of.mesh.get(), .elements = &elements};
  const CellMedium alone = cellMedium({&tree, 1}, {.cells = cells});
  const float omega = clumping(*of.mesh, alone);
  GridField field(of.stand.period ? cellMedium({&tree, 1}, {.cells = cells}, of.stand.period) : alone,
                  std::array{omega});
  const double made = making.seconds();
  const DirectLight direct = directLight(*of.mesh, elements, of.stand.period, of.sun, effort.direct);
  constexpr std::array kDark{0.f};
  std::vector<Row> rows;
  for (std::size_t band = 0; band < of.bands.size(); ++band) {
    const Elapsed elapsed;
    const GridSolution solution = field.solve({.optics = {{{.leaf = of.bands[band].leaf()}}},
                                               .direct = direct.irradiance,
                                               .entering = field.evenSky(kDark, kDark, {})});
    if (!solution.told.empty()) fmt::print("    {}\n", solution.told);
    print(rows.emplace_back(judge(of, band, fmt::format("cells {}", cells),
                                  {.irradiance = ofLeaves(of, elements, solution.irradiance),
                                   .direct = ofLeaves(of, elements, direct.irradiance),
                                   .iterations = solution.iterations,
                                   .error_bound = solution.error_bound,
                                   .rest = solution.balance[0].residual(),
                                   .seconds = elapsed.seconds(),
                                   .cpu_seconds = elapsed.cpuSeconds()})));
  }
  fmt::print("    {} leaves, {} elements, {} occupied cells, Omega {:.2f}, made in {:.1f} ms\n", of.mesh->leaf_count,
             elements.size(), field.medium().grid.cells.size(), omega, 1e3 * made);
  return rows;
}

std::vector<Row> judgeOthers(const Case& of, const FieldEffort& effort) {
  Scene scene;
  scene.kinds[0].mesh = of.mesh;
  scene.stand = of.stand;
  scene.suns = {Sun{.zenith = of.zenith * std::numbers::pi_v<float> / 180.f, .azimuth = kAzimuth}};
  StandGeometry stand;
  stand.update(scene, needsOf(Model::sppg));
  const LeafGeometry geometry = leafGeometry(scene, stand);
  const FieldElements elements = fieldElements(*of.mesh, effort.elements);
  const std::vector<float> direct =
      ofLeaves(of, elements, directLight(*of.mesh, elements, of.stand.period, of.sun, effort.direct).irradiance);
  const DampedLine line(*of.mesh, of.stand, of.sun, geometry.depths.front(), geometry.compensation.front(), direct);
  struct Known {
    const char* name;
    Model model;
    std::vector<float> direct;
  };
  std::vector<Known> models{{"SS", Model::ss, {}}, {"SPP", Model::spp, {}}, {"SPPG", Model::sppg, {}}};
  // Leaves that scatter nothing have direct light alone.
  for (Known& known : models) known.direct = leafIrradiance(known.model, geometry, std::array{LeafOptics{0.f, 0.f}});
  std::vector<Row> rows;
  for (std::size_t band = 0; band < of.bands.size(); ++band) {
    const std::array optics{of.bands[band].leaf()};
    for (const Known& known : models) {
      const Elapsed elapsed;
      std::vector<float> found = leafIrradiance(known.model, geometry, optics);
      print(rows.emplace_back(judge(of, band, known.name,
                                    {.irradiance = std::move(found),
                                     .direct = known.direct,
                                     .seconds = elapsed.seconds(),
                                     .cpu_seconds = elapsed.cpuSeconds()})));
    }
    const Elapsed elapsed;
    std::vector<float> found = line.irradiance(optics.front());
    print(rows.emplace_back(judge(of, band, "damped line",
                                  {.irradiance = std::move(found),
                                   .direct = direct,
                                   .seconds = elapsed.seconds(),
                                   .cpu_seconds = elapsed.cpuSeconds()})));
  }
  return rows;
}

void measure(const Options& options) {
  if (!options.csv.empty()) requireWritable(options.csv);
  std::vector<Row> rows;
  for (const std::string& tree : options.trees)
    for (const bool periodic : {false, true}) {
      if (periodic ? !options.periodic : !options.single) continue;
      for (const float sun : options.suns) {
        const Case of = caseOf(tree, options, periodic, sun);
        const std::vector<Row> more = options.others  ? judgeOthers(of, options.effort)
                                      : options.cells ? judgeCells(of, options.effort, *options.cells)
                                                      : judgeLines(of, options.effort);
        rows.insert(rows.end(), more.begin(), more.end());
        if (!options.csv.empty()) writeWhole(options.csv, csvOf(rows));
      }
    }
  if (!rows.empty()) summarize(rows);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return measurement(
      "measure_field", argc, argv, [&](CLI::App& app) { addOptions(app, options); }, [&] { measure(options); });
}
