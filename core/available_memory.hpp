#pragma once

#include <filesystem>

namespace sunfleck {

// What grids may take [byte]: 8 GiB, or what the system can still give where that is less, and what the limits of the
// control groups leave that the process is in: those of a container or a batch system.
//   root  of the file system that tells it
double availableMemory(const std::filesystem::path& root = "/");

}  // namespace sunfleck
