#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "core/progress.hpp"
#include "leaves/leaf_description.hpp"

namespace sunfleck {

// What places of one leaf reflect and let through, measured per band.
struct MeasuredLeafMaps {
  std::vector<glm::vec3> reflectance;        // rho_d of the upper side [1], 0 .. 1
  std::vector<glm::vec3> transmittance;      // rho_t [1], 0 .. 1; as many
  std::vector<glm::vec3> lower_reflectance;  // of the lower side [1], 0 .. 1; as many, or none
  std::vector<bool> on_leaf;                 // which of them are on the leaf; none: all
};

// The leaf behind them: tissue, and what varies over it.
struct LeafMapFit {
  LeafByTissue tissue;
  std::vector<glm::vec3> gamma, lower_gamma;  // [1], 0 .. 100; 1 off the leaf; of the upper in the mean 1
  std::vector<float> delta;                   // [mm], -h .. 3 h; 0 off the leaf; in the mean 0
  glm::dvec3 rms_transmittance{0.};           // of what remains, per band [1]; of reflectance nothing does
  std::size_t places = 0;                     // on the leaf
  std::size_t capped = 0;                     // of these, where a side reflects more than the leaf leaves over
  std::size_t at_limit = 0;                   // where the thickness ends at 0 or at 4 h
  int rounds = 0;
  bool converged = false;
};

// (L12) The tissue of a leaf of the mean thickness h [mm], 0.001 to 250, with gamma and delta of every place: delta
// by least squares of transmittance over the bands, gamma from what is reflected then, constants so that gamma is 1 in
// the mean and transmittance, but for what delta explains, as measured in the mean; in turns until no mean is off by
// 1e-6. The same to the bit for any number of threads. Throws InvalidInput on values out of range, none on the leaf,
// and a leaf that reflects nothing or lets nothing through in a band; std::runtime_error where it is not to go on. Some
// 2 s of two cores for 720 x 540 places.
LeafMapFit fitLeafMaps(const MeasuredLeafMaps& measured, double thickness, const Progress& progress = {});

}  // namespace sunfleck
