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

#include "render/reference/camera_trace.hpp"
#include "render/reference/forward_trace.hpp"
#include "tests/leaf_shapes.hpp"

// The tracers against other people's. Those reference scenes lie beside the repository; without them, leaves of the
// same kind are generated, the two independent estimators of this one are compared, and that has to do.
using namespace sunfleck;
using namespace sunfleck::shapes;
namespace fs = std::filesystem;

namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.f;
const fs::path kShared = fs::path(SUNFLECK_SOURCE_DIR) / "../shared";

// Independent means agree within three combined standard errors.
testing::AssertionResult agree(const Estimate& found, const Estimate& reference) {
  const double z = (found.value - reference.value) / std::hypot(found.standard_error, reference.standard_error);
  if (std::abs(z) <= 3.) return testing::AssertionSuccess();
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
  TreeMesh mesh;
  std::ifstream in(leaves);
  double radius = 0.;
  for (glm::vec3 centre, normal; in >> radius >> centre.x >> centre.y >> centre.z >> normal.x >> normal.y >> normal.z;)
    addPolygon(mesh, mesh.leaf_triangles, disc(centre, normal, radius));
  finish(mesh, leaves.string());
  ASSERT_EQ(mesh.leaf_count, 59683u);
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
