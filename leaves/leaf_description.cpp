#include "leaves/leaf_description.hpp"

#include "leaves/measured_leaves.hpp"
#include "leaves/prospect.hpp"
#include "leaves/slab_leaf.hpp"

namespace sunfleck {
namespace {

struct Follow {
  const LightBands& bands;
  const BandOptics& given;

  BandOptics operator()(const LeafByNumbers&) const { return given; }
  BandOptics operator()(const LeafByContents& leaf) const {
    if (!leaf.species.empty()) measuredLeaf(leaf.species);
    return bandOptics(prospect(leaf.contents), bands);
  }
  BandOptics operator()(const LeafByTissue& leaf) const {
    BandOptics optics;
    for (int band = 0; band < kBands; ++band)
      optics[static_cast<std::size_t>(band)] = leafOptics(slabLeaf({.absorption = double{leaf.absorption[band]},
                                                                    .scattering = double{leaf.scattering[band]},
                                                                    .thickness = leaf.thickness})
                                                              .sides);
    return optics;
  }
};

}  // namespace

LeafByContents leafOfSpecies(const std::string& species) {
  return {.species = species, .contents = measuredLeaf(species).contents};
}

BandOptics bandOptics(const LeafDescription& leaf, const LightBands& bands, const BandOptics& given) {
  const BandOptics follows = std::visit(Follow{bands, given}, leaf);
  BandOptics optics = given;
  for (std::size_t band = 0; band < kBands; ++band) {
    optics[band].reflectance = follows[band].reflectance;
    optics[band].transmittance = follows[band].transmittance;
  }
  return optics;
}

}  // namespace sunfleck
