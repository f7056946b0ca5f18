#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>

namespace sunfleck::apps {

// Whether mpirun, or srun with an MPI plugin, started this process, by what they tell it in its environment. MPI itself
// can only be asked once it has been started, which takes a tenth of a second.
inline bool startedByMpi() {
  constexpr std::array names{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
  return std::any_of(names.begin(), names.end(), [](const char* name) { return std::getenv(name) != nullptr; });
}

}  // namespace sunfleck::apps
