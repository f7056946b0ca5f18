#include "render/compare/machine_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <thread>

namespace sunfleck {

std::string machineName() {
  std::ifstream about("/proc/cpuinfo");
  std::string name = "unknown processor";
  for (std::string line; std::getline(about, line);)
    if (line.starts_with("model name")) {
      name = line.substr(std::min(line.size(), line.find(':') + 2));
      break;
    }
  return fmt::format("{}, {} threads", name, std::thread::hardware_concurrency());
}

}  // namespace sunfleck
