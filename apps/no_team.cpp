#include <cstdlib>
#include <string>

#include "apps/started_by_mpi.hpp"
#include "apps/team.hpp"
#include "core/require.hpp"

namespace sunfleck::apps {

std::unique_ptr<Team> joinTeam() {
  const char* size = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (startedByMpi() && !(size && std::string(size) == "1"))
    throw InvalidInput("started by MPI: must be built with it: install libopenmpi-dev and build anew");
  return nullptr;
}

}  // namespace sunfleck::apps
