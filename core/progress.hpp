#pragma once

#include <functional>

namespace sunfleck {

// Long work tells how far it is [0, 1] and is answered whether to go on. After `false` it ends early with what it has.
// It is called from one thread at a time.
using Progress = std::function<bool(double done)>;

inline bool goOn(const Progress& progress, double done) {
  return !progress || progress(done);
}

}  // namespace sunfleck
