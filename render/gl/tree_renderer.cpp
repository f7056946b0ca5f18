#include "render/gl/tree_renderer.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "grid/neighbours.hpp"
#include "render/gl/buffer.hpp"
#include "render/gl/detail/frame_data.hpp"
#include "render/gl/framebuffer.hpp"
#include "render/gl/program.hpp"
#include "render/gl/shading_buffers.hpp"
#include "render/gl/stand_instances.hpp"
#include "render/gl/volume_texture.hpp"

namespace sunfleck::gl {
namespace {

using namespace detail;

constexpr int kSamples = 2;  // per pixel, along each side
constexpr int kTile = 512;   // [pixel]; larger pictures are drawn in tiles of this size, so that memory is bounded
constexpr float kGroundRadii = 3.f;  // of the crown, from the tree's axis to the rim of the ground

std::vector<VertexData> verticesOf(const TreeMesh& mesh) {
  std::vector<VertexData> vertices;
  vertices.reserve(3 * (mesh.leaf_triangles.size() + mesh.wood_triangles.size()));
  const auto add = [&](const glm::uvec3& triangle, std::uint32_t leaf) {
    const glm::dvec3 a = mesh.vertices[triangle.x];
    const glm::dvec3 b = mesh.vertices[triangle.y];
    const glm::dvec3 c = mesh.vertices[triangle.z];
    const glm::vec3 normal(glm::normalize(glm::cross(b - a, c - a)));
    for (int corner = 0; corner < 3; ++corner)
      vertices.push_back({.position = mesh.vertices[triangle[corner]], .leaf = leaf, .normal = normal});
  };
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) add(mesh.leaf_triangles[i], mesh.leaf_of_triangle[i]);
  for (const glm::uvec3& triangle : mesh.wood_triangles) add(triangle, DeepOpacityMap::kNoLeaf);
  return vertices;
}

// At the lowest point of the stand, three crown radii beyond its middle and as far again as the stand is wide.
GroundDisc groundOf(const Scene& scene) {
  const Bounds stand = bounds(scene);
  const glm::vec3 crown = 0.5f * bounds(*scene.kinds[0].mesh).size(), whole = 0.5f * stand.size();
  const float crown_radius = std::max(crown.x, crown.y);
  return {.centre = {stand.centre().x, stand.centre().y, stand.low.z},
          .radius = std::max(whole.x, whole.y) + (kGroundRadii - 1.f) * crown_radius};
}

bool anyAbove(const glm::vec3& values, float bound) {
  return values.x > bound || values.y > bound || values.z > bound;
}

class VertexArray {
 public:
  explicit VertexArray(const Buffer* vertices) : name_(created()) {
    if (!vertices) return;
    const GLuint name = name_.get();
    glVertexArrayVertexBuffer(name, 0, vertices->name(), 0, sizeof(VertexData));
    for (GLuint attribute = 0; attribute < 3; ++attribute) {
      glEnableVertexArrayAttrib(name, attribute);
      glVertexArrayAttribBinding(name, attribute, 0);
    }
    glVertexArrayAttribFormat(name, 0, 3, GL_FLOAT, GL_FALSE, offsetof(VertexData, position));
    glVertexArrayAttribIFormat(name, 1, 1, GL_UNSIGNED_INT, offsetof(VertexData, leaf));
    glVertexArrayAttribFormat(name, 2, 3, GL_FLOAT, GL_FALSE, offsetof(VertexData, normal));
  }
  void bind() const { glBindVertexArray(name_.get()); }

 private:
  static unsigned created() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return name;
  }
  static void destroy(unsigned name) { glDeleteVertexArrays(1, &name); }
  ObjectName<&VertexArray::destroy> name_;
};

std::vector<InstanceData> instanceData(const StandInstances& stand) {
  std::vector<InstanceData> data;
  const auto add = [&](const Instance& i) {
    data.push_back(
        {.position = glm::vec4(i.position, 0.f), .neighbours = {i.first_neighbour, i.neighbours_end, i.tree, 0u}});
  };
  for (const Instance& instance : stand.drawn) add(instance);
  add(stand.ground);
  return data;
}

std::vector<NeighbourData> neighbourData(const StandInstances& stand, const SunMap& map) {
  std::vector<NeighbourData> data;
  for (const Neighbour& n : stand.neighbours)
    data.push_back({.in_map = glm::vec4(map.alongAxes(n.displacement) - map.origin, 0.f),
                    .in_space = glm::vec4(n.displacement, static_cast<float>(n.tree))});
  return data;
}

