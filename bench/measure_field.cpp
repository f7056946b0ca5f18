// The field against Monte Carlo: errors by category, per leaf and in all, and times.
//   measure_field TREE... [--paths N] [--axes N] [--crossings X] [--suns 0,45,70] [--single] [--periodic]
// A tree is a species, a file, or "layer" and "crown" of random leaves.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <string>

#include "core/elapsed.hpp"
#include "core/require.hpp"
#include "field/leaf_field.hpp"
#include "grid/leaf_depth.hpp"
#include "plants/import.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "render/compare/category_errors.hpp"
#include "render/reference/forward_trace.hpp"

using namespace sunfleck;

namespace {

struct Options {
  std::vector<std::string> trees;
  std::vector<float> suns{0.f, 45.f, 70.f};
  std::vector<float> albedos{0.5f, 0.95f, 0.99f};
  std::uint64_t paths = 4'000'000;
  bool single = true, periodic = true, wood = true, split = false;
  FieldEffort effort;
};

TreeMesh treeOf(const std::string& name) {
  if (name == "crown") return randomCrown({}, 1);
  if (name.find('.') != std::string::npos) return importTree(name).mesh;
  return grow(species(name), 1);
}

std::vector<float> numbers(const char* text) {
  std::vector<float> values;
  for (char* end = const_cast<char*>(text); *end;) {
    values.push_back(std::strtof(end, &end));
    if (*end == ',') ++end;
  }
  return values;
}

Options optionsOf(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto next = [&] { return i + 1 < argc ? argv[++i] : ""; };
    if (word == "--paths")
      options.paths = std::strtoull(next(), nullptr, 10);
    else if (word == "--axes")
      options.effort.exchange.axes = std::atoi(next());
    else if (word == "--crossings")
      options.effort.exchange.crossings = std::strtof(next(), nullptr);
    else if (word == "--pixels")
      options.effort.direct.pixels = std::strtof(next(), nullptr);
    else if (word == "--extent")
      options.effort.elements.largest_extent = std::strtof(next(), nullptr);
    else if (word == "--flatness")
      options.effort.elements.least_flatness = std::strtof(next(), nullptr);
    else if (word == "--patch")
      options.effort.elements.wood_patch = std::strtof(next(), nullptr);
    else if (word == "--error")
      options.effort.solver.error = std::strtod(next(), nullptr);
    else if (word == "--suns")
      options.suns = numbers(next());
    else if (word == "--albedos")
      options.albedos = numbers(next());
    else if (word == "--single")
      options.periodic = false;
    else if (word == "--periodic")
      options.single = false;
    else if (word == "--split")
      options.split = true;
    else if (word == "--no-wood")
      options.wood = false;
    else
      options.trees.push_back(word);
  }
  return options;
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
}

