#include "apps/view/progressive_picture.hpp"

namespace sunfleck::view {
namespace {

constexpr float kPiecePixels = 2.f;  // leaves are drawn fewer and larger, up to this

}  // namespace

bool ProgressivePicture::draw(gl::StandRenderer& renderer, const PictureKey& key, int samples) {
  const glm::ivec2 size(key.camera.width, key.camera.height);
  const bool anew = !target_ || !(key == key_);
  if (!anew && target_->samples() >= samples) return false;
  if (!target_ || target_->size() != size || target_->hasLayers() != key.layers) {
    target_.reset();  // its memory first
    target_.emplace(size, key.layers);
  }
  const int number = anew ? 0 : target_->samples();
  // One sample lies in the middle of the pixel, an even number about it.
  cost_ = renderer.draw({.camera = key.camera,
                         .model = key.model,
                         .offset = gl::sampleOffset(samples == 1 ? 0 : number + 1),
                         .accumulate = !anew,
                         .piece_pixels = key.fewer_leaves ? kPiecePixels : 0.f},
                        *target_);
  key_ = key;
  return true;
}

}  // namespace sunfleck::view
