#include "grid/detail/available_memory.hpp"

#include <algorithm>
#include <fstream>
#include <string>

namespace sunfleck {

double availableMemory() {
  constexpr double most = 0x1p33;
  std::ifstream in("/proc/meminfo");
  for (std::string word; in >> word;)
    if (double kibibytes = 0.; word == "MemAvailable:" && in >> kibibytes) return std::min(most, kibibytes * 1024.);
  return most;
}

}  // namespace sunfleck
