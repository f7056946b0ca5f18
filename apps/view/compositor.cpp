#include "apps/view/compositor.hpp"

#include <epoxy/gl.h>

#include <array>
#include <vector>

#include "apps/view/panels.hpp"
#include "render/gl/shader_text.hpp"

namespace sunfleck::view {
namespace {

constexpr int kColours = 256;

constexpr const char* kWholeScreen = R"(#version 450 core
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

// Places of what follows agree with setUniforms.
constexpr const char* kComposite = R"(#version 450 core
layout(binding = 0) uniform sampler2D picture_a;
layout(binding = 1) uniform sampler2D picture_b;
layout(binding = 2) uniform sampler1D difference_colours;
layout(location = 0) uniform int comparison;      // 0 A, 1 wipe, 2 B, 3 difference
layout(location = 1) uniform float first_of_b;    // pixel of the wipe
layout(location = 2) uniform float exposure;
layout(location = 3) uniform int tone;
layout(location = 4) uniform vec2 scales;         // of A and B
layout(location = 5) uniform ivec2 layers;        // of A and B: 0 radiance, 1 depth, 2 thickness, 3 G
layout(location = 6) uniform float difference_scale;
layout(location = 0) out vec4 colour;

// SHARED

vec3 shown(vec4 value, int layer, float scale) {
  if (layer == 0) {
    vec3 c;
    for (int band = 0; band < 3; ++band) c[band] = srgbCode(shownLight(tone, exposure * scale * value[band]));
    return c;
  }
  const float share = layer == 1 ? value.x / 20.0 : layer == 2 ? (value.x + value.y + 1.0) / 20.0 : value.w;
  return value == vec4(0.0) ? vec3(0.0) : falseColour(share);
}

void main() {
  const ivec2 at = ivec2(gl_FragCoord.xy);
  const vec4 a = texelFetch(picture_a, at, 0), b = texelFetch(picture_b, at, 0);
  vec3 c;
  if (comparison == 3)
    c = texture(difference_colours, 0.5 + 0.5 * dot(a.rgb * scales.x - b.rgb * scales.y, vec3(1.0 / 3.0)) / difference_scale).rgb;
  else if (comparison == 2 || (comparison == 1 && gl_FragCoord.x >= first_of_b))
    c = shown(b, layers.y, scales.y);
  else
    c = shown(a, layers.x, scales.x);
  colour = vec4(c, 1.0);
}
)";

std::string compositeText() {
  const std::string mark = "// SHARED";
  std::string text = kComposite, shared;
  for (const char* file : {"render/gl/prelude.glsl", "render/tone_mapping.glsl", "render/false_colour.glsl"})
    shared += gl::shaderText(file);
  return text.replace(text.find(mark), mark.size(), shared);
}

int kindOf(Layer layer) {
  switch (layer) {
    case Layer::depth:
      return 1;
    case Layer::thickness:
      return 2;
    case Layer::compensation:
      return 3;
    default:
      return 0;
  }
}

}  // namespace

gl::Layer frameLayer(Layer layer) {
  switch (layer) {
    case Layer::total:
      return gl::Layer::total;
    case Layer::direct:
      return gl::Layer::direct;
    case Layer::single:
      return gl::Layer::single;
    case Layer::multiple:
      return gl::Layer::multiple;
    case Layer::sky:
      return gl::Layer::sky;
    default:
      return gl::Layer::foliage;
  }
}

Compositor::Compositor()
    : program_({{gl::Stage::vertex, "the whole screen", kWholeScreen},
                {gl::Stage::fragment, "the composite", compositeText()}}) {
  glCreateVertexArrays(1, &array_);
  glCreateTextures(GL_TEXTURE_1D, 1, &colours_);
  glTextureStorage1D(colours_, 1, GL_RGBA32F, kColours);
  std::vector<glm::vec3> colours;
  for (int i = 0; i < kColours; ++i)
    colours.push_back(differenceColour(2.f * static_cast<float>(i) / (kColours - 1) - 1.f));
  glTextureSubImage1D(colours_, 0, 0, kColours, GL_RGB, GL_FLOAT, colours.data());
  glTextureParameteri(colours_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(colours_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
}

Compositor::~Compositor() {
  glDeleteVertexArrays(1, &array_);
  glDeleteTextures(1, &colours_);
}

void Compositor::draw(const Canvas& canvas, const Shown& a, const std::optional<Shown>& b, const Look& look,
                      float difference_scale) const {
  canvas.bind();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  program_.use();
  const Shown& second = b.value_or(a);
  const bool comparable = look.comparison != Comparison::difference || b.has_value();
  glUniform1i(0, comparable ? static_cast<int>(look.comparison) : 0);
  glUniform1f(1, std::round(look.wipe * static_cast<float>(canvas.size().x)));
  glUniform1f(2, look.display.exposure);
  glUniform1i(3, static_cast<int>(look.display.curve));
  glUniform2f(4, a.scale, second.scale);
  glUniform2i(5, kindOf(a.layer), kindOf(second.layer));
  glUniform1f(6, difference_scale);
  glBindTextureUnit(0, a.texture);
  glBindTextureUnit(1, second.texture);
  glBindTextureUnit(2, colours_);
  glBindVertexArray(array_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void ImageTexture::destroy(unsigned name) {
  glDeleteTextures(1, &name);
}

void ImageTexture::set(const Image& image) {
  unsigned name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  texture_.emplace(name);
  glTextureStorage2D(name, 1, GL_RGBA32F, image.width, image.height);
  std::vector<float> rows;
  for (int y = image.height; y-- > 0;)
    for (int x = 0; x < image.width; ++x)
      for (std::size_t channel = 0; channel < 3; ++channel) rows.push_back(image.values[image.at(x, y, channel)]);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(name, 0, 0, 0, image.width, image.height, GL_RGB, GL_FLOAT, rows.data());
}

std::optional<Shown> ImageTexture::shown() const {
  return texture_ ? std::optional(Shown{.texture = texture_->get()}) : std::nullopt;
}

}  // namespace sunfleck::view
