#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// Processes that compute a run together, on one machine or on many. All of them make these calls in the same order;
// rank 0 decides.
class TraceTeam {
 public:
  virtual ~TraceTeam() = default;

  virtual int rank() const = 0;  // of this process, from 0
  virtual int size() const = 0;

  // What rank 0 gave, told to all.
  virtual std::string fromFirst(std::string text) = 0;
  // What each gave, by rank, told to rank 0; nothing to the others.
  virtual std::vector<std::string> toFirst(const std::string& text) = 0;
  // The bins of rank 0 become the sums of those of all ranks; of the others they are then good for nothing.
  virtual void sumToFirst(std::span<TraceSums::Bin> bins) = 0;
};

}  // namespace sunfleck
