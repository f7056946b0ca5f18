#include "core/available_memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// The number after a word of a file, or without a word its first; `otherwise` where there is none.
double numberIn(const fs::path& file, const std::string& word, double otherwise) {
  std::ifstream in(file);
  for (std::string read; word.empty() || in >> read;)
    if (double number = 0.; word.empty() || read == word) return in >> number ? number : otherwise;
  return otherwise;
}

// What a group leaves, and all that it is in. What files have left in memory is given back on demand.
//   most, used, files  names of the figures in the group's folder
double leftBy(const fs::path& hierarchy, fs::path group, const char* most, const char* used, const char* files) {
  double left = kUnlimited;
  for (;; group = group.parent_path()) {
    const fs::path folder = hierarchy / group.relative_path();
    const double taken = numberIn(folder / used, "", 0.) - numberIn(folder / "memory.stat", files, 0.);
    left = std::min(left, numberIn(folder / most, "", kUnlimited) - std::max(taken, 0.));
    if (!group.has_relative_path()) return std::max(left, 0.);
  }
}

}  // namespace

double availableMemory(const fs::path& root) {
  double most = std::min(0x1p33, 1024. * numberIn(root / "proc/meminfo", "MemAvailable:", kUnlimited));
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {  // hierarchy:controllers:/group
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    std::string controllers(1, ',');
    controllers.append(line, first + 1, second - first - 1).push_back(',');
    const fs::path group = line.substr(second + 1), mounted = root / "sys/fs/cgroup";
    if (controllers == ",,")  // version 2
      most = std::min(most, leftBy(mounted, group, "memory.max", "memory.current", "inactive_file"));
    else if (controllers.find(",memory,") != std::string::npos)
      most = std::min(most, leftBy(mounted / "memory", group, "memory.limit_in_bytes", "memory.usage_in_bytes",
                                   "total_inactive_file"));
  }
  return most;
}

}  // namespace sunfleck
