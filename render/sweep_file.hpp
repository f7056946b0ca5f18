#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/leaf_optics.hpp"
#include "render/model.hpp"

namespace sunfleck {

// What leaves, wood and ground do to light in one row of a sweep; what is not given is the scene's own.
struct SweepOptics {
  std::optional<LeafOptics> leaf;
  int band = 0;                                          // of the scene's own optics
  std::optional<float> wood_reflectance, ground_albedo;  // [1]
};

// Where the sun stands in a row of a sweep; what is not given is the scene's own.
struct SweepSun {
  std::optional<double> zenith_deg, azimuth_deg;
};

// A sweep: every scene under every sun with all optics, by every model.
struct SweepFile {
  std::filesystem::path path;
  std::vector<std::string> scenes;  // names of built-in ones, or files, as they are told
  std::vector<SweepSun> suns;
  std::vector<SweepOptics> optics;
  bool with_wood = true;      // whether wood stops light
  bool monte_carlo = true;    // whether its own figures are asked for
  std::vector<Model> models;  // to be held against Monte Carlo
  std::optional<double> paths, target;
  std::optional<std::uint64_t> seed;

  std::string sceneFile(std::size_t scene) const;  // where it is read from: beside the sweep
  // Rows of one scene, sun and optics.
  std::size_t rowsEach() const { return (monte_carlo ? 1 : 0) + models.size(); }
};

inline constexpr std::uint64_t kMostSweepRows = 1'000'000;

// Throws InvalidInput("<file>:<line>: ...") on anything that is no sweep, and on one of more rows than kMostSweepRows.
SweepFile readSweepFile(const std::filesystem::path& file);

// Every key, with its default.
std::string sweepFileHelp();

}  // namespace sunfleck
