#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "render/reference/trace_file.hpp"

namespace sunfleck {

// A trace file is one process's alone while it has this lock: a file beside it, which the system lets go of however the
// process ends.
class TraceLock {
 public:
  // Throws InvalidInput when another process has it, or no file can be written there.
  explicit TraceLock(const std::filesystem::path& file);
  ~TraceLock();
  TraceLock(const TraceLock&) = delete;
  TraceLock& operator=(const TraceLock&) = delete;

 private:
  std::string path_;
  int file_ = -1;
};

// Where a run keeps its sums: in memory or also in a trace file, which is read when it is there and written from time
// to time, so that a run that is killed loses little and goes on from it to the same bits.
class TraceStore {
 public:
  TraceStore() = default;
  //   run  what tells this run from others: the program's version, the scene
  // Throws InvalidInput when the file is none of ours, damaged or of another run, when it cannot be written, or when
  // another process works on it.
  TraceStore(std::filesystem::path file, double seconds_between_writes, TraceIdentity run);

  // What the job goes on from; new unless the file has a section of this name. Throws InvalidInput when that is of
  // another job, or when there is not the memory for its sums.
  TraceSection& section(const std::string& name, const TraceJob& job);
  // What the file says of an estimator, before its job is made; none if it has no such.
  const TraceIdentity* identity(const std::string& name);

  // Writes the file, if there is one. What went wrong is kept for failure(), as the run may go on and the next write
  // succeed.
  void write();
  void writeIfDue();                                       // if the last time is longer ago than asked for
  const std::string& failure() const { return failure_; }  // of the last write; empty if it succeeded

 private:
  std::filesystem::path path_;
  double seconds_between_ = 0.;
  std::unique_ptr<TraceLock> lock_;
  TraceFile file_;
  std::chrono::steady_clock::time_point written_ = std::chrono::steady_clock::now();
  std::string failure_;
};

}  // namespace sunfleck
