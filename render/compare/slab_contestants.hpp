#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "pp_solver/slab_batch.hpp"
#include "render/compare/sphere_rule.hpp"
#include "spp/slab_tiers.hpp"

namespace sunfleck {

// The slabs on which run time and error are compared: isotropic and forward scattering, thin to thick, the beam upright
// and at 60 degrees; five depths of each from face to face, and 72 directions at each.
struct SlabCourse {
  std::vector<pp::SlabCase> slabs;
  std::vector<double> shares;  // depths over the thickness
  SphereRule sphere;
  std::size_t places() const { return slabs.size() * shares.size(); }
};
SlabCourse slabCourse();

// A way of computing the light in the slabs of a course, all that it may know beforehand at hand.
class SlabContestant {
 public:
  explicit SlabContestant(const SlabCourse& course) : course_(course) {}
  virtual ~SlabContestant() = default;

  // Light at all places of the course, slab after slab: for its error.
  struct Answer {
    std::vector<double> powers;              // P+ + P-, direct light included
    std::vector<double> flux_down, flux_up;  // relative to what arrives; empty where the contestant has none
    std::vector<double> radiances;           // of each place in each direction [1/sr]
  };
  virtual Answer answer() = 0;

  // The work that is timed: evaluations at one depth, of P+ and P-, or of radiance in one direction. Returns how many.
  virtual std::size_t evaluatePowers() = 0;
  virtual std::size_t evaluateRadiances() = 0;
  // Of the fluxes at the faces of one of many slabs that are solved together, on one thread. 0: cannot.
  virtual std::size_t evaluateBatch() { return 0; }

 protected:
  const SlabCourse& course_;
  volatile double kept_ = 0.;  // where results go, lest the compiler leaves out the work
};

struct NamedContestant {
  enum class Kind { kTier, kTable, kExact };
  std::string name;
  Kind kind;
  int streams = 0;         // of each half of a closed form; N of the exact solver
  int azimuth_orders = 0;  // of a closed form with streams
  std::size_t bytes = 0;   // of a table of one medium
  bool own_powers = true;  // no earlier contestant has the same
  std::unique_ptr<SlabContestant> contestant;
};

// All tiers but direct light alone, in single precision; tables of two sizes; the exact solver with N = 4, 8 ... 64.
// Tables take a while to make; ended early by `progress`: an empty list.
std::vector<NamedContestant> slabContestants(const SlabCourse& course, const Progress& progress = {});
std::unique_ptr<SlabContestant> tierContestant(const SlabCourse& course, const spp::SlabTier& tier);  // not SS
std::unique_ptr<SlabContestant> exactContestant(const SlabCourse& course, int streams);

}  // namespace sunfleck