void measure(const std::string& name, const Options& options, bool periodic, float zenith) {
  auto mesh = std::make_shared<TreeMesh>(treeOf(name));
  const TreeMesh whole = *mesh;
  if (options.split) split(*mesh);
  if (!options.wood) mesh->wood_triangles.clear();
  Stand stand;
  if (periodic) {
    const glm::vec3 size = leafBounds(*mesh).size();
    stand.period = glm::vec2(size.x, size.y);
  }
  const Direction sun = sunlight(zenith * std::numbers::pi_v<float> / 180.f, 0.5f);
  std::vector<LeafOptics> bands;
  std::vector<std::string> names;
  for (const float albedo : options.albedos)
    for (const float share : {0.5f, 0.7f}) {
      bands.push_back({.reflectance = share * albedo, .transmittance = (1.f - share) * albedo});
      names.push_back(fmt::format("{:.2f} {}", albedo, share == 0.5f ? "1:1" : "7:3"));
    }
  const RayScene rays(*mesh, stand, true);
  std::vector<TraceLight> lights;
  for (const LeafOptics& leaf : bands) lights.push_back({.sun = sun, .leaf = leaf});
  const Elapsed traced;
  const std::vector<ForwardResult> truth = traceForwardBands(rays, lights, {.paths = options.paths});
  const double trace_seconds = traced.cpuSeconds();
  const std::vector<Category> groups = categories(leafDepths(*mesh, DeepOpacityMap(*mesh, sun, 512), stand).front());

  LeafField field(options.effort);
  const std::array kinds{std::shared_ptr<const TreeMesh>(mesh)};
  field.setStand(kinds, stand);
  for (std::size_t band = 0; band < bands.size(); ++band) {
    FieldLighting lighting{.suns = {FieldSun{.along = sun}}, .kinds = {FieldKind{}}};
    lighting.kinds[0].leaf.fill(bands[band]);
    const Elapsed elapsed;
    const FieldResult& result = field.solve(lighting);
    const double seconds = elapsed.seconds(), cpu = elapsed.cpuSeconds();
    std::vector<float> model;
    for (const LeafLight& leaf : result.trees.front())
      model.push_back(leaf.direct[0].front + leaf.direct[0].back + leaf.scattered[0].front + leaf.scattered[0].back);
    const ModelErrors errors = modelErrors(model, truth[band].leaf_irradiance, groups);
    const double noise = *referenceNoise(truth[band].leaf_irradiance, truth[band].leaf_standard_error);
    const double leaf = std::sqrt(std::max(0., *errors.rms_leaf * *errors.rms_leaf - noise * noise));
    double direct_squares = 0., direct_truth = 0.;
    for (std::size_t i = 0; i < model.size(); ++i) {
      const LeafLight& of_leaf = result.trees.front()[i];
      const double difference =
          double{of_leaf.direct[0].front + of_leaf.direct[0].back} - truth[band].leaf_direct[i].value;
      direct_squares += difference * difference -
                        truth[band].leaf_direct[i].standard_error * truth[band].leaf_direct[i].standard_error;
      direct_truth += truth[band].leaf_direct[i].value * truth[band].leaf_direct[i].value;
    }
    const FieldBalance& balance = result.balance[0];
    fmt::print(
        "{:<28.28} {} {:2.0f} {}  w {:5.2f} uw {:5.2f} leaf {:5.2f} (noise {:4.2f}) bias {:+5.2f} direct {:5.2f} | "
        "{:2} iterations bound "
        "{:.1e} rest {:.1e} {:6.1f} ms cpu {:6.1f}\n",
        name.substr(name.rfind('/') + 1), periodic ? "periodic" : "single  ", zenith, names[band],
        100. * *errors.rms_weighted, 100. * *errors.rms_category, 100. * leaf, 100. * noise, 100. * *errors.bias,
        100. * std::sqrt(std::max(0., direct_squares / direct_truth)), result.iterations, result.error_bound,
        (balance.in - balance.absorbed_leaves - balance.absorbed_wood - balance.absorbed_ground - balance.out_up -
         balance.out_down) /
            balance.in,
        1e3 * seconds, 1e3 * cpu);
  }
  for (const ProductCost& cost : field.costs())
    fmt::print("    {} {} times {:.1f} ms;", cost.name, cost.made,
               1e3 * cost.seconds / std::max<double>(1., static_cast<double>(cost.made)));
  fmt::print(" {} leaves, {} elements, {} of leaves; Monte Carlo {:.0f} s\n", mesh->leaf_count, field.elements().size(),
             field.elements().leaf_elements, trace_seconds);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = optionsOf(argc, argv);
  try {
    for (const std::string& tree : options.trees)
      for (const bool periodic : {false, true}) {
        if (periodic ? !options.periodic : !options.single) continue;
        for (const float sun : options.suns) measure(tree, options, periodic, sun);
      }
  } catch (const InvalidInput& mistake) {
    fmt::print(stderr, "measure_field: {}\n", mistake.what());
    return 2;
  }
}
