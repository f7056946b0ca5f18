#include "pp_solver/detail/leaf_layer.hpp"

namespace sunfleck::pp::detail {
namespace {

constexpr double kAnyDirection[] = {1.};

}  // namespace

LeafTables::LeafTables(const LeafAngles& angles, const std::vector<double>& mu, const std::vector<double>& weight)
    : nodes_(angles, mu, weight), beam_(angles, kAnyDirection), views_(angles, kAnyDirection) {}

void LeafTables::setBeam(double mu0) {
  if (beam_.mu(0) != mu0) beam_ = LeafProjections(angles(), std::span(&mu0, 1));
}

void LeafTables::setViews(std::span<const double> cosines) {
  bool same = views_.size() == cosines.size();
  for (std::size_t i = 0; same && i < cosines.size(); ++i) same = views_.mu(i) == cosines[i];
  if (!same) views_ = LeafProjections(angles(), cosines);
}

std::size_t LeafTables::viewAt(double mu) const {
  std::size_t i = 0;
  while (views_.mu(i) != mu) ++i;
  return i;
}

void LeafTables::setMode(int mode) {
  nodes_.setMode(mode);
  beam_.setMode(mode);
  views_.setMode(mode);
}

const LeafKernel& LeafTables::betweenNodes(int mode) {
  const auto found = between_nodes_.find(mode);
  if (found != between_nodes_.end()) return found->second;
  setMode(mode);
  LeafKernel& kernel = between_nodes_[mode];
  fillLeafKernel(nodes_, nodes_, kernel);
  return kernel;
}

const LeafKernel& LeafTables::fromBeam(int mode) {
  setMode(mode);
  fillLeafKernel(nodes_, beam_, from_beam_);
  return from_beam_;
}

const LeafKernel& LeafTables::intoViews(int mode) {
  setMode(mode);
  fillLeafKernel(views_, nodes_, into_views_);
  return into_views_;
}

const LeafKernel& LeafTables::beamIntoViews(int mode) {
  setMode(mode);
  fillLeafKernel(views_, beam_, beam_into_views_);
  return beam_into_views_;
}

}  // namespace sunfleck::pp::detail
