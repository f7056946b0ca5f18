#pragma once

#include <chrono>
#include <filesystem>
#include <memory>

#include "render/reference/trace_file.hpp"

namespace sunfleck {

// Where a run keeps its sums: in memory or also in a trace file, which is read when it is there and written from time
// to time, so that a run that is killed loses little and goes on from it to the same bits.
class TraceStore {
 public:
  TraceStore();
  // Throws InvalidInput when the file is none of ours or damaged, when it cannot be written, or when another process
  // works on it.
  //   run  what tells all its sections from those of other runs: the program's version, the scene
  TraceStore(std::filesystem::path file, double seconds_between_writes, TraceIdentity run);
  ~TraceStore();
  TraceStore(TraceStore&&) noexcept;
  TraceStore& operator=(TraceStore&&) noexcept;

  // What the job goes on from; new unless the file has a section of this name. Throws InvalidInput when that is of
  // another job or another `run`.
  TraceSection& section(const std::string& name, const TraceJob& job);
  // What the file says of an estimator, before its job is made; none if it has no such.
  const TraceIdentity* identity(const std::string& name) const;

  void write();       // nothing without a file
  void writeIfDue();  // if the last time is longer ago than asked for

 private:
  class Lock;

  std::filesystem::path file_;
  double seconds_between_ = 0.;
  TraceIdentity run_;
  std::unique_ptr<Lock> lock_;
  TraceSections sections_;
  std::chrono::steady_clock::time_point written_ = std::chrono::steady_clock::now();
};

}  // namespace sunfleck
