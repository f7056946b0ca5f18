#include "render/gl/stand_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

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

PictureByFrames::PictureByFrames(const Context& context, StandRenderer& renderer, const Camera& camera,
                                 PictureEffort effort)
    : context_(&context),
      renderer_(&renderer),
      effort_(std::move(effort)),
      view_{.camera = camera, .model = effort_.model, .piece_pixels = effort_.piece_pixels},
      image_{.width = camera.width, .height = camera.height, .channels = {}, .values = {}},
      layers_{Layer::total} {
  requireDrawable(camera);
  std::ranges::copy_if(effort_.layers, std::back_inserter(layers_),
                       [&](Layer layer) { return layer != Layer::single || tellsSingle(effort_.model); });
  for (const Layer layer : layers_) {
    first_channel_.push_back(image_.channels.size());
    const auto& names = namesOf(layer).channels;
    image_.channels.insert(image_.channels.end(), names.begin(), names.end());
  }
  image_.values.resize(image_.at(0, camera.height, 0));
  const glm::ivec2 picture(camera.width, camera.height);
  tile_ = glm::min(glm::ivec2(kTile), picture);
  tiles_ = (picture + tile_ - 1) / tile_;
  frames_of_tile_ = effort_.samples + (layers_.size() > 1 ? 1 : 0);
  target_.emplace(tile_, layers_.size() > 1);
}

void PictureByFrames::copyLayers(bool sums) {
  for (std::size_t i = 0; i < layers_.size(); ++i)
    if (isSum(layers_[i]) == sums) copyTile(*target_, layers_[i], view_.low, first_channel_[i], image_);
}

void PictureByFrames::drawFrame() {
  if (complete()) return;
  const int tile = frame_ / frames_of_tile_, of_middle = layers_.size() > 1 ? 1 : 0;
  const int sample = frame_ % frames_of_tile_ - of_middle;
  view_.low = tile_ * glm::ivec2(tile % tiles_.x, tile / tiles_.x);
  const int first = effort_.samples % 2 == 0 ? 1 : 0;  // in pairs about the middle
  view_.offset = sampleOffset(sample < 0 ? 0 : first + sample);
  view_.accumulate = sample > 0;
  if (effort_.visible)
    renderer_->draw(view_, *target_, effort_.visible(view_, target_->size()));
  else
    renderer_->draw(view_, *target_);
  context_->requireNoError("drawing the picture");
  if (sample < 0) copyLayers(false);
  if (sample == effort_.samples - 1) copyLayers(true);
  ++frame_;
}

Image standPicture(const Context& context, StandRenderer& renderer, const Camera& camera, const PictureEffort& effort,
                   const Progress& progress) {
  PictureByFrames picture(context, renderer, camera, effort);
  while (!picture.complete()) {
    if (!goOn(progress, picture.done())) throw std::runtime_error("interrupted");
    picture.drawFrame();
  }
  return picture.take();
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
