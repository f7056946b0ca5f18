#include "apps/sweep_queue.hpp"

#include <algorithm>
#include <utility>

namespace sunfleck::apps {

SweepQueue::SweepQueue(std::vector<Entry> entries, int workers)
    : left_(std::move(entries)), scene_of_(static_cast<std::size_t>(workers)) {}

std::optional<std::size_t> SweepQueue::take(int worker) {
  const std::scoped_lock lock(mutex_);
  if (left_.empty()) return std::nullopt;
  std::optional<std::size_t>& own = scene_of_[static_cast<std::size_t>(worker)];
  auto found = std::find_if(left_.begin(), left_.end(), [&](const Entry& entry) { return entry.scene == own; });
  const auto isFree = [&](const Entry& entry) {
    return std::find(scene_of_.begin(), scene_of_.end(), entry.scene) == scene_of_.end();
  };
  if (found == left_.end()) found = std::find_if(left_.begin(), left_.end(), isFree);
  if (found == left_.end()) found = left_.begin();
  const Entry taken = *found;
  own = taken.scene;
  left_.erase(found);
  return taken.task;
}

void SweepQueue::stop() {
  const std::scoped_lock lock(mutex_);
  left_.clear();
}

}  // namespace sunfleck::apps
