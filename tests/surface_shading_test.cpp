// Check that surfaces are shaded on the GPU as they are in C++, by every model, and that what they send adds up.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "render/compare/exact_powers.hpp"
#include "render/gl/buffer.hpp"
#include "render/gl/context.hpp"
#include "render/gl/program.hpp"
#include "render/gl/shader_text.hpp"
#include "render/gl/shading_buffers.hpp"
#include "render/shading/fragment_shading.hpp"
#include "render/shading/shading_model.hpp"

namespace {

using namespace sunfleck;
using namespace sunfleck::shading;
using glm::dot;

constexpr float kLeaf = 0.f, kWood = 1.f, kGround = 2.f;

// A fragment as the shader below lays it out, in the light of one sun.
struct Input {
  vec4 normal;       // w: kind
  vec4 to_eye;       // w: kLeaf, kWood or kGround
  vec4 foliage;      // before, beyond, visible; w: thickness
  vec4 sky;          // w: G
  vec4 albedo;       // of the ground; w: light
  vec4 same, other;  // that the field tells
};
struct Output {
  vec4 direct, single, scattered, sky, field;
};

constexpr const char* kMain = R"(
  layout(local_size_x = 64) in;
  struct Input { vec4 normal, to_eye, foliage, sky, albedo, same, other; };
  struct Output { vec4 direct, single, scattered, sky, field; };
  layout(std430, binding = 0) readonly buffer Inputs { Input inputs[]; };
  layout(std430, binding = 1) writeonly buffer Outputs { Output outputs[]; };
  void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= inputs.length()) return;
    Input x = inputs[i];
    uint kind = uint(x.normal.w);
    Surface surface = x.to_eye.w == 0.0   ? leafSurface(kind, kNoLeafPlace, true, 0u, 0u, x.normal.xyz, x.to_eye.xyz)
                      : x.to_eye.w == 1.0 ? woodSurface(kind, 0u, x.normal.xyz, x.to_eye.xyz)
                                          : opaqueSurface(kind, 0u, x.albedo.xyz, x.normal.xyz, x.to_eye.xyz);
    Foliage foliage = Foliage(x.foliage.x, x.foliage.y, x.foliage.z);
    Shaded by_light = shadeByLight(surface, foliage, x.foliage.w, x.sky.w, uint(x.albedo.w));
    Shaded by_sky = shadeBySky(surface, x.sky.xyz);
    Shaded by_field = Shaded(vec3(0.0), vec3(0.0), vec3(0.0));
#ifdef FIELD
    by_field = shadeBySides(surface, x.same.xyz, x.other.xyz);
#endif
    outputs[i] = Output(vec4(by_light.direct, 0.0), vec4(by_light.single, 0.0), vec4(by_light.scattered, 0.0),
                        vec4(by_sky.direct + by_sky.scattered, 0.0),
                        vec4(by_field.scattered, 0.0));
  })";

