#include "render/gl/stand_renderer.hpp"

#include <epoxy/gl.h>

#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "render/gl/program.hpp"
#include "render/gl/shading_buffers.hpp"
#include "render/gl/visible_trees.hpp"
#include "render/shading/shading_model.hpp"

namespace sunfleck::gl {
namespace {

using namespace detail;

// Seconds that some work took, the graphics card's included.
template <typename Work>
double secondsOf(bool timed, const Work& work) {
  if (!timed) {
    work();
    return 0.;
  }
  glFinish();
  const auto start = std::chrono::steady_clock::now();
  work();
  glFinish();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void define(Shader& shader, const std::string& name, const std::string& value) {
  shader.text.insert(shader.text.find('\n') + 1, "#define " + name + " " + value + "\n#line 2\n");
}

unsigned createdArray() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return name;
}
void destroyArray(unsigned name) {
  glDeleteVertexArrays(1, &name);
}

std::vector<shading::ShadingLight> shadingLights(std::span<const DrawnLight> lights) {
  std::vector<shading::ShadingLight> result;
  for (const DrawnLight& light : lights)
    result.push_back({.travel = glm::vec4(light.along, 0.f), .irradiance = glm::vec4(light.irradiance, 0.f)});
  return result;
}

}  // namespace

// What is made once for each model.
struct StandRenderer::Programs {
  Program visible{shaderOf(Stage::vertex, "render/gl/visible.vert"),
                  shaderOf(Stage::fragment, "render/gl/visible.frag")};
  ObjectName<destroyArray> no_array{createdArray()};
  // What a shading program is made for.
  struct Purpose {
    Model model;
    bool layers, one_kind, one_light, gloss, maps, sky;
    auto operator<=>(const Purpose&) const = default;
  };
  std::map<Purpose, Program> shading;
  spp::PowerTableOf exact;
  std::map<Model, shading::ShadingData> data;
  std::map<Model, ShadingBuffers> buffers;  // of the stand as it is

