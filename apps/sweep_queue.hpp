#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

namespace sunfleck::apps {

// The tasks of a sweep that are still to be done, dealt one by one to whoever has time.
class SweepQueue {
 public:
  struct Entry {
    std::size_t task, scene;
  };
  SweepQueue(std::vector<Entry> entries, int workers);

  // A task of the scene that the worker has ready, or else of one that nobody else has, or else any; none when all are
  // dealt or it was stopped.
  std::optional<std::size_t> take(int worker);
  void stop();

 private:
  std::mutex mutex_;
  std::vector<Entry> left_;
  std::vector<std::optional<std::size_t>> scene_of_;  // by worker
};

}  // namespace sunfleck::apps
