#pragma once

#include <algorithm>
#include <atomic>
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
    done_.fetch_add(parts, std::memory_order_relaxed);
    // Whoever finds another thread asking leaves it to that one.
    if (const std::unique_lock lock(mutex_, std::try_to_lock); lock && goes_on_)
      goes_on_ = progress_(std::min(done_ / parts_, 1.));
    if (!goes_on_) throw std::runtime_error("interrupted");
  }

  // For work that is told to go on by a Progress of its own: asks, and tells nothing.
  Progress asking() {
    if (!progress_) return {};
    return [this](double) {
      add(0.);
      return true;
    };
  }

 private:
  const Progress& progress_;
  double parts_;
  std::atomic<double> done_ = 0.;
  std::atomic<bool> goes_on_ = true;
  std::mutex mutex_;
};

}  // namespace sunfleck
