#include "leaves/slab_leaf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/require.hpp"
#include "pp_solver/slab_batch.hpp"
#include "pp_solver/solver.hpp"

namespace sunfleck {
namespace {

constexpr int kStreams = 32, kMapStreams = 16;
constexpr double kThinnest = 1e-12;  // optical thickness below which light passes as if there were nothing
constexpr double kLeastTransmittance = 1e-4;
constexpr int kMostRounds = 100;
constexpr double kNearEnough = 1e-9;  // of reflectance and transmittance

// Absorption and scattering times thickness [1].
struct Optical {
  double absorbing = 0., scattering = 0.;
  double thickness() const { return absorbing + scattering; }
};

pp::SlabCase slabOf(const Optical& optical) {
  const double thickness = std::max(optical.thickness(), kThinnest);
  return {.asymmetry = 0., .albedo = std::min(optical.scattering / thickness, 1.), .thickness = thickness, .mu0 = 1.};
}

// Kubelka and Munk's two diffuse streams: S and K times thickness. For light that falls upright, sigma_s is about
// 4/3 S, and sigma_a lies between K / 2 and, without scattering, K.
Optical firstGuess(const LeafSides& sides) {
  const double r = sides.reflectance, t = sides.transmittance;
  const double d = std::sqrt(std::max((1. + r + t) * (1. + r - t) * (1. - r + t) * (1. - r - t), 0.));
  const double decay = std::asinh(0.5 * d / t);
  const double per_decay = d > 0. ? decay / d : 0.5 / t;
  return {.absorbing = 0.6 * d * decay / (2. * r + 1. + r * r - t * t + 1e-300), .scattering = 8. / 3. * r * per_decay};
}

// One place of a map on its way to the tissue.
struct Search {
  Optical at;                                 // to be tried
  Optical best;                               // nearest so far ...
  LeafSides of_best;                          // ... which reflects and lets through this ...
  double residual = 2.;                       // ... and is off by so much
  double ra = 0., rs = 0., ta = 0., ts = 0.;  // slopes of R and T by absorption and scattering
  bool fresh = false;                         // slopes are those at the best, not carried there from elsewhere
  bool ask_slopes = true;                     // try two places beside `at`, too

  // What the slab that was tried, and those beside it if slopes were asked for, send back and let through.
  void take(const LeafSides& measured, const pp::SlabFluxes* flux);

