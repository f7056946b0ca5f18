#pragma once

#include <optional>
#include <string>
#include <vector>

#include "leaves/measured_leaves.hpp"
#include "leaves/prospect_fit.hpp"

namespace sunfleck::apps {

// What `sunfleck leaf` tells of one leaf.
struct LeafReport {
  std::string title;
  const MeasuredLeaf* species = nullptr;  // whose contents these are, unchanged; none: told or found
  LeafContents contents;
  LeafSpectrum spectrum;
  std::vector<WavelengthBand> bands;  // that were asked for
  std::optional<ProspectFit> fit;     // to this measurement:
  MeasuredSpectrum measured;
  std::size_t left_out = 0;  // rows of it outside of 400 .. 2500 nm
};

std::string leafText(const LeafReport& leaf);
std::string leafJson(const LeafReport& leaf);
std::string leafPlot(const LeafReport& leaf);       // SVG
std::string leafCsv(const LeafSpectrum& spectrum);  // wavelength_nm,reflectance,transmittance
std::string bandsCsv(const LeafReport& leaf);       // as trace --spectrum takes it

}  // namespace sunfleck::apps
