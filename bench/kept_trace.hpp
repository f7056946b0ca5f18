#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "render/reference/forward_trace.hpp"

namespace sunfleck {

// Monte Carlo of a stand of one kind of tree, with its wood, kept in a folder from one run of a program to the next: in
// a trace file whose name follows from mesh, places, light, optics and what the tracer finds in a small crown, so that
// a tracer that has changed traces anew. More paths than a file has are added to it; fewer are not asked for.
//   folder  empty: nothing is kept
// Throws InvalidInput as ForwardJob and TraceStore do.
std::vector<ForwardResult> keptTrace(const TreeMesh& mesh, const Stand& stand, const std::vector<TraceLight>& bands,
                                     std::uint64_t paths, const std::filesystem::path& folder);

}  // namespace sunfleck
