#pragma once

#include <algorithm>
#include <mutex>
#include <stdexcept>

#include "core/progress.hpp"

namespace sunfleck {

// Progress of work that several threads share. `progress`, which must outlive it, is asked by one of them at a time.
class SharedProgress {
 public:
  //   parts  that the work consists of, > 0
  SharedProgress(const Progress& progress, double parts) : progress_(progress), parts_(parts) {}

  // Tells of parts that a thread is done with. Throws std::runtime_error("interrupted"), from then on in every thread,
  // where the work is not to go on.
  void add(double parts = 1.) {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    done_ += parts;
    tell();
  }

  // Asks, and tells of nothing new; nor does it wait for another thread that is asking. Throws as add() does.
  void ask() {
    if (!progress_) return;
    if (const std::unique_lock lock(mutex_, std::try_to_lock); lock) tell();
  }

  // For work that asks a Progress of its own.
  Progress asking() {
    if (!progress_) return {};
    return [this](double) {
      ask();
      return true;
    };
  }

 private:
  void tell() {
    goes_on_ = goes_on_ && progress_(std::min(done_ / parts_, 1.));
    if (!goes_on_) throw std::runtime_error("interrupted");
  }

  const Progress& progress_;
  double parts_, done_ = 0.;
  bool goes_on_ = true;
  std::mutex mutex_;
};

}  // namespace sunfleck
