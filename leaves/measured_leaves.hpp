#pragma once

#include <string>
#include <vector>

#include "leaves/leaf_contents.hpp"
#include "leaves/leaf_spectrum.hpp"

namespace sunfleck {

// A species whose leaves were measured.
struct MeasuredLeaf {
  std::string name, title;
  std::string source;
  std::string caveat;                 // what is to be known of the measurement; may be empty
  std::vector<WavelengthBand> bands;  // at which the source tells ...
  std::vector<LeafSides> measured;    // ... what was measured
  LeafContents contents;              // of the PROSPECT-D leaf nearest to it over 420 to 2400 nm
  double fit_rmse = 0.;  // root mean square of that leaf's errors, reflectance and transmittance together [1]
};

// Those of leaves/data/measured_leaves.toml, which the program carries within it, sorted.
std::vector<std::string> measuredLeafNames();

// The species of that name. Throws InvalidInput("<where> = \"<name>\": must be ...") that lists the names.
const MeasuredLeaf& measuredLeaf(const std::string& name, const std::string& where = "leaf species");

}  // namespace sunfleck
