#pragma once

#include "render/reference/trace_job.hpp"
#include "render/scene.hpp"

namespace sunfleck::apps {

// What tells the traces of this scene by this program from others, whatever they estimate.
TraceIdentity runIdentity(const Scene& scene, bool with_wood);

}  // namespace sunfleck::apps