// The trees' cells as blocks of one texture, side by side along x and then along z.
struct CellBlocks {
  glm::ivec3 size{1};
  int across = 1;
  std::vector<float> values{1.f};
};
CellBlocks cellBlocks(const CompensationCells& cells) {
  if (cells.values.empty()) return {};
  const int trees = static_cast<int>(cells.values.size());
  const int above = std::max(1, std::min(trees, VolumeTexture::longestSide() / cells.size.z));
  const int across = (trees + above - 1) / above;
  CellBlocks blocks{.size = {across * cells.size.x, cells.size.y, ((trees + across - 1) / across) * cells.size.z},
                    .across = across,
                    .values = {}};
  const auto index = [](glm::ivec3 cell, glm::ivec3 size) {
    return (static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(cell.y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(cell.x);
  };
  blocks.values.assign(index({0, 0, blocks.size.z}, blocks.size), 0.f);
  for (int tree = 0; tree < trees; ++tree) {
    const glm::ivec3 corner = glm::ivec3(tree % across, 0, tree / across) * cells.size;
    const std::span<const float> values = cells.values[static_cast<std::size_t>(tree)];
    for (int z = 0; z < cells.size.z; ++z)
      for (int y = 0; y < cells.size.y; ++y)
        std::copy_n(
            values.begin() + static_cast<std::ptrdiff_t>(index({0, y, z}, cells.size)), cells.size.x,
            blocks.values.begin() + static_cast<std::ptrdiff_t>(index(corner + glm::ivec3(0, y, z), blocks.size)));
  }
  return blocks;
}

StandLight lightOf(const Sun& sun) {
  return {.along = sun.light(), .irradiance = sun.irradiance};
}

// What is a model's own.
struct ModelShading {
  ModelShading(Model model, const Scene& scene)
      : buffers(sunfleck::shading::shadingData(model, scene.kinds, std::array{lightOf(scene.sun())})),
        tree_program({shaderOf(Stage::vertex, "render/gl/tree.vert"),
                      shadingShader(Stage::fragment, "render/gl/tree.frag", model)}),
        ground_program({shaderOf(Stage::vertex, "render/gl/ground.vert"),
                        shadingShader(Stage::fragment, "render/gl/ground.frag", model)}) {}
  ShadingBuffers buffers;
  Program tree_program, ground_program;
};

}  // namespace

struct TreeRenderer::Resources {
  Scene scene;
  const Context* context;
  GroundDisc ground;
  bool has_ground;
  Bounds box;  // of all that is drawn
  StandInstances stand;
  FrameData frame;
  int vertex_count;
  Buffer vertices, instances, neighbours, first, crossings, wood_depth;
  VertexArray tree_array, no_array;
  CellBlocks blocks;
  VolumeTexture compensation;
  Program depth_program;

  Resources(const Context& current, const Scene& drawn_scene, const SunMap& sun, const CompensationCells& cells,
            const std::vector<VertexData>& corners)
      : scene(drawn_scene),
        context(&current),
        ground(groundOf(scene)),
        has_ground(anyAbove(scene.ground_albedo, 0.f)),
        stand(standInstances(scene.stand, periodsAround(scene.stand, leafBounds(*scene.kinds[0].mesh)), sun, ground)),
        vertex_count(static_cast<GLsizei>(corners.size())),
        vertices(corners),
        instances(instanceData(stand)),
        neighbours(neighbourData(stand, sun)),
        first(sun.first),
        crossings(sun.crossings),
        wood_depth(sun.wood_depth),
        tree_array(&vertices),
        no_array(nullptr),
        blocks(cellBlocks(cells)),
        compensation(blocks.size, blocks.values),
        depth_program(
            {shaderOf(Stage::vertex, "render/gl/tree.vert"), shaderOf(Stage::fragment, "render/gl/depth.frag")}) {
    const Bounds prototype = bounds(*scene.kinds[0].mesh);
    for (const Instance& instance : stand.drawn) {
      box.include(prototype.low + instance.position);
      box.include(prototype.high + instance.position);
    }
    frame.sun = glm::vec4(sun.axes.along, 0.f);
    frame.map_right = glm::vec4(sun.axes.right, sun.corner.x);
    frame.map_up = glm::vec4(sun.axes.up, sun.corner.y);
    frame.map_size = glm::vec4(glm::vec2(sun.size), sun.pixel_size, 1.f / sun.pixel_size);
    frame.cell_low = glm::vec4(cells.low, cells.cell_size);
    frame.cell_count = glm::vec4(glm::max(glm::vec3(cells.size), glm::vec3(1.f)), static_cast<float>(blocks.across));
    frame.ground_albedo = glm::vec4(scene.ground_albedo, 0.f);
    frame.ground = glm::vec4(ground.centre, ground.radius);
    frame.choice.y = static_cast<std::uint32_t>(stand.drawn.size());
    context->requireNoError("loading the tree");
  }

  void draw(const FrameData& data, const ModelShading& shading, const Framebuffer& target, bool with_ground) const {
    target.begin();
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    const Buffer uniforms(std::span<const FrameData>(&data, 1));
    uniforms.bindUniform(0);
    unsigned binding = 0;
    for (const Buffer* storage : {&instances, &neighbours, &first, &crossings, &wood_depth})
      storage->bindStorage(binding++);
    shading.buffers.bind();
    compensation.bind(0);
    tree_array.bind();
    const auto draw_trees = [&] {
      glDrawArraysInstanced(GL_TRIANGLES, 0, vertex_count, static_cast<GLsizei>(stand.drawn.size()));
    };
    // Shading costs far more than triangles: depth first, so that only what is seen is shaded.
    glDepthFunc(GL_LESS);
    depth_program.use();
    draw_trees();
    glDepthFunc(GL_EQUAL);
    shading.tree_program.use();
    draw_trees();
    glDepthFunc(GL_LESS);
    if (!with_ground) return;
    no_array.bind();
    shading.ground_program.use();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
};

TreeRenderer::TreeRenderer(const Context& context, const Scene& scene, const SunMap& sun,
                           const CompensationCells& cells)
    : resources_(std::make_unique<Resources>(context, scene, sun, cells, verticesOf(*scene.kinds[0].mesh))) {}
TreeRenderer::~TreeRenderer() = default;
TreeRenderer::TreeRenderer(TreeRenderer&&) noexcept = default;
TreeRenderer& TreeRenderer::operator=(TreeRenderer&&) noexcept = default;

namespace {

// Clip coordinates of an orthographic view in which the square of pixels `low` .. `low + size`, counted from the lower
// left of the picture, fills the target. Depth runs over `reach` before and behind the camera's target.
glm::mat4 clipFromWorld(const Camera& camera, glm::ivec2 low, glm::ivec2 size, float reach) {
  const Axes axes = viewAxes(camera);
  const float pixels_per_metre = 0.5f * static_cast<float>(camera.width) / camera.half_width;
  const glm::vec2 scale = 2.f * pixels_per_metre / glm::vec2(size);
  // Pixel coordinates of the camera's target within the square, from -1 to 1.
  const glm::vec2 shift =
      2.f * (0.5f * glm::vec2(camera.width, camera.height) - glm::vec2(low)) / glm::vec2(size) - 1.f;
  const glm::vec3 x = scale.x * axes.right, y = scale.y * axes.up, z = axes.along / reach;
  return glm::transpose(glm::mat4(glm::vec4(x, shift.x - glm::dot(x, camera.target)),
                                  glm::vec4(y, shift.y - glm::dot(y, camera.target)),
                                  glm::vec4(z, -glm::dot(z, camera.target)), glm::vec4(0.f, 0.f, 0.f, 1.f)));
}

// Means of kSamples x kSamples samples, into the pixels of the image from `low` on, counted from its lower left.
//   width  of the tile that the samples fill [pixel]
void addTile(Image& image, const std::vector<float>& samples, int width, glm::ivec2 low) {
  constexpr std::size_t kChannels = 4;
  const std::size_t row_length = static_cast<std::size_t>(kSamples * width) * kChannels;
  const int height = static_cast<int>(samples.size() / row_length) / kSamples;
  for (int y = 0; y < std::min(height, image.height - low.y); ++y)
    for (int x = 0; x < std::min(width, image.width - low.x); ++x)
      for (std::size_t channel = 0; channel < kChannels; ++channel) {
        float sum = 0.f;
        for (int j = 0; j < kSamples; ++j)
          for (int i = 0; i < kSamples; ++i)
            sum += samples[static_cast<std::size_t>(kSamples * y + j) * row_length +
                           static_cast<std::size_t>(kSamples * x + i) * kChannels + channel];
        image.values[image.at(low.x + x, image.height - 1 - (low.y + y), channel)] = sum / (kSamples * kSamples);
      }
}

}  // namespace

Image TreeRenderer::picture(const Camera& camera, Model model, const Progress& progress) const {
  const Resources& r = *resources_;
  const Axes axes = viewAxes(camera);
  FrameData frame = r.frame;
  frame.to_eye = glm::vec4(-axes.along, 0.f);
  frame.choice.x = needsCompensation(model) ? 1u : 0u;
  const ModelShading shading(model, r.scene);
  // Everything lies within this distance of the camera's target.
  float reach = glm::length(r.box.centre() - camera.target) + 0.5f * glm::length(r.box.size());
  reach = std::max(reach, glm::length(r.ground.centre - camera.target) + 1.5f * r.ground.radius);
  const bool with_ground = r.has_ground && axes.along.z < 0.f;  // seen from above alone

  Image image{.width = camera.width, .height = camera.height, .channels = {"R", "G", "B", "A"}, .values = {}};
  image.values.resize(image.at(0, camera.height, 0));
  const glm::ivec2 tile = glm::min(glm::ivec2(kTile), glm::ivec2(camera.width, camera.height));
  const Framebuffer target(kSamples * tile);
  std::vector<float> samples(4 * static_cast<std::size_t>(kSamples * tile.x) *
                             static_cast<std::size_t>(kSamples * tile.y));
  for (int y = 0; y < camera.height; y += tile.y)
    for (int x = 0; x < camera.width; x += tile.x) {
      const float rows_done = static_cast<float>(y) + static_cast<float>(tile.y * x) / static_cast<float>(camera.width);
      if (!goOn(progress, double{rows_done} / camera.height)) throw std::runtime_error("interrupted");
      frame.clip_from_world = clipFromWorld(camera, {x, y}, tile, reach);
      r.draw(frame, shading, target, with_ground);
      target.read(samples);
      r.context->requireNoError("drawing the picture");
      addTile(image, samples, tile.x, {x, y});
    }
  return image;
}

}  // namespace sunfleck::gl
