#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

// A witness of pp_solver's: adding and doubling of layers (van de Hulst 1980; Hansen & Travis 1974), which has neither
// eigenvalues nor particular solutions nor delta-M, on a quadrature of its own.
namespace sunfleck::witness {

struct ScatteringLayer {
  double thickness = 1.;        // optical [1], above 0, finite
  double albedo = 0.;           // [1], 0 .. 1
  std::vector<double> moments;  // chi_l of the phase function, chi_0 = 1; those not listed are 0
};

// chi_l = g^l as far as they reach `smallest`.
std::vector<double> henyeyGreensteinMoments(double asymmetry, double smallest = 1e-13);

// What a layer does with the light that meets it, in one azimuth mode m. Light is told by kernels k(mu, mu') between
// nodes, with I(mu) = integral of k(mu, mu') I'(mu') 2 mu' dmu'; a beam of irradiance F on a plane that faces it makes
//   I(mu, phi) = mu0 F / pi sum over m of (2 - [m = 0]) k_m(mu, mu0) cos(m (phi - phi0)).
// Unscattered light, in `direct`, is not part of the kernels.
struct LayerKernels {
  Eigen::ArrayXd direct;                      // e^(-thickness / mu)
  Eigen::MatrixXd reflection, reflection_up;  // of light from above, from below
  Eigen::MatrixXd transmission, transmission_up;
};

// Light between two layers that is lit from above.
struct Interface {
  Eigen::MatrixXd down, up;  // diffuse
};

class AddingDoubling {
 public:
  // Gauss's nodes x in (0, 1) with mu = x^2, which gathers nodes where radiance has a logarithm, at mu = 0; exact for
  // Legendre moments below `nodes`. `extra` cosines in (0, 1] are nodes of weight 0: beams and lines of sight.
  AddingDoubling(int nodes, std::span<const double> extra);

  // Doubles from a thickness of 2^-50 or less, where light scatters once. The diffuse part is kept apart from the
  // direct one, so that every term of the mode 0 is positive and nothing cancels: errors stay relative to the diffuse
  // light.
  LayerKernels layer(const ScatteringLayer& layer, int mode) const;
  LayerKernels lambertianGround(double albedo, int mode) const;

  LayerKernels add(const LayerKernels& above, const LayerKernels& below) const;
  Interface between(const LayerKernels& above, const LayerKernels& below) const;

  int extraNode(int index) const { return nodes_ + index; }      // its row and column in the kernels
  double flux(const Eigen::MatrixXd& kernel, int column) const;  // integral of k(mu, mu') 2 mu dmu
  double flux(const Eigen::MatrixXd& kernel) const;              // the same, integrated over 2 mu' dmu' too

 private:
  Eigen::MatrixXd phaseMatrix(const std::vector<double>& moments, int mode, bool back) const;
  std::pair<Eigen::MatrixXd, Eigen::MatrixXd> litFromAbove(const LayerKernels& above, const LayerKernels& below) const;

  int nodes_;
  Eigen::ArrayXd cosines_, weights_;  // weights 2 mu dmu
};

// Layers from the top down on a Lambertian ground, under a beam of irradiance 1 on a plane that faces it.
struct Stack {
  std::vector<ScatteringLayer> layers;
  double ground_albedo = 0.;
};

struct StackFluxes {
  double reflectance,
      transmittance;  // over the flux that arrives [1]; transmittance: down at the ground, with the beam
};
StackFluxes stackFluxes(const Stack& stack, double mu0, int nodes);

// Diffuse radiance, result[i * phis.size() + j] at |cos| mus[i] and azimuth phis[j] of travel, that of the beam being
// 0.
struct StackRadiances {
  std::vector<double> up_at_top, down_at_bottom;
};
StackRadiances stackRadiances(const Stack& stack, double mu0, std::span<const double> mus, std::span<const double> phis,
                              int nodes);

}  // namespace sunfleck::witness
