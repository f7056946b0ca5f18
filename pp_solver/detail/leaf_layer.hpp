#pragma once

#include <map>
#include <span>
#include <vector>

#include "scattering/leaf_scattering.hpp"

namespace sunfleck::pp::detail {

// What leaves of one distribution scatter between ordinates, beam and views. None of it depends on their optics, so it
// is kept from one problem to the next.
class LeafTables {
 public:
  LeafTables(const LeafAngles& angles, const std::vector<double>& mu, const std::vector<double>& weight);

  const LeafAngles& angles() const { return nodes_.angles(); }
  const LeafProjections& nodes() const { return nodes_; }

  // The beam and the directions of view, by |cos|: rows of the tables below.
  void setBeam(double mu0);
  void setViews(std::span<const double> cosines);
  double beamProjection() const { return beam_.projection(0); }
  double viewProjection(double mu) const { return views_.projection(viewAt(mu)); }
  std::size_t viewAt(double mu) const;

  const LeafKernel& betweenNodes(int mode);
  const LeafKernel& fromBeam(int mode);   // to each node
  const LeafKernel& intoViews(int mode);  // from each node
  const LeafKernel& beamIntoViews(int mode);

 private:
  void setMode(int mode);
  LeafProjections nodes_, beam_, views_;
  std::map<int, LeafKernel> between_nodes_;
  LeafKernel from_beam_, into_views_, beam_into_views_;
};

}  // namespace sunfleck::pp::detail
