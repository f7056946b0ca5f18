#pragma once

#include <map>
#include <memory>
#include <vector>

#include "pp_solver/detail/dense_modes.hpp"
#include "pp_solver/detail/kernel.hpp"
#include "pp_solver/detail/leaf_layer.hpp"
#include "pp_solver/detail/scaled_layer.hpp"
#include "pp_solver/solver.hpp"

namespace sunfleck::pp {

// What a Solver holds. A `bundle` is what the kernel solves at once: one azimuth mode, or as many as a vector has
// lanes.
struct Solver::State {
  Settings settings;
  int n;  // streams / 2
  std::shared_ptr<const Ordinates> ordinates;
  const detail::Kernel& kernel = detail::kernel();

  Problem problem;
  std::vector<detail::ScaledLayer> layers;
  bool solved = false, any_leaves = false;
  double depth = 0.;           // of the whole stack, true
  double mu0 = 1., beam = 0.;  // irradiance normal to the beam
  double incident = 0.;        // flux that arrives
  int modes_used = 0;

  // What the hot spot changes in the fluxes, over the flux that arrives (P11).
  struct HotSpot {
    double reflected = 0., transmitted = 0., absorbed = 0.;
    double again = 1.;  // factor on the reflected light of higher orders
  } hot_spot;
  bool hasHotSpot() const;
  void findHotSpot();

  detail::BasisRows basis;  // of mode 0 alone
  detail::StackRows stack;
  detail::RowMemory memory;
  double *u_row, *v_row;  // for fluxes at a depth

  std::vector<std::unique_ptr<detail::LeafTables>> leaf_tables;  // of each distribution so far
  std::vector<detail::LeafTables*> tables;                       // of each layer, or null

  std::map<int, std::unique_ptr<detail::BasisRows>> bundles;  // by first mode
  detail::StackRows bundle_stack;

  explicit State(const Settings& s);

  const detail::BasisRows& bundle(int first_mode);
  const detail::KernelPath& pathOf(const detail::BasisRows& rows) const {
    return rows.lanes > 1 ? kernel.wide : kernel.single;
  }

  // Fills `rows` with the modes of `basis_rows` and solves them. sine: the part of the light that goes with
  // sin m (phi - phi0) instead of cos.
  void solveBundle(const detail::BasisRows& basis_rows, detail::StackRows& rows, bool sine);

  // Azimuth mode m of diffuse light that arrives along mu, phi counted from the beam's azimuth.
  double skyMode(const Sky& sky, int m, double mu, bool sine) const;

  // dB/dz of a layer, by scaled depth (P14).
  static double planckSlope(const detail::LayerRows& row, int lane);

  // Attenuation of the beam as the scaled medium has it, at the top of layer `index` or at a depth within it.
  double scaledBeam(std::size_t index, double depth_in_layer = 0.) const;
  double trueBeam(double depth_below_top) const;
  double beamOnGround() const;  // flux, as the scaled medium has it

  // The layer at a depth, and the depth within it. The sum of all thicknesses, or what misses it by rounding, is the
  // bottom of the last layer.
  struct Place {
    std::size_t layer;
    double inside;
  };
  Place placeAt(double depth_below_top) const;

  // Forgets the tables that the next problem has no use for.
  void dropLeafTables(const Problem& next);

  // Finds or makes the tables of a layer of leaves, and G of the beam.
  void prepareLeaves(std::size_t index);

  // Extinction per scaled depth of light along mu, times mu: 1 for particles, G(mu) for leaves.
  double projectionOf(std::size_t index, double mu) const;

  // How light along mu is received by a layer whose modes are given at the nodes, rows over these; returns what the
  // kernel's answer is to be multiplied with.
  double nodeView(const detail::BasisRows& rows, std::size_t index, double mu, double* even, double* odd) const;

  // Source of the beam's first scattering into mu at the layer's top, downward and upward, in azimuth mode `lane`.
  void beamSource(const detail::BasisRows& rows, int lane, std::size_t index, double mu, double& down,
                  double& up) const;

  // E and O of particles between two directions in azimuth mode `lane`, from N moments.
  void directionKernel(const detail::BasisRows& rows, int lane, std::size_t index, double mu, double other,
                       double& even, double& odd) const;

  // Radiance that leaves the ground along mu, but for what `below` sends by itself and the beam by a BRDF.
  double groundRadiance(const detail::BasisRows& rows, const detail::StackRows& stack_rows, int lane, double mu,
                        bool sine) const;

 private:
  void fillLayer(const detail::BasisRows& basis_rows, detail::LayerRows& row, std::size_t index, bool sine);
  void fillDense(const detail::BasisRows& basis_rows, detail::LayerRows& row, std::size_t index, double amplitude);
  void fillShapedGround(const detail::BasisRows& basis_rows, detail::StackRows& rows, int lane, bool sine);
  void fillGround(const detail::BasisRows& basis_rows, detail::StackRows& rows, bool sine);
};

// Lambda_m^m(mu) of each lane.
double legendreStart(const detail::BasisRows& basis, int lane, double mu);

}  // namespace sunfleck::pp
