#pragma once

#include <chrono>
#include <ctime>

namespace sunfleck {

// Time since it was made: on the wall, and spent by all threads of this process.
class Elapsed {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start_).count();
  }
  double cpuSeconds() const { return processSeconds() - cpu_start_; }

 private:
  static double processSeconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  std::chrono::steady_clock::time_point wall_start_ = std::chrono::steady_clock::now();
  double cpu_start_ = processSeconds();
};

}  // namespace sunfleck
