#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/gl/stand_renderer.hpp"

namespace sunfleck::view {

// What a picture was drawn from: as long as it is the same, more samples make it smoother.
struct PictureKey {
  Camera camera;
  Model model = Model::sppg;
  bool layers = false, fewer_leaves = true;
  std::uint64_t stand = 0;  // which the renderer holds
  std::uint64_t field = 0;  // revision of its light field, where the model shows it
  bool operator==(const PictureKey&) const = default;
};

// A picture in the current OpenGL context that grows smoother by one sample at a time.
class ProgressivePicture {
 public:
  // Begins anew with another key; else adds a sample, unless there are so many. Whether it drew.
  bool draw(gl::StandRenderer& renderer, const PictureKey& key, int samples);
  const gl::FrameTarget& target() const { return *target_; }
  int samples() const { return target_ ? target_->samples() : 0; }
  bool done(int samples) const { return target_ && target_->samples() >= samples; }
  const gl::FrameCost& cost() const { return cost_; }
  const PictureKey& key() const { return key_; }

 private:
  std::optional<gl::FrameTarget> target_;
  PictureKey key_;
  gl::FrameCost cost_;
};

}  // namespace sunfleck::view
