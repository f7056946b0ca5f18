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
  TraceStore(std::filesystem::path file, double seconds_between_writes);
  ~TraceStore();

  // The sums that the job goes on from; new ones unless the file has some under this name. Throws InvalidInput when
  // those are of another job.
  TraceSums& sums(const std::string& name, const TraceJob& job);
  // What the file says of an estimator, before its job is made; none if it has no such.
  const TraceIdentity* identity(const std::string& name) const;

  void write();       // nothing without a file
  void writeIfDue();  // if the last time is longer ago than asked for

 private:
  class Lock;

  std::filesystem::path file_;
  double seconds_between_ = 0.;
  std::unique_ptr<Lock> lock_;
  TraceSections sections_;
  std::chrono::steady_clock::time_point written_ = std::chrono::steady_clock::now();
};

}  // namespace sunfleck