  const Program& shadingFor(const Purpose& purpose) {
    auto found = shading.find(purpose);
    if (found == shading.end()) {
      Shader shader = shadingShader(Stage::fragment, "render/gl/shade.frag", purpose.model);
      define(shader, "NEEDS_COMPENSATION", needsCompensation(purpose.model) ? "true" : "false");
      if (purpose.model == Model::field) define(shader, "FIELD", "1");
      if (purpose.layers) define(shader, "LAYERS", "1");
      if (purpose.one_kind) define(shader, "ONE_KIND", "1");
      if (purpose.one_light) define(shader, "LIGHTS", "1u");
      if (!purpose.gloss) define(shader, "GLOSSY", "false");
      if (purpose.maps) define(shader, "MAPS", "1");
      if (!purpose.sky) define(shader, "NO_SKY", "1");
      found = shading.emplace(purpose, Program({shaderOf(Stage::vertex, "render/gl/screen.vert"), shader})).first;
    }
    return found->second;
  }
  const ShadingBuffers& buffersOf(Model model, const StandData& stand) {
    auto found = buffers.find(model);
    if (found == buffers.end()) {
      data[model].leaf_tables = stand.leafTables();
      sunfleck::shading::update(data[model], model, stand.treeKinds(), shadingLights(stand.lights()), exact);
      found = buffers.emplace(model, ShadingBuffers(data[model])).first;
    }
    return found->second;
  }
};

StandRenderer::StandRenderer(const Context& context, const spp::PowerTableOf& exact)
    : context_(&context), frame_(Buffer::writable(sizeof(FrameData))), programs_(std::make_unique<Programs>()) {
  programs_->exact = exact;
}
StandRenderer::~StandRenderer() = default;

Sent StandRenderer::update(const DrawnStand& stand) {
  const Sent sent = data_.update(stand);
  programs_->buffers.clear();
  context_->requireNoError("loading the trees");
  return sent;
}

// Everything that is drawn lies within this distance of the camera's target.
float StandRenderer::reach(const View& view) const {
  float reach = glm::length(data_.ground().centre - view.camera.target) + 1.5f * data_.ground().radius;
  if (!data_.box().empty())
    reach = std::max(reach,
                     glm::length(data_.box().centre() - view.camera.target) + 0.5f * glm::length(data_.box().size()));
  return reach;
}

void StandRenderer::bindFrame(const View& view, const FrameTarget& target) {
  const Camera& camera = view.camera;
  const PixelSteps steps = pixelSteps(camera);
  FrameData frame = data_.frame();
  frame.clip_from_world = clipFromWorld(view, target.size(), reach(view));
  frame.eye = camera.perspective() ? glm::vec4(eyeOf(camera), 1.f) : glm::vec4(camera.target, 0.f);
  frame.sight = glm::vec4(viewAxes(camera).along, 0.f);
  frame.corner = glm::vec4(steps.lower_left, 0.f);
  frame.pixel_right = glm::vec4(steps.right, static_cast<float>(view.low.x) + view.offset.x);
  frame.pixel_up = glm::vec4(steps.up, static_cast<float>(view.low.y) + view.offset.y);
  frame_.write(0, std::as_bytes(std::span(&frame, 1)));
  frame_.bindUniform(0);
}

FrameCost StandRenderer::draw(const View& view, FrameTarget& target) {
  FrameCost cost;
  cost.visible_seconds = secondsOf(timed_, [&] {
    bindFrame(view, target);
    target.beginVisible();
    programs_->visible.use();
    const glm::mat4 clip = clipFromWorld(view, target.size(), reach(view));
    for (const StandData::Kind& kind : data_.kinds()) {
      if (kind.drawn.empty()) continue;
      const VisibleTrees visible = visibleTrees(*kind.levels, kind.drawn, view, clip);
      kind.buffers->draw(visible);
      cost.triangles += visible.triangles;
      cost.draw_calls += visible.commands.size();
    }
  });
  return shade(view, target, cost);
}

FrameCost StandRenderer::draw(const View& view, FrameTarget& target, std::span<const glm::uvec2> visible) {
  bindFrame(view, target);
  target.setVisible(visible);
  return shade(view, target, {});
}

std::optional<Pick> StandRenderer::at(glm::ivec2 pixel, const View& view, const FrameTarget& target) const {
  const glm::vec2 place = glm::vec2(view.low + pixel) + 0.5f + view.offset;
  const Sight look = sightThrough(view.camera, {place.x, static_cast<float>(view.camera.height) - place.y});
  const glm::uvec2 id = target.visibleAt(pixel);
  if (id.x >= kGround) {
    const GroundDisc& ground = data_.ground();
    const float away = (ground.centre.z - look.from.z) / look.along.z;
    const glm::vec3 there = look.from + away * look.along;
    const bool seen = data_.frame().ground_albedo.w > 0.f && look.along.z < 0.f &&
                      (away > 0.f || !view.camera.perspective()) &&
                      (data_.frame().hasSky() || glm::distance(there, ground.centre) < ground.radius);
    return seen ? std::optional<Pick>({.tree = {}, .leaf = {}, .place = there}) : std::nullopt;
  }
  const StandData::Seen seen = data_.seen(id.x);
  const TriangleData& triangle = data_.kinds()[seen.kind].levels->triangles[id.y];
  const glm::vec3 normal = glm::normalize(glm::vec3(triangle.plane));
  const float away = (triangle.plane.w - glm::dot(normal, look.from - seen.position)) / glm::dot(normal, look.along);
  Pick pick{.tree = seen.tree, .leaf = {}, .place = look.from + away * look.along};
  if (triangle.leaf < TriangleData::kThinWood) pick.leaf = triangle.leaf;
  return pick;
}

// All but the empty sky.
PixelBox StandRenderer::shown(const View& view, glm::ivec2 size) const {
  if (data_.frame().hasSky()) return {.low = glm::ivec2(0), .high = size};
  const glm::mat4 clip = clipFromWorld(view, size, reach(view));
  const PixelBox trees = pixelsOf(data_.box(), clip, size);
  if (data_.frame().ground_albedo.w == 0.f) return trees;
  const GroundDisc& ground = data_.ground();
  const glm::vec3 radius(ground.radius, ground.radius, 0.f);
  const PixelBox disc = pixelsOf({ground.centre - radius, ground.centre + radius}, clip, size);
  if (data_.box().empty()) return disc;
  return {.low = glm::min(trees.low, disc.low), .high = glm::max(trees.high, disc.high)};
}

FrameCost StandRenderer::shade(const View& view, FrameTarget& target, FrameCost cost) {
  cost.shading_seconds = secondsOf(timed_, [&] {
    target.beginShading(view.accumulate, shown(view, target.size()));
    data_.bind();
    glBindTextureUnit(6, target.visible());
    const ShadingBuffers& buffers = programs_->buffersOf(view.model, data_);
    buffers.bind();
    programs_
        ->shadingFor({.model = view.model,
                      .layers = target.hasLayers(),
                      .one_kind = data_.kinds().size() == 1,
                      .one_light = data_.lights().size() == 1,
                      .gloss = buffers.gloss(),
                      .maps = data_.leafTables()->mapped(),
                      .sky = data_.litBySky()})
        .use();
    glBindVertexArray(programs_->no_array.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_SCISSOR_TEST);
  });
  return cost;
}

}  // namespace sunfleck::gl
