#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/image.hpp"
#include "render/scene.hpp"

namespace sunfleck {

// A Monte Carlo picture of a scene (R2), traced in the background and refined while one looks: first everywhere, then
// where it is noisiest. Its methods are for one thread and never wait for the tracing. With a seed and a target the
// finished picture is the same to the bit for any number of threads.
class ReferencePicture {
 public:
  //   threads  that trace, at low priority; at least 1
  explicit ReferencePicture(int threads, std::uint64_t seed = 1);
  ~ReferencePicture();  // ends the tracing, and waits until it has

  // Begins anew, with the scene's camera and all its suns; what was traced of another is dropped.
  //   target  root mean square standard error of the pixels at which it is finished, relative to the picture's mean [1]
  void start(const Scene& scene, double target = 1e-3);
  void cancel();  // ends the tracing; what it has found stays

  // All zero where nothing has been traced yet, and without pixels before it has begun.
  struct Snapshot {
    Image radiance;           // channels R, G, B, as CameraResult has them [1/sr]
    Image standard_error;     // of each pixel, channels R, G, B
    std::uint64_t paths = 0;  // from the camera
    double samples = 0.;      // of each pixel, in the mean
    // Root mean square standard error of the pixels, relative to the mean, in the noisiest band; infinite before the
    // first samples [1].
    double noise = 0.;
    bool running = false;
    bool finished = false;  // the target is reached
    std::string failure;    // what ended it, one line
  };
  Snapshot snapshot() const;

 private:
  struct Run;
  struct Traced;
  struct Thread;
  void work(Run& run);
  void trace(Run& run);

  int threads_;
  std::uint64_t seed_;
  std::shared_ptr<Run> run_;
  std::unique_ptr<Thread> thread_;
  std::shared_ptr<const Traced> traced_;  // of the thread that works alone
};

}  // namespace sunfleck
