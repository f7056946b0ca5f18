#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/progress.hpp"
#include "grid/density_grid.hpp"

namespace sunfleck {

// A program that reads a file for this one, and what it may take.
struct IsolatedReader {
  std::string program = "/proc/self/exe";  // called as: program read-grid FILE OUTPUT BYTES SECONDS
  std::uint64_t bytes = 0;                 // of memory; 0: what the system can give, 8 GiB at most
  double seconds = 0.;                     // 0: a minute, and a second for each megabyte of the file
};

// DensityGrid::read() for files from outside, in a process of its own: whatever a file makes of OpenVDB and of the
// libraries that unpack it ends there. What comes back is our own .vdb file in memory, of values that have been
// checked, and is checked again. Throws InvalidInput as DensityGrid::read() does, and also when reading crashed or took
// more than the limits; std::runtime_error("interrupted") when `progress` says to stop.
DensityGrid readIsolated(const std::filesystem::path& file, const Progress& progress = {},
                         const IsolatedReader& reader = {});

// The reader's side: reads the grids of `file` and writes them over `output` within the limits, which hold for the
// whole process from then on. What is wrong is told on stderr. Returns the process's exit status: 0 done, 2 wrong
// input, 1 anything else. Under a sanitizer, which reserves address space without bound, memory is not limited.
int serveIsolatedRead(const std::filesystem::path& file, const std::filesystem::path& output, std::uint64_t bytes,
                      std::uint64_t seconds);

}  // namespace sunfleck