std::vector<Output> shadedOnGpu(Model model, const ShadingData& data, const std::vector<Input>& inputs) {
  const gl::Context context;
  const gl::Program program{
      {.stage = gl::Stage::compute,
       .name = nameOf(model),
       .text = std::string("#version 450 core\n") + (model == Model::field ? "#define FIELD\n" : "") +
               gl::shaderText("render/gl/prelude.glsl") + gl::shaderText("spp/spp_formulas.glsl") +
               "struct Foliage { float before, beyond, visible; };\n" +
               gl::shaderText("render/gl/shading.glsl", shadingModel(model).text) + kMain}};
  const gl::ShadingBuffers shading(data);
  shading.bind();
  const gl::Buffer in(inputs), out(std::vector<Output>(inputs.size()));
  in.bindStorage(0);
  out.bindStorage(1);
  program.use();
  glDispatchCompute(static_cast<GLuint>(inputs.size() / 64 + 1), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const std::vector<Output> outputs = out.read<Output>();
  context.requireNoError("shading fragments");
  return outputs;
}

std::vector<Output> shadedInCpp(Model model, const ShadingData& data, const std::vector<Input>& inputs) {
  const FragmentShading shading(model, data);
  std::vector<Output> outputs;
  for (const Input& x : inputs) {
    const uint kind = static_cast<uint>(x.normal.w);
    const vec3 normal(x.normal), to_eye(x.to_eye);
    const Surface surface = x.to_eye.w == kLeaf   ? shading.leafSurface(kind, {}, 0, 0, normal, to_eye)
                            : x.to_eye.w == kWood ? shading.woodSurface(kind, 0, normal, to_eye)
                                                  : shading.groundSurface(kind, vec3(x.albedo), normal, to_eye);
    const FragmentLight at{
        .foliage = {x.foliage.x, x.foliage.y, x.foliage.z}, .thickness = x.foliage.w, .compensation = x.sky.w};
    const Shaded by_light = shading.shadeByLight(surface, at, static_cast<uint>(x.albedo.w));
    const Shaded by_sky = shading.shadeBySky(surface, vec3(x.sky));
    const Shaded by_field = shading.shadeBySides(surface, vec3(x.same), vec3(x.other));
    outputs.push_back({vec4(by_light.direct, 0.f), vec4(by_light.single, 0.f), vec4(by_light.scattered, 0.f),
                       vec4(by_sky.direct + by_sky.scattered, 0.f), vec4(by_field.scattered, 0.f)});
  }
  return outputs;
}

glm::vec3 direction(Random& random) {
  const float z = 2.f * random.uniform() - 1.f, azimuth = 2.f * std::numbers::pi_v<float> * random.uniform();
  const float across = std::sqrt(1.f - z * z);
  return {across * std::cos(azimuth), across * std::sin(azimuth), z};
}

// Two kinds, whose bands reach from black to white; in two suns.
std::vector<TreeKind> twoKinds() {
  std::vector<TreeKind> kinds(2);
  kinds[0].leaf = {LeafOptics{.reflectance = 0.475f, .transmittance = 0.475f},
                   LeafOptics{.reflectance = 0.1f, .transmittance = 0.05f},
                   LeafOptics{.reflectance = 0.f, .transmittance = 0.f}};
  kinds[1].leaf = {LeafOptics{.reflectance = 0.7f, .transmittance = 0.3f},
                   LeafOptics{.reflectance = 0.f, .transmittance = 1.f},
                   LeafOptics{.reflectance = 0.4f, .transmittance = 0.f}};
  for (LeafOptics& leaf : kinds[1].leaf) {
    leaf.gloss = 0.5f * leaf.albedo();
    leaf.gloss_roughness = 0.2f;
  }
  kinds[1].wood_reflectance = glm::vec3(0.5f, 0.2f, 1.f);
  return kinds;
}
ShadingData twoKindsTwoSuns(Model model) {
  const std::array lights{
      ShadingLight{.travel = vec4(sunlight(0.5f, 1.f), 0.f), .irradiance = vec4(1.f, 0.8f, 0.3f, 0.f)},
      ShadingLight{.travel = vec4(sunlight(1.4f, 3.f), 0.f), .irradiance = vec4(0.1f, 2.f, 0.f, 0.f)}};
  ShadingData data;
  update(data, model, twoKinds(), lights, exactPowerTable);
  return data;
}

// 8,192 fragments at random and in corners: no foliage, foliage without end, G of 0 and 1, surfaces along the light.
std::vector<Input> fragments(const ShadingData& data) {
  std::vector<Input> inputs;
  Random random(7, 0);
  for (int i = 0; i < 8192; ++i) {
    const float light = static_cast<float>(i % 2);
    const vec3 eye = direction(random);
    vec3 normal = direction(random);
    if (i % 16 == 0) normal = vec3(data.lights[static_cast<std::size_t>(i % 2)].travel);
    if (dot(normal, eye) < 0.f) normal = -normal;
    float before = std::exp(10.f * random.uniform() - 6.f), beyond = std::exp(10.f * random.uniform() - 6.f);
    if (i % 16 == 1) before = 0.f;
    if (i % 16 == 2) beyond = 0.f;
    if (i % 16 == 3) before = beyond = 0.f;
    const float thing = std::array{kLeaf, kWood, kGround}[static_cast<std::size_t>(i % 3)];
    float thickness = before + beyond + (thing == kLeaf ? 1.f : 0.f);
    if (i % 16 == 4) thickness = std::numeric_limits<float>::infinity();
    float compensation = random.uniform();
    if (i % 16 == 5) compensation = 0.f;
    if (i % 16 == 6) compensation = 1.f;
    inputs.push_back({.normal = vec4(normal, static_cast<float>((i / 2) % 2)),
                      .to_eye = vec4(eye, thing),
                      .foliage = {before, beyond, before > 0.f ? std::exp(-before) * random.uniform() : 1.f, thickness},
                      .sky = {random.uniform(), random.uniform(), random.uniform(), compensation},
                      .albedo = {random.uniform(), 0.f, 1.f, light},
                      .same = vec4(direction(random) + 1.f, 0.f),
                      .other = vec4(direction(random) + 1.f, 0.f)});
  }
  return inputs;
}

class SurfaceShading : public testing::TestWithParam<Model> {};

// Check that the GPU shades as C++ does. The bound, 3e-6 absolute and relative, is that of the closed forms
// (gl_formulas_test.cpp) for light of power 1; radiance is less than the power by pi.
TEST_P(SurfaceShading, OfTheGpuIsThatOfCpp) {
  const ShadingData data = twoKindsTwoSuns(GetParam());
  const std::vector<Input> inputs = fragments(data);
  const std::vector<Output> gpu = shadedOnGpu(GetParam(), data, inputs), cpp = shadedInCpp(GetParam(), data, inputs);
  float worst = 0.f, brightest = 0.f;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    for (const auto part : {&Output::direct, &Output::single, &Output::scattered, &Output::sky, &Output::field})
      for (int band = 0; band < 3; ++band) {
        const float found = (gpu[i].*part)[band], expected = (cpp[i].*part)[band];
        ASSERT_TRUE(std::isfinite(expected));
        ASSERT_GE(expected, 0.f);
        ASSERT_NEAR(found, expected, 3e-6f + 3e-6f * expected) << "fragment " << i << " band " << band;
        worst = std::max(worst, std::abs(found - expected));
        const bool scattered = part == &Output::scattered || part == &Output::field;
        brightest = std::max(brightest, scattered ? expected : 0.f);
      }
  EXPECT_EQ(brightest > 0.1f, GetParam() != Model::ss);  // there was something to compare
  std::ostringstream largest;
  largest << worst;
  RecordProperty("worst", largest.str());
}
INSTANTIATE_TEST_SUITE_P(All, SurfaceShading, testing::ValuesIn(kModels),
                         [](const auto& model) { return nameOf(model.param); });

}  // namespace
