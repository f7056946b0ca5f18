#pragma once

#include <deque>
#include <filesystem>
#include <string>

#include "render/reference/trace_job.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// What one estimator of a run has found, and what tells it from others.
struct TraceSection {
  std::string name;  // "forward", "picture", ...
  TraceIdentity identity;
  TraceSums sums;
  // What the run was about to compute when the file was written: decisions that rest on what had been found by then are
  // not made anew, so that an interrupted run goes the same way as one that was not.
  UnitRanges planned{};
};

using TraceSections = std::deque<TraceSection>;  // a section stays where it is when others are added

// A trace file, .trace: the state of a run, from which it goes on as if it had never been interrupted. Written whole or
// not at all: the file before stays until the new one is on the disk. A text header names everything; sums are whole
// numbers; a CRC-32 ends the file.
void writeTraceFile(const std::filesystem::path& path, const TraceSections& sections);

// Throws InvalidInput("<path>: ...") on a file that is none, is damaged or of another version of the format.
TraceSections readTraceFile(const std::filesystem::path& path);

// Throws InvalidInput("<path>: made with <name> = <value>: must be <expected>") at the first difference.
void requireSame(const std::filesystem::path& path, const TraceIdentity& found, const TraceIdentity& expected);

}  // namespace sunfleck
