#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <variant>

#include "leaves/leaf_contents.hpp"
#include "leaves/light_bands.hpp"

namespace sunfleck {

// Reflectance and transmittance are told themselves.
struct LeafByNumbers {
  bool operator==(const LeafByNumbers&) const = default;
};

// A leaf of PROSPECT.
struct LeafByContents {
  std::string species;  // a measured one, from which the contents may differ; empty: none
  LeafContents contents;
  bool operator==(const LeafByContents&) const = default;
};

// An even slab that scatters isotropically.
struct LeafByTissue {
  glm::vec3 absorption{0.f};  // sigma_a, per band [1/mm], 0 .. 1e6
  glm::vec3 scattering{0.f};  // sigma_s, per band [1/mm], 0 .. 1e6
  double thickness = 0.2;     // h [mm], 0 .. 1000
  bool operator==(const LeafByTissue&) const = default;
};

// How the leaves of a scene are told.
using LeafDescription = std::variant<LeafByNumbers, LeafByContents, LeafByTissue>;

// The leaf of a measured species. Throws InvalidInput as measuredLeaf() does.
LeafByContents leafOfSpecies(const std::string& species);

// Reflectance and transmittance in each of the bands that follow from the description, by (L6) and (L4) or (L5), or by
// (L8); of leaves that are told by numbers, those of `given`, whose gloss all keep. Tissue is told per band, so that
// the bands do not matter to it. Throws InvalidInput on an unknown species and on what is out of its range.
BandOptics bandOptics(const LeafDescription& leaf, const LightBands& bands, const BandOptics& given);

}  // namespace sunfleck
