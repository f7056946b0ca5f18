#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/viewer.hpp"

namespace sunfleck::view {
namespace {

constexpr double kLookAgain = 0.25;      // at Monte Carlo [s], but no more than
constexpr double kShareOfLooking = 0.1;  // of the time, as large pictures take long to compare
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

Viewer::ReferenceKey Viewer::referenceKey() const {
  return {.camera = session_.camera, .stand = stand_, .target = session_.look.reference_noise};
}

// Ends what is of another picture, whether anyone looks at it or not.
void Viewer::endStaleReference() {
  if (!reference_key_ || *reference_key_ == referenceKey()) return;
  tracing_.cancel();
  reference_key_.reset();
  reference_texture_.clear();
  compared_.reset();
  report_.error.reset();
  report_.reference_noise = report_.reference_done = report_.reference_seconds = 0.;
  report_.reference_runs = false;
  report_.reference_failure.clear();
}

std::optional<Shown> Viewer::referenceShown() {
  if (!reference_key_) {
    if (!still() || drag_ != Drag::none || !session_.shownScene()) return std::nullopt;
    Scene scene = *session_.shownScene();
    scene.camera = session_.camera;
    reference_key_ = referenceKey();
    tracing_.start(scene, reference_key_->target);
    reference_clock_ = Elapsed();
    looked_seconds_ = -1.;
    report_.reference_runs = true;
  }
  const double now = reference_clock_.seconds();
  if (report_.reference_runs && now - looked_seconds_ >= std::max(kLookAgain, looking_seconds_ / kShareOfLooking)) {
    looked_seconds_ = now;
    looking_seconds_ = 0.;
    const Elapsed looking;
    const ReferencePicture::Snapshot seen = tracing_.snapshot();
    report_.reference_runs = seen.running;
    report_.reference_seconds = now;
    report_.reference_failure = seen.failure;
    report_.reference_finished = seen.finished;
    if (std::isfinite(seen.noise) && seen.noise > 0.) {
      report_.reference_noise = seen.noise;
      report_.reference_done = std::min(1., std::pow(reference_key_->target / seen.noise, 2.));
    }
    if (seen.radiance.width == picture_.size().x && seen.radiance.height == picture_.size().y && seen.samples > 0.) {
      reference_texture_.set(seen.radiance);
      reference_ = seen;
      compared_.reset();
    }
    looking_seconds_ += looking.seconds();
  }
  return reference_texture_.shown();
}

// Differences are told of whole pictures alone: smooth ones, or what there is of Monte Carlo.
void Viewer::compare() {
  const Look& look = session_.look;
  report_.difference_scale = look.difference_scale > 0.f ? look.difference_scale : std::max(largest_difference_, 1e-6f);
  ComparedKey key{.a = keyOf(model_), .b = {}, .samples = look.samples};
  if (look.other) key.b = keyOf(*look.other);
  if (compared_ == key) return;
  const bool there = key.b ? b_.done(look.samples) && b_.key() == *key.b : reference_texture_.shown().has_value();
  if (!a_.done(look.samples) || !(a_.key() == key.a) || !there) {
    report_.error.reset();
    return;
  }
  const Elapsed looking;
  const Image of_a = imageOf(a_), of_b = look.other ? imageOf(b_) : reference_.radiance;
  report_.error = pictureError(of_a, of_b, look.other ? nullptr : &reference_.standard_error);
  std::vector<float> differences = differencePicture(of_a, of_b).values;
  const auto rank =
      differences.begin() + static_cast<std::ptrdiff_t>(kShareInScale * static_cast<double>(differences.size() - 1));
  std::nth_element(differences.begin(), rank, differences.end());
  largest_difference_ = *rank;
  compared_ = key;
  looking_seconds_ += looking.seconds();
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
  const gl::View view{.camera = camera, .model = model_, .low = {probe.pixel.x, camera.height - 1 - probe.pixel.y}};
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
