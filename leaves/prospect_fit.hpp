#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "leaves/leaf_contents.hpp"

namespace sunfleck {

// A measured leaf.
struct MeasuredSpectrum {
  std::vector<double> wavelengths;    // [nm], 400 .. 2500, in any order
  std::vector<double> reflectance;    // [1], -0.1 .. 1.1, as many; or none
  std::vector<double> transmittance;  // the same; one of both must be there
};

struct ProspectFitSettings {
  bool parts = false;                                // protein and carbon-based constituents in place of dry matter
  std::vector<std::pair<std::string, double>> held;  // contents that are known, by name
};

struct FittedContent {
  const LeafContent* content = nullptr;
  enum class State {
    found,     // with a standard error
    at_limit,  // would go on where its range (up to `usual_high`) ends
    unseen,    // hardly changes these data: left at its start; or not apart from others: its error is beyond its range
    held
  } state = State::found;
  double value = 0.;
  double standard_error = 0.;  // of one that was found, else 0
};

struct ProspectFit {
  LeafContents contents;
  std::vector<FittedContent> each;                             // of the contents that this kind of leaf has
  double rmse = 0.;                                            // of reflectance and transmittance together [1]
  std::optional<double> rmse_reflectance, rmse_transmittance;  // of what was measured
  int iterations = 0;
  bool converged = false;
};

// (L7) The leaf of PROSPECT nearest to what was measured. Standard errors are those of independent errors of the data
// as large as what remains; errors of the model itself are not independent and not among them. Throws InvalidInput on
// data out of their range, fewer data than contents to find, and contents that are held twice or out of range.
ProspectFit fitProspect(const MeasuredSpectrum& measured, const ProspectFitSettings& settings = {});

}  // namespace sunfleck
