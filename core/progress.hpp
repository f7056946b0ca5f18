#pragma once

#include <functional>
#include <stdexcept>

namespace sunfleck {

// Long work tells how far it is [0, 1] and is answered whether to go on. After `false` it ends early with what it has.
// It is called from one thread at a time.
using Progress = std::function<bool(double done)>;

inline bool goOn(const Progress& progress, double done) {
  return !progress || progress(done);
}
// The same for work that is of no use before its end: throws std::runtime_error("interrupted") where it is not to go
// on.
inline void requireGoOn(const Progress& progress, double done) {
  if (!goOn(progress, done)) throw std::runtime_error("interrupted");
}

// The progress of a part of some work, which is from `from` to `to` of it. `whole` must outlive it.
inline Progress partOf(const Progress& whole, double from, double to) {
  if (!whole) return {};
  return [&whole, from, to](double done) { return whole(from + done * (to - from)); };
}

}  // namespace sunfleck
