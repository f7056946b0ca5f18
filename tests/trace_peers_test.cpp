#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <sstream>
#include <string>

#include "render/reference/brf_trace.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/reference/trace_run.hpp"
#include "tests/leaf_shapes.hpp"

// The tracers against other people's. Those reference scenes lie beside the repository; without them, leaves of the
// same kind are generated, the two independent estimators of this one are compared, and that has to do.
using namespace sunfleck;
using namespace sunfleck::shapes;
namespace fs = std::filesystem;

namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.f;
const fs::path kShared = fs::path(SUNFLECK_SOURCE_DIR) / "../shared";

// Independent means agree within so many combined standard errors.
testing::AssertionResult agree(const Estimate& found, const Estimate& reference, double allowed = 3.) {
  const double z = (found.value - reference.value) / std::hypot(found.standard_error, reference.standard_error);
  if (std::abs(z) <= allowed) return testing::AssertionSuccess();
  return testing::AssertionFailure() << found.value << " +- " << found.standard_error << " against " << reference.value
                                     << " +- " << reference.standard_error << ": z = " << z;
}

// Binary little-endian triangles: three floats a vertex; a byte (3) and three ints a face.
TreeMesh readPly(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::size_t vertices = 0, faces = 0;
  for (std::string line; std::getline(in, line) && line != "end_header";) {
    std::istringstream words(line);
    std::string element, kind;
    std::size_t count = 0;
    if (words >> element >> kind >> count && element == "element") (kind == "vertex" ? vertices : faces) = count;
  }
  TreeMesh mesh;
  mesh.vertices.resize(vertices);
  in.read(reinterpret_cast<char*>(mesh.vertices.data()), static_cast<std::streamsize>(vertices * sizeof(glm::vec3)));
  for (std::size_t i = 0; i < faces; ++i) {
    glm::uvec3 face;
    in.get();
    in.read(reinterpret_cast<char*>(&face), sizeof(face));
    mesh.leaf_triangles.push_back(face);
  }
  if (!in) throw std::runtime_error("cannot read " + file.string());
  finish(mesh, file.string());
  return mesh;
}

// The reference pictures' camera: elevation 35 degrees, azimuth 20 degrees, looking at the origin.
PixelRays referenceCamera(float half_width) {
  const Direction sight = sunlight(55.f * kDegree, 20.f * kDegree);
  const glm::vec3 right = glm::normalize(glm::cross(sight, glm::vec3(0, 0, 1)));
  const glm::vec3 up = glm::cross(right, sight);
  return {.corner = half_width * (up - right),
          .right_step = half_width / 256.f * right,
          .down_step = -half_width / 256.f * up,
          .sight = sight,
          .width = 512,
          .height = 512};
}

// A list of discs: radius, centre and normal of each.
TreeMesh readLeaves(const fs::path& file) {
  TreeMesh mesh;
  std::ifstream in(file);
  double radius = 0.;
  for (glm::vec3 centre, normal; in >> radius >> centre.x >> centre.y >> centre.z >> normal.x >> normal.y >> normal.z;)
    addPolygon(mesh, mesh.leaf_triangles, disc(centre, normal, radius));
  finish(mesh, file.string());
  if (mesh.leaf_count != 59683u) throw std::runtime_error("cannot read " + file.string());
  return mesh;
}

// Rows of the table of reflectance factors: views of one band in the principal plane.
struct ReferenceBrf {
  ViewDirection view;
  Estimate whole, leaf_once, ground_once;
};
struct ReferenceBand {
  TraceLight light;
  std::vector<ReferenceBrf> views;
};

// The views -70, -55 .. 65 degrees, every third of the table, by band. Positive ones are on the sun's side, at azimuth
// 0.
std::map<std::string, ReferenceBand> readBrf(const fs::path& file) {
  std::map<std::string, ReferenceBand> bands;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("case")) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    std::string band;
    float sun_zenith = 0.f, view_zenith = 0.f;
    TraceLight light;
    ReferenceBrf row;
    cells >> band >> sun_zenith >> view_zenith >> light.leaf.reflectance >> light.leaf.transmittance >>
        light.ground_albedo;
    for (Estimate* part : {&row.whole, &row.leaf_once, &row.ground_once}) cells >> part->value >> part->standard_error;
    if (!cells) throw std::runtime_error("cannot read " + file.string());
    light.sun = sunlight(sun_zenith * kDegree, 0.f);
    row.view = {.zenith = double{std::abs(view_zenith) * kDegree},
                .azimuth = view_zenith < 0.f ? std::numbers::pi : 0.};
    bands[band].light = light;
    if (static_cast<int>(view_zenith + 70.f) % 15 == 0 && view_zenith >= -70.f) bands[band].views.push_back(row);
  }
  return bands;
}