 private:
  void step(const LeafSides& measured);
};

double beside(const Optical& at) {
  return 1e-6 * at.thickness() + 1e-9;
}

void Search::take(const LeafSides& measured, const pp::SlabFluxes* flux) {
  const double r = flux[0].reflectance, t = flux[0].transmittance;
  const double off = std::max(std::abs(measured.reflectance - r), std::abs(measured.transmittance - t));
  if (ask_slopes) {
    const double h = beside(at);
    ra = (flux[1].reflectance - r) / h;
    rs = (flux[2].reflectance - r) / h;
    ta = (flux[1].transmittance - t) / h;
    ts = (flux[2].transmittance - t) / h;
  } else if (off < residual) {
    // Broyden 1965: the slopes that differ least from those before and explain what the step has brought.
    const double a = at.absorbing - best.absorbing, s = at.scattering - best.scattering, length2 = a * a + s * s;
    const double r_left = (r - of_best.reflectance - ra * a - rs * s) / length2;
    const double t_left = (t - of_best.transmittance - ta * a - ts * s) / length2;
    ra += r_left * a;
    rs += r_left * s;
    ta += t_left * a;
    ts += t_left * s;
  }
  if (ask_slopes || off < residual) {
    best = at;
    of_best = {.reflectance = r, .transmittance = t};
    residual = off;
    fresh = ask_slopes;
    ask_slopes = false;
    step(measured);
  } else if (fresh) {
    at = {.absorbing = 0.5 * (best.absorbing + at.absorbing), .scattering = 0.5 * (best.scattering + at.scattering)};
  } else {
    at = best;
    ask_slopes = true;
  }
}

// Newton's step. Neither coefficient becomes less than a tenth of what it was: both are positive.
void Search::step(const LeafSides& measured) {
  const double dr = measured.reflectance - of_best.reflectance, dt = measured.transmittance - of_best.transmittance;
  const double determinant = ra * ts - rs * ta;
  if (determinant == 0. || !std::isfinite(determinant)) {
    ask_slopes = !fresh;
    return;
  }
  at = {.absorbing = std::max(best.absorbing + (dr * ts - rs * dt) / determinant, 0.1 * best.absorbing),
        .scattering = std::max(best.scattering + (ra * dt - dr * ta) / determinant, 0.1 * best.scattering)};
}

}  // namespace

void validate(const LeafTissue& tissue, const std::string& where) {
  require(tissue.absorption >= 0. && tissue.absorption <= 1e6, where + "absorption", tissue.absorption,
          "in [0, 1e6] 1/mm");
  require(tissue.scattering >= 0. && tissue.scattering <= 1e6, where + "scattering", tissue.scattering,
          "in [0, 1e6] 1/mm");
  require(tissue.thickness >= 0. && tissue.thickness <= 1000., where + "thickness", tissue.thickness,
          "in [0, 1000] mm");
}

SlabLeaf slabLeaf(const LeafTissue& tissue) {
  validate(tissue);
  const Optical optical{.absorbing = tissue.absorption * tissue.thickness,
                        .scattering = tissue.scattering * tissue.thickness};
  SlabLeaf leaf;
  leaf.direct = std::exp(-optical.thickness());
  if (optical.thickness() < kThinnest) {
    leaf.sides.transmittance = 1.;
    return leaf;
  }
  const pp::SlabCase slab = slabOf(optical);
  pp::Solver solver({.streams = kStreams});
  solver.solve({.layers = {{.thickness = slab.thickness, .medium = Particles{.albedo = slab.albedo, .phase = {}}}},
                .beam = pp::Beam{}});
  leaf.sides.reflectance = std::clamp(solver.reflectance(), 0., 1.);
  leaf.sides.transmittance = std::clamp(solver.transmittance(), 0., 1. - leaf.sides.reflectance);
  leaf.absorptance = solver.absorptance();
  if (slab.albedo > 0.) {
    leaf.a = 2. * leaf.sides.reflectance / slab.albedo;
    leaf.b = 2. * std::max(leaf.sides.transmittance - leaf.direct, 0.) / slab.albedo;
  }
  return leaf;
}

std::vector<TissueFit> tissueOf(std::span<const LeafSides> measured, double thickness) {
  require(thickness > 0. && thickness <= 1000., "thickness", thickness, "above 0, at most 1000 mm");
  std::vector<Search> searches(measured.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const auto& [reflectance, transmittance] = measured[i];
    const auto name = [&](const char* of) { return measured.size() > 1 ? fmt::format("{} at {}", of, i) : of; };
    require(reflectance >= 0. && reflectance <= 1., name("reflectance"), reflectance, "in [0, 1]");
    require(transmittance >= kLeastTransmittance && transmittance <= 1., name("transmittance"), transmittance,
            "in [1e-4, 1]");
    require(reflectance + transmittance <= 1. + 1e-12, name("reflectance + transmittance"), reflectance + transmittance,
            "at most 1");
    searches[i].at = firstGuess(measured[i]);
  }
  // All places at once. Slopes cost two slabs more: they are computed where a search begins, and again where those that
  // were carried along lead nowhere.
  std::vector<std::size_t> active(measured.size());
  std::iota(active.begin(), active.end(), std::size_t{0});
  std::vector<pp::SlabCase> slabs;
  std::vector<pp::SlabFluxes> fluxes;
  for (int round = 0; round < kMostRounds && !active.empty(); ++round) {
    slabs.clear();
    for (const std::size_t i : active) {
      const Optical& at = searches[i].at;
      slabs.push_back(slabOf(at));
      if (!searches[i].ask_slopes) continue;
      slabs.push_back(slabOf({.absorbing = at.absorbing + beside(at), .scattering = at.scattering}));
      slabs.push_back(slabOf({.absorbing = at.absorbing, .scattering = at.scattering + beside(at)}));
    }
    fluxes.resize(slabs.size());
    pp::solveSlabs(slabs, fluxes, kMapStreams);
    const pp::SlabFluxes* flux = fluxes.data();
    std::erase_if(active, [&](std::size_t i) {
      const int used = searches[i].ask_slopes ? 3 : 1;
      searches[i].take(measured[i], flux);
      flux += used;
      return searches[i].residual <= kNearEnough;
    });
  }
  std::vector<TissueFit> fits(measured.size());
  for (std::size_t i = 0; i < measured.size(); ++i)
    fits[i] = {.tissue = {.absorption = searches[i].best.absorbing / thickness,
                          .scattering = searches[i].best.scattering / thickness,
                          .thickness = thickness},
               .residual = searches[i].residual};
  return fits;
}

}  // namespace sunfleck
