#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <string>

#include "render/reference/trace_job.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// What one estimator of a run has found, and what tells it from others.
struct TraceSection {
  std::string name;  // "light", "picture", ...
  TraceIdentity identity;
  TraceSums sums;
  std::uint64_t asked = 0;  // units of the whole that this run is, or is a part of; 0 if not told
  // What the run was about to compute when the file was written, and towards which goal: decisions that rest on what
  // had been found by then are not made anew, so that an interrupted run goes the same way as one that was not.
  UnitRanges planned{};
  std::string plan_of{};
};

// A trace file, .trace: the state of a run, from which it goes on as if it had never been interrupted. Written whole or
// not at all: the file before stays until the new one is on the disk. A text header names everything; sums are whole
// numbers; a CRC-32 ends the file.
struct TraceFile {
  TraceIdentity run;                  // what all its sections are of: the program's version, the scene
  std::deque<TraceSection> sections;  // a section stays where it is when others are added

  TraceSection* find(const std::string& name);
};

void writeTraceFile(const std::filesystem::path& path, const TraceFile& file);

// Throws InvalidInput("<path>: ...") on a file that is none, is damaged or of another version of the format.
TraceFile readTraceFile(const std::filesystem::path& path);

// Adds what `part`, read from `path`, has found to `whole`. Throws InvalidInput when it is of another run or holds
// units that are there already.
void addPart(TraceFile& whole, const TraceFile& part, const std::filesystem::path& path);

// Units [0, asked) that a section has not, of the seeds that it has some of.
std::map<std::uint64_t, UnitRanges> missingUnits(const TraceSection& section);

// Throws InvalidInput("<path>: made with <name> = <value>: must be <expected>") at the first difference.
void requireSame(const std::filesystem::path& path, const TraceIdentity& found, const TraceIdentity& expected);

}  // namespace sunfleck