// By 128 units of 128 paths to each view.
std::vector<BrfResult> reflectanceFactors(const RayScene& scene, const std::vector<TraceLight>& bands,
                                          const std::vector<ViewDirection>& views, std::uint64_t seed) {
  const BrfJob job(scene, bands, views, 128);
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = seed, .wanted = {0, job.unitsOf(16'384)}}, sums);
  return job.results(sums);
}

// Rows of a table with a name and numbers: here scene, mean, standard error.
std::map<std::string, Estimate> readRadiances(const fs::path& file) {
  std::ifstream in(file);
  std::map<std::string, Estimate> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    std::string scene, value, error;
    if (line.starts_with("#") || line.starts_with("scene")) continue;
    std::getline(std::getline(std::getline(cells, scene, ','), value, ','), error);
    rows[scene] = {std::stod(value), std::stod(error)};
  }
  return rows;
}

}  // namespace

// Check the mean radiance of a tree of 18,000 leaf triangles and of sixteen turned copies of it.
TEST(R2_CameraTrace, MatchesOtherTracersOnTheReferenceTree) {
  const fs::path ply = kShared / "trees/ellipsoid18k.ply";
  if (!fs::exists(ply)) {
    // Without it: leaves so far apart that almost no light is scattered twice shine by the law of Lambert, and twice as
    // many of them seen as two copies shine twice as much.
    const TreeMesh mesh = leafBox(20, 7);
    const RayScene one(mesh, Stand{}, true);
    const RayScene two(mesh, {.trees = {{.position = {0, -2, 0}}, {.position = {0, 2, 0}}}}, true);
    const CameraResult a = traceCamera(one, {}, referenceCamera(4.f), 0.f, {.paths = 1 << 20, .seed = 1});
    const CameraResult b = traceCamera(two, {}, referenceCamera(4.f), 0.f, {.paths = 1 << 20, .seed = 2});
    EXPECT_GT(a.mean.value, 0.);
    EXPECT_NEAR(b.mean.value / a.mean.value, 2., 0.02);
    return;
  }
  const TreeMesh mesh = readPly(ply);
  const std::map<std::string, Estimate> reference = readRadiances(kShared / "reference/tree_radiance.csv");
  const TraceEffort effort{.paths = 1 << 20, .seed = 1};

  const RayScene single(mesh, Stand{}, true);
  EXPECT_TRUE(
      agree(traceCamera(single, {}, referenceCamera(1.7f), 0.f, effort).mean, reference.at("ellipsoid18k x 1")));

  Stand forest{.trees = {}};
  std::ifstream grid(kShared / "trees/grid16.txt");
  for (Placement tree; grid >> tree.position.x >> tree.position.y >> tree.rotation;) forest.trees.push_back(tree);
  ASSERT_EQ(forest.trees.size(), 16u);
  const RayScene sixteen(mesh, forest, true);
  EXPECT_TRUE(
      agree(traceCamera(sixteen, {}, referenceCamera(6.5f), 0.f, effort).mean, reference.at("ellipsoid18k x 16")));
}

