#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "render/reference/trace_effort.hpp"
#include "render/scene.hpp"
#include "render/stand_geometry.hpp"

namespace sunfleck {

// A way to compute the irradiance of a scene's leaves, to be timed and judged. Its answers are as (R7) tells them: of
// each leaf of the prototypes, both sides together, the mean over the stand's trees of the kind [1].
class SceneContestant {
 public:
  virtual ~SceneContestant() = default;

  // With nothing at hand but the meshes. The methods of a round, if they have random numbers, have others in another.
  virtual std::vector<float> fromNothing(int round, const Progress& progress) = 0;
  // Forgets what hangs on where the sun stands, by looking at another. Not timed.
  virtual void turnAway(const Progress& progress) = 0;
  // After that: with what does not hang on the sun at hand.
  virtual std::vector<float> sunTurned(int round, const Progress& progress) = 0;
};

struct NamedSceneContestant {
  std::string method;   // "ss", "sppg" ..., "monte_carlo"
  double setting = 0.;  // what it is computed with: axes of lines of the field, cells along a tree
                        // of the grid alone, or of the stand's,
                        // paths of Monte Carlo; 0: no choice
  double work = 1.;     // share of a round's time, roughly, for progress
  std::unique_ptr<SceneContestant> contestant;
};

// The models, the field with several numbers of axes, the same on cells alone, of several trees each by itself in the
// light of the others in cells, and Monte Carlo, which does not know the random numbers of seed `trace.seed` itself.
//   scene  must outlive them
//   paths  of Monte Carlo, of each contestant; each at least kLeastUnits
std::vector<NamedSceneContestant> sceneContestants(const Scene& scene, const std::vector<Model>& models,
                                                   const GeometryEffort& geometry,
                                                   const std::vector<std::uint64_t>& paths, const TraceEffort& trace,
                                                   int band, bool with_wood);

}  // namespace sunfleck
