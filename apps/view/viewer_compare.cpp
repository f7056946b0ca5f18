#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/viewer.hpp"

namespace sunfleck::view {
namespace {

constexpr double kLookAgain = 0.25;      // at Monte Carlo [s]
constexpr double kShareInScale = 0.995;  // of the pixels whose difference the colours tell

Image imageOf(const ProgressivePicture& picture) {
  const glm::ivec2 size = picture.target().size();
  Image image{.width = size.x, .height = size.y, .channels = {"R", "G", "B", "A"}, .values = {}};
  const std::vector<float> rows = picture.target().read(gl::Layer::total);  // from the bottom
  const auto row = 4 * static_cast<std::ptrdiff_t>(size.x);
  for (std::ptrdiff_t y = size.y; y-- > 0;)
    image.values.insert(image.values.end(), rows.begin() + y * row, rows.begin() + (y + 1) * row);
  return image;
}

}  // namespace

std::optional<Shown> Viewer::referenceShown() {
  const Document& document = session_.document();
  const bool settled = still();
  const ReferenceKey key{.camera = session_.camera, .stand = stand_, .target = session_.look.reference_noise};
  if (reference_key_ != key) {
    reference_texture_.clear();  // it is of another picture
    compared_.reset();
    report_.error.reset();
    report_.reference_noise = report_.reference_done = report_.reference_seconds = 0.;
    report_.reference_runs = false;
    report_.reference_failure.clear();
    if (reference_key_) tracing_.cancel();
    reference_key_.reset();
    if (!settled || drag_ != Drag::none) return std::nullopt;
    Scene scene = document.scene;
    scene.camera = session_.camera;
    tracing_.start(scene, key.target);
    reference_key_ = key;
    reference_clock_ = Elapsed();
    looked_seconds_ = -1.;
    report_.reference_runs = true;
  }
  const double now = reference_clock_.seconds();
  if (report_.reference_runs && now - looked_seconds_ >= kLookAgain) {
    looked_seconds_ = now;
    const ReferencePicture::Snapshot seen = tracing_.snapshot();
    report_.reference_runs = seen.running;
    report_.reference_seconds = now;
    report_.reference_failure = seen.failure;
    report_.reference_finished = seen.finished;
    if (std::isfinite(seen.noise) && seen.noise > 0.) {
      report_.reference_noise = seen.noise;
      report_.reference_done = std::min(1., key.target * key.target / (seen.noise * seen.noise));
    }
    if (seen.radiance.width == picture_.size().x && seen.radiance.height == picture_.size().y && seen.samples > 0.) {
      reference_texture_.set(seen.radiance);
      reference_ = seen;
      compared_.reset();
    }
  }
  return reference_texture_.shown();
}

// Differences are told of whole pictures alone: smooth ones, or what there is of Monte Carlo.
void Viewer::compare() {
  const Look& look = session_.look;
  const PictureKey a = keyOf(session_.document().model), b = keyOf(look.other.value_or(session_.document().model));
  if (compared_ == std::pair(a, b)) return;
  const bool there = look.other ? b_.done(look.samples) && b_.key() == b : reference_texture_.shown().has_value();
  if (!a_.done(look.samples) || !(a_.key() == a) || !there) {
    report_.error.reset();
    return;
  }
  const Image of_a = imageOf(a_), of_b = look.other ? imageOf(b_) : reference_.radiance;
  report_.error = pictureError(of_a, of_b, look.other ? nullptr : &reference_.standard_error);
  std::vector<float> differences = differencePicture(of_a, of_b).values;
  const auto rank =
      differences.begin() + static_cast<std::ptrdiff_t>(kShareInScale * static_cast<double>(differences.size() - 1));
  std::nth_element(differences.begin(), rank, differences.end());
  report_.difference_scale = look.difference_scale > 0.f ? look.difference_scale : std::max(*rank, 1e-6f);
  compared_ = std::pair(a, b);
}

Probe Viewer::probeAt(glm::vec2 place) {
  const Camera& camera = session_.camera;
  Probe probe{.pixel = glm::ivec2(glm::floor(place))};
  if (probe.pixel.x < 0 || probe.pixel.y < 0 || probe.pixel.x >= camera.width || probe.pixel.y >= camera.height ||
      stand_ == 0) {
    probe.what = "beside the picture";
    return probe;
  }
  // The middle of this pixel alone, as no other sample blurs it.
  if (!probe_target_) probe_target_.emplace(glm::ivec2(1), true);
  const gl::View view{
      .camera = camera, .model = session_.document().model, .low = {probe.pixel.x, camera.height - 1 - probe.pixel.y}};
  renderer_.draw(view, *probe_target_);
  const auto read = [&](gl::Layer layer) {
    const std::vector<float> v = probe_target_->read(layer);
    return glm::vec4(v[0], v[1], v[2], v[3]);
  };
  probe.radiance = read(gl::Layer::total);
  probe.direct = read(gl::Layer::direct);
  probe.single = read(gl::Layer::single);
  probe.multiple = read(gl::Layer::multiple);
  probe.sky = read(gl::Layer::sky);
  const std::optional<gl::Pick> seen = renderer_.at({0, 0}, view, *probe_target_);
  if (!seen) return probe;
  const Scene& scene = session_.document().scene;
  probe.place = seen->place;
  if (!seen->tree) probe.what = "ground";
  if (!seen->tree || scene.stand.trees.size() != drawn_trees_) return probe;
  probe.tree = *seen->tree;
  const std::string& kind = scene.kindOf(scene.stand.trees[*seen->tree]).name;
  probe.what = seen->leaf ? fmt::format("{}, leaf {}", kind, *seen->leaf + 1) : kind + ", wood";
  if (!seen->leaf) return probe;
  const glm::vec4 foliage = read(gl::Layer::foliage);
  probe.depth = foliage.x;
  probe.thickness = foliage.x + foliage.y + 1.f;
  probe.compensation = foliage.w;
  return probe;
}

}  // namespace sunfleck::view
