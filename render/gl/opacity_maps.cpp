#include "render/gl/opacity_maps.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "render/gl/too_large.hpp"

namespace sunfleck::gl {
namespace {

constexpr std::uint32_t kWood = ~0u;            // the leaf of a wood triangle
constexpr std::uint32_t kNoWood = 0xff800000u;  // infinity, as the shaders order depths
constexpr std::size_t kGroup = 64;              // invocations, as the shaders say
constexpr std::size_t kRun = 64;                // pixels whose counts one invocation adds up
constexpr std::size_t kMostSteps = 32'768;      // of all loops of an invocation; Mesa's llvmpipe ends them after 65,535
constexpr std::uint32_t kMostOnLine = 1024;     // crossings, which the shader sorts within so many steps
constexpr std::size_t kBusy = 65'536;           // invocations
constexpr std::size_t kMostGroups = 65535;      // along one axis, in any OpenGL
enum Binding : unsigned { kPositions, kTriangles, kFirst, kCrossings, kWoodDepth, kRuns, kLines = kRuns };

// What the shaders read: the C++ side of opacity_scan.glsl.
struct MapData {
  glm::dvec2 corner;
  double pixels_per_metre;
  double unused = 0.;
  glm::vec4 right, up, along;
  glm::uvec4 size;
};
static_assert(sizeof(MapData) == 32 + 4 * 16);

void requireRoom(double bytes, const std::string& what) {
  if (bytes <= static_cast<double>(Buffer::largestStorage())) return;
  std::ostringstream why;
  why.precision(4);
  why << what << " takes " << 1e-6 * bytes << " MB in one piece: must be at most "
      << 1e-6 * static_cast<double>(Buffer::largestStorage()) << " MB for this OpenGL";
  throw TooLarge(TooLarge::What::light_map, why.str());
}

std::vector<glm::uvec4> trianglesOf(const TreeMesh& mesh) {
  std::vector<glm::uvec4> triangles;
  triangles.reserve(mesh.leaf_triangles.size() + mesh.wood_triangles.size());
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i)
    triangles.emplace_back(mesh.leaf_triangles[i], mesh.leaf_of_triangle[i]);
  for (const glm::uvec3& triangle : mesh.wood_triangles) triangles.emplace_back(triangle, kWood);
  return triangles;
}

float longestEdge(const TreeMesh& mesh) {
  float longest = 0.f;
  for (const auto* triangles : {&mesh.leaf_triangles, &mesh.wood_triangles})
    for (const glm::uvec3& t : *triangles)
      for (int i = 0; i < 3; ++i)
        longest = std::max(longest, glm::distance(mesh.vertices[t[i]], mesh.vertices[t[(i + 1) % 3]]));
  return longest;
}

// Runs the program in use so often, for each `slices` times, and lets what follows see what it wrote.
void dispatch(std::size_t invocations, std::size_t slices = 1) {
  const std::size_t groups = (invocations + kGroup - 1) / kGroup, side = std::min(groups, kMostGroups);
  if (groups == 0) return;
  glDispatchCompute(static_cast<GLuint>(side), static_cast<GLuint>((groups + side - 1) / side),
                    static_cast<GLuint>(slices));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

// Among how many a triangle is shared out: so that none has more than kMostSteps to do, and few triangles keep a large
// graphics card busy.
std::size_t slicesOf(std::size_t triangles, float longest_edge, const OpacityMapFrame& frame) {
  const auto longest = static_cast<std::size_t>(std::min(longest_edge / frame.pixel_size, 1e6f)) + 2;  // [pixel]
  const std::size_t columns = std::min(longest, static_cast<std::size_t>(frame.size.x));
  const std::size_t rows = std::min(longest, static_cast<std::size_t>(frame.size.y));
  return std::max((rows * (columns + 1)) / kMostSteps + 1, std::min(rows, kBusy / std::max<std::size_t>(triangles, 1)));
}

}  // namespace

MappedTree::MappedTree(const TreeMesh& mesh)
    : mesh_(&mesh), longest_edge_(longestEdge(mesh)), positions_(mesh.vertices), triangles_(trianglesOf(mesh)) {}

OpacityMapMaker::OpacityMapMaker(const Context& context)
    : context_(&context),
      count_({shaderOf(Stage::compute, "render/gl/opacity_count.comp")}),
      sum_({shaderOf(Stage::compute, "render/gl/opacity_sum.comp")}),
      fill_({shaderOf(Stage::compute, "render/gl/opacity_fill.comp")}),
      sort_({shaderOf(Stage::compute, "render/gl/opacity_sort.comp")}) {}

OpacityMap OpacityMapMaker::make(const MappedTree& tree, Direction along, int resolution) const {
  const OpacityMapFrame frame = opacityMapFrame(*tree.mesh_, along, resolution);
  const std::size_t pixels = static_cast<std::size_t>(frame.size.x) * static_cast<std::size_t>(frame.size.y);
  const std::size_t leaf_triangles = tree.mesh_->leaf_triangles.size();
  const std::size_t wood_triangles = tree.mesh_->wood_triangles.size();
  for (const Buffer* buffer : {&tree.positions_, &tree.triangles_})
    requireRoom(static_cast<double>(buffer->bytes()), "the tree");
  requireRoom(12. * static_cast<double>(pixels + 1), "the light's opacity map");
  const MapData data{.corner = frame.corner,
                     .pixels_per_metre = 1. / double{frame.pixel_size},
                     .right = glm::vec4(frame.axes.right, 0.f),
                     .up = glm::vec4(frame.axes.up, 0.f),
                     .along = glm::vec4(frame.axes.along, 0.f),
                     .size = {frame.size, leaf_triangles, wood_triangles}};
  const Buffer uniforms(std::span<const MapData>(&data, 1));
  uniforms.bindUniform(0);
  tree.positions_.bindStorage(kPositions);
  tree.triangles_.bindStorage(kTriangles);
  const Buffer first = Buffer::filled(pixels + 1, 0u);
  first.bindStorage(kFirst);
  count_.use();
  dispatch(leaf_triangles, slicesOf(leaf_triangles, tree.longest_edge_, frame));

  const std::size_t run_count = (pixels + kRun - 1) / kRun;
  const auto sum = [&](const Buffer& sums, bool known) {
    sums.bindStorage(kRuns);
    sum_.use();
    glUniform1ui(0, static_cast<GLuint>(pixels));
    glUniform1i(1, known);
    dispatch(run_count);
  };
  const Buffer found = Buffer::filled(1 + run_count, 0u);
  sum(found, false);
  std::vector<std::uint32_t> runs = found.read<std::uint32_t>();
  if (runs.front() > kMostOnLine)
    throw TooLarge(TooLarge::What::light_map, "a line of the light's opacity map crosses " +
                                                  std::to_string(runs.front()) + " leaves: must be at most " +
                                                  std::to_string(kMostOnLine) + " for OpenGL");
  std::uint64_t crossings_found = 0;
  for (std::uint32_t& run : std::span(runs).subspan(1)) {
    const std::uint32_t of_run = run;
    run = static_cast<std::uint32_t>(crossings_found);
    crossings_found += of_run;
  }
  requireRoom(static_cast<double>(sizeof(Crossing)) * static_cast<double>(crossings_found), "the light's opacity map");
  sum(Buffer(runs), true);

  Buffer crossings = Buffer::filled(2 * crossings_found, 0u);
  const Buffer wood_depth = Buffer::filled(pixels, kNoWood);
  crossings.bindStorage(kCrossings);
  wood_depth.bindStorage(kWoodDepth);
  fill_.use();
  const std::size_t triangles = leaf_triangles + wood_triangles;
  dispatch(triangles, slicesOf(triangles, tree.longest_edge_, frame));
  Buffer lines = Buffer::filled(3 * pixels, 0u);
  lines.bindStorage(kLines);
  sort_.use();
  glUniform1ui(0, static_cast<GLuint>(pixels));
  dispatch(pixels);
  context_->requireNoError("making an opacity map");
  return {.frame = frame, .lines = std::move(lines), .crossings = std::move(crossings)};
}

DeepOpacityMap OpacityMap::read() const {
  const auto of_pixels = lines.read<glm::uvec3>();
  const std::size_t pixels = of_pixels.size(), count = crossings.bytes() / sizeof(Crossing);
  DeepOpacityMap::Arrays arrays{.first = std::make_unique_for_overwrite<std::uint32_t[]>(pixels + 1),
                                .crossings = std::make_unique_for_overwrite<Crossing[]>(count),
                                .wood_depth = std::make_unique_for_overwrite<float[]>(pixels),
                                .last_wood_depth = nullptr};
  for (std::size_t i = 0; i < pixels; ++i) {
    arrays.first[i] = of_pixels[i].x;
    arrays.wood_depth[i] = std::bit_cast<float>(of_pixels[i].z);
  }
  arrays.first[pixels] = static_cast<std::uint32_t>(count);
  crossings.read(std::span(arrays.crossings.get(), count));
  return {frame, std::move(arrays)};
}

}  // namespace sunfleck::gl
