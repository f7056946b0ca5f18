#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/sweep_task.hpp"
#include "core/progress.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/scene.hpp"
#include "render/stand_field.hpp"
#include "render/stand_geometry.hpp"

namespace sunfleck::apps {

// A row of a sweep's table before it is computed.
struct SweepRow {
  std::string key;     // a hash of all that its figures follow from
  std::string inputs;  // its first columns
};

// Names of the columns of a table, those of inputs first.
std::string sweepHeader();

// A scene of a sweep, made ready once for all its tasks.
class SweepScene {
 public:
  // `sweep` outlives it. Throws InvalidInput on a scene that is wrong.
  SweepScene(const SweepFile& sweep, std::size_t scene, std::uint64_t seed);

  // The rows of a task of this scene: for each optics Monte Carlo, if asked for, and each model. Throws InvalidInput on
  // what cannot be computed.
  std::vector<SweepRow> rows(const SweepTask& task) const;
  // The figures of these rows, the columns after the inputs; none when `progress` ended it.
  std::optional<std::vector<std::string>> figures(const SweepTask& task, int threads, const Progress& progress);

  // A guess of what a task takes, from some paths of it: seconds of one processor [s].
  double guessedSeconds(const SweepTask& task) const;

 private:
  Scene sceneOf(const SweepTask& task, const SweepOptics& optics) const;
  ForwardJob jobOf(const SweepTask& task) const;
  std::uint64_t pathsPerUnit() const;
  std::vector<float> fieldIrradiance(Scene scene, int band, const Progress& progress);

  const SweepFile& sweep_;
  std::string name_;
  std::uint64_t seed_;
  Scene scene_;
  std::string identity_;  // of the scene, the program and the effort
  RayScene rays_;
  StandGeometry stand_;
  std::vector<std::shared_ptr<const TreeMesh>> field_meshes_;  // with wood or without, as the rays
  StandField field_;
};

}  // namespace sunfleck::apps
