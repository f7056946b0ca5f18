#include "render/gl/stand_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "core/require.hpp"
#include "render/gl/detail/frame_data.hpp"

namespace sunfleck::gl {
namespace {

constexpr int kLongestSide = 16384;  // [pixel]
constexpr int kTile = 1024;          // [pixel]

struct LayerNames {
  Layer layer;
  std::string name;
  std::vector<std::string> channels;
};
const std::array<LayerNames, kLayers>& layerNames() {
  const auto radiance = [](const std::string& of) { return std::vector{of + ".R", of + ".G", of + ".B"}; };
  static const std::array<LayerNames, kLayers> names{{
      {Layer::total, "total", {"R", "G", "B", "A"}},
      {Layer::direct, "direct", radiance("direct")},
      {Layer::single, "single", radiance("single")},
      {Layer::multiple, "multiple", radiance("multiple")},
      {Layer::sky, "sky", radiance("sky")},
      {Layer::geometry, "geometry", {"normal.X", "normal.Y", "normal.Z", "depth.Z"}},
      {Layer::foliage, "foliage", {"foliage.before", "foliage.beyond", "foliage.visible", "foliage.G"}},
      {Layer::ids, "ids", {"id.tree", "id.triangle", "id.kind", "id.leaf"}},
  }};
  return names;
}
const LayerNames& namesOf(Layer layer) {
  return *std::ranges::find(layerNames(), layer, &LayerNames::layer);
}

bool isSum(Layer layer) {
  return layer != Layer::geometry && layer != Layer::foliage && layer != Layer::ids;
}

void requireDrawable(const Camera& camera) {
  for (const int side : {camera.width, camera.height})
    require(side > 0 && side <= kLongestSide, "picture size [pixel]", side, "1 .. " + std::to_string(kLongestSide));
  require(std::isfinite(camera.half_width) && camera.half_width > 0.f, "camera half width [m]", camera.half_width,
          "a finite number above 0");
}

// Copies a layer of the target into channels of the image, from `first` on.
void copyTile(const FrameTarget& target, Layer layer, glm::ivec2 low, std::size_t first, Image& image) {
  const std::vector<float> values = layer == Layer::ids ? std::vector<float>() : target.read(layer);
  const std::vector<std::uint32_t> ids = layer == Layer::ids ? target.readIds() : std::vector<std::uint32_t>();
  const std::size_t channels = namesOf(layer).channels.size();
  const glm::ivec2 size = glm::min(target.size(), glm::ivec2(image.width, image.height) - low);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (std::size_t channel = 0; channel < channels; ++channel) {
        const std::size_t from = 4 * static_cast<std::size_t>(y * target.size().x + x) + channel;
        float value = 0.f;
        if (layer != Layer::ids)
          value = values[from];
        else
          value = ids[from] >= detail::kGround ? -1.f : static_cast<float>(ids[from]);
        image.values[image.at(low.x + x, image.height - 1 - (low.y + y), first + channel)] = value;
      }
}

}  // namespace

std::string nameOf(Layer layer) {
  return namesOf(layer).name;
}

Image standPicture(const Context& context, StandRenderer& renderer, const Camera& camera, const PictureEffort& effort,
                   const Progress& progress) {
  requireDrawable(camera);
  Image image{.width = camera.width, .height = camera.height, .channels = {}, .values = {}};
  std::vector<Layer> layers{Layer::total};
  std::ranges::copy_if(effort.layers, std::back_inserter(layers),
                       [&](Layer layer) { return layer != Layer::single || tellsSingle(effort.model); });
  std::vector<std::size_t> first_channel;
  for (const Layer layer : layers) {
    first_channel.push_back(image.channels.size());
    const auto& names = namesOf(layer).channels;
    image.channels.insert(image.channels.end(), names.begin(), names.end());
  }
  image.values.resize(image.at(0, camera.height, 0));

  const glm::ivec2 picture(camera.width, camera.height);
  const glm::ivec2 tile = glm::min(glm::ivec2(kTile), picture);
  const glm::ivec2 tiles = (picture + tile - 1) / tile;
  FrameTarget target(tile, layers.size() > 1);
  View view{.camera = camera, .model = effort.model, .piece_pixels = effort.piece_pixels};
  const double frames = static_cast<double>(tiles.x * tiles.y) * effort.samples;
  int frame = 0;
  for (int y = 0; y < tiles.y; ++y)
    for (int x = 0; x < tiles.x; ++x) {
      view.low = tile * glm::ivec2(x, y);
      const auto draw = [&](int number, bool accumulate) {
        view.offset = sampleOffset(number);
        view.accumulate = accumulate;
        if (effort.visible)
          renderer.draw(view, target, effort.visible(view, target.size()));
        else
          renderer.draw(view, target);
      };
      const auto copy = [&](bool sums) {
        for (std::size_t i = 0; i < layers.size(); ++i)
          if (isSum(layers[i]) == sums) copyTile(target, layers[i], view.low, first_channel[i], image);
      };
      if (layers.size() > 1) {
        draw(0, false);
        copy(false);
      }
      const int first = effort.samples % 2 == 0 ? 1 : 0;  // in pairs about the middle
      for (int sample = 0; sample < effort.samples; ++sample) {
        if (!goOn(progress, frame++ / frames)) throw std::runtime_error("interrupted");
        draw(first + sample, sample > 0);
        context.requireNoError("drawing the picture");
      }
      copy(true);
    }
  return image;
}

Image scenePicture(const Scene& scene, const StandGeometry& geometry, const PictureEffort& effort,
                   const Progress& progress) {
  const Camera camera = cameraOf(scene);
  requireDrawable(camera);
  const Context context;
  StandRenderer renderer(context, effort.exact);
  renderer.update(drawnStand(scene, geometry));
  return standPicture(context, renderer, camera, effort, progress);
}

}  // namespace sunfleck::gl
