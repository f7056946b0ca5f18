#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "render/reference/trace_team.hpp"

namespace sunfleck::apps {

// The processes that mpirun started together. The exchanges between rank 0 and one other may go on in another thread
// than those of all.
class Team : public TraceTeam {
 public:
  // Threads of this process, if those of all on this machine are to share the cores that they may run on.
  virtual int fairThreads() const = 0;

  virtual void tellFirst(const std::string& text) = 0;                  // other ranks, to rank 0
  virtual std::string hearFirst() = 0;                                  // waits for what rank 0 has to say to this rank
  virtual std::optional<std::pair<int, std::string>> heard() = 0;       // rank 0: who has told it what, if anyone has
  virtual void answer(int rank, const std::string& text) = 0;           // rank 0, to another
  [[noreturn]] virtual void fail(int status, std::string message) = 0;  // tells it and ends all
};

// The team of this process, whose ranks but the first print nothing from then on; none when it was started alone.
// Throws InvalidInput when it was started with others but built without MPI.
std::unique_ptr<Team> joinTeam();

// Whether any rank of the team, if there is one, has been told to end: asked by all ranks at once.
bool interruptedAnywhere(Team* team);
// The sum of what all ranks give; for rank 0 alone.
double sumOverRanks(Team* team, double value);

}  // namespace sunfleck::apps