// Check the energy budget of a periodic canopy of leaf area index 3 over soil, in the near infrared and the red.
TEST(R1_ForwardTrace, MatchesOtherTracersOnTheReferenceCanopy) {
  const Direction sun = sunlight(20.f * kDegree, 0.f);
  const fs::path leaves = kShared / "reference/canopy_leaves.txt";
  if (!fs::exists(leaves)) {
    // Without it: a canopy of the same kind, whose direct light falls by Beer's law for spherical leaf angles. Leaves
    // of finite size at random places do so on average over crowns; one crown of 6 x 6 m is within 5 % of it.
    Random random(1, 0);
    TreeMesh mesh;
    for (int i = 0; i < 3438; ++i) {
      const glm::vec3 centre(6.f * random.uniform(), 6.f * random.uniform(), 0.1f + 0.8f * random.uniform());
      addPolygon(mesh, mesh.leaf_triangles, disc(centre, onSphere(random), 0.1));
    }
    finish(mesh, "canopy");
    const RayScene scene(mesh, {.period = glm::vec2(6.f)}, true);
    const ForwardResult result = traceForward(scene, {.sun = sun}, {.paths = 20'000});
    EXPECT_NEAR(result.arriving_ground_direct.value, std::exp(-0.5 * 3. / std::cos(20. * std::numbers::pi / 180.)),
                0.05);
    return;
  }
  const TreeMesh mesh = readLeaves(leaves);
  // The canopy stands between 0 and 1 m; its soil is at 0, which is where the lowest leaf ends within a millimetre.
  const RayScene scene(mesh, {.period = glm::vec2(25.f)}, true);

  std::ifstream table(kShared / "reference/canopy_flux.csv");
  std::map<std::string, std::map<std::string, Estimate>> bands;  // by soil albedo, then by quantity
  std::map<std::string, TraceLight> lights;
  for (std::string line; std::getline(table, line);) {
    if (!line.starts_with("discrete")) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    std::string canopy, soil, quantity;
    double index = 0., zenith = 0.;
    TraceLight light{.sun = sun};
    Estimate value;
    cells >> canopy >> index >> light.leaf.reflectance >> light.leaf.transmittance >> soil >> zenith >> quantity >>
        value.value >> value.standard_error;
    ASSERT_TRUE(cells && zenith == 20.) << line;
    light.ground_albedo = std::stof(soil);
    lights[soil] = light;
    bands[soil][quantity] = value;
  }
  ASSERT_EQ(bands.size(), 2u);
  for (const auto& [soil, reference] : bands) {
    const ForwardResult result = traceForward(scene, lights[soil], {.paths = 160'000});
    EXPECT_TRUE(agree(result.reflected, reference.at("reflected"))) << soil;
    EXPECT_TRUE(agree(result.absorbed_leaves, reference.at("absorbed_by_leaves"))) << soil;
    EXPECT_TRUE(agree(result.arriving_ground, reference.at("arriving_at_soil"))) << soil;
    EXPECT_TRUE(agree(result.arriving_ground_direct, reference.at("arriving_at_soil_direct"))) << soil;
  }
}

// Check the reflectance factors of that canopy in the principal plane at every third angle, the hot spot among them,
// and on both bands' common paths: whole, and scattered once by leaves or by soil. 60 comparisons within 5.1 standard
// errors; these, mostly ours, come from 128 units: by Student's distribution one of all is beyond by chance in 7e-5 of
// such runs.
TEST(R12_BrfTrace, MatchesOtherTracersOnTheReferenceCanopy) {
  const fs::path leaves = kShared / "reference/canopy_leaves.txt";
  if (!fs::exists(leaves)) {
    // Without it: light that goes from one direction into another goes the other way as easily (Helmholtz).
    const TreeMesh mesh = leafBox(150, 2);
    const RayScene scene(mesh, {.period = glm::vec2(2.f, 1.f)}, true);
    const ViewDirection a{.zenith = 0.35, .azimuth = 0.2}, b{.zenith = 1., .azimuth = 2.5};
    const auto seen = [&](const ViewDirection& sun, const ViewDirection& view, std::uint64_t seed) {
      const Direction from = sunlight(static_cast<float>(sun.zenith), static_cast<float>(sun.azimuth));
      return reflectanceFactors(scene, {{.sun = from, .ground_albedo = 0.3f}}, {view}, seed)
          .front()
          .views.front()
          .whole;
    };
    EXPECT_TRUE(agree(seen(a, b, 1), seen(b, a, 2), 5.1));
    return;
  }
  const TreeMesh mesh = readLeaves(leaves);
  const RayScene scene(mesh, {.period = glm::vec2(25.f)}, true);
  const auto bands = readBrf(kShared / "reference/canopy_brf.csv");
  ASSERT_EQ(bands.size(), 2u);
  std::vector<TraceLight> lights;
  for (const auto& [name, band] : bands) lights.push_back(band.light);
  std::vector<ViewDirection> views;
  for (const ReferenceBrf& row : bands.begin()->second.views) views.push_back(row.view);
  ASSERT_EQ(views.size(), 10u);
  const std::vector<BrfResult> results = reflectanceFactors(scene, lights, views, 1);
  auto result = results.begin();
  for (const auto& [name, band] : bands) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      const ReferenceBrf& expected = band.views[i];
      const ReflectanceParts& found = result->views[i];
      EXPECT_TRUE(agree(found.whole, expected.whole, 5.1)) << name << " view " << i;
      EXPECT_TRUE(agree(found.leaf_once, expected.leaf_once, 5.1)) << name << " view " << i;
      EXPECT_TRUE(agree(found.ground_once, expected.ground_once, 5.1)) << name << " view " << i;
      EXPECT_LT(found.whole.standard_error, 0.015 * found.whole.value);  // what the comparison is worth
    }
    ++result;
  }
}
