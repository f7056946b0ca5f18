#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "spp/stream_constants.hpp"

// Random places in random slabs, most of them in corners where closed forms break: thickness 0, 1e-30 to 1e30 and
// infinite, depths on and beside the faces; albedo 0, 1 and the numbers beside 1; |g| to .999; mu0 to 1e-7; beams and
// lines of sight in resonance with a mode and beside it.
namespace sunfleck::stress {

enum Form { kSpp, kSppModes, kTwoStream, kNStream1, kNStream2, kNStream3, kNStream4, kNStream8, kForms };
inline constexpr const char* kFormNames[kForms] = {"spp",       "spp_modes", "twostream", "nstream_1",
                                                   "nstream_2", "nstream_3", "nstream_4", "nstream_8"};

// Of one form, in one medium under one beam, seen along one line of sight.
struct StressPlaces {
  Form form = kSpp;
  double asymmetry = 0., albedo = 0., mu0 = 0.5;  // g, omega [1]
  int orders = 1;                                 // of the azimuth
  double mu = 1., azimuth = 0.;                   // of the line of sight [1], [rad]
  std::vector<float> depth, thickness;            // of each place [1]

  int streams() const {
    constexpr int kStreams[kForms] = {1, 1, 1, 1, 2, 3, 4, 8};
    return kStreams[form];
  }
  float forwardShare() const;              // T of (S2), of kSpp
  spp::StreamConstants constants() const;  // of all other forms
};

// A function of (seed, index) and, in the number of places, of count.
StressPlaces drawPlaces(std::uint64_t seed, std::uint64_t index, std::size_t count);

struct StressLight {
  double down = 0., up = 0., radiance = 0.;  // P+, P- [F]; diffuse radiance along the line of sight [1/sr]
};

// At each place in double precision by the same formulas; what single precision knows of kSpp's beam and medium.
std::vector<StressLight> exactLight(const StressPlaces& places);

// Absolute for light of power 1; radiance above 1, which strong forward scattering has, is held relative to itself.
StressLight lightError(const StressLight& found, const StressLight& exact);

// All values of one place, to all digits.
std::string describe(const StressPlaces& places, std::size_t place);

}  // namespace sunfleck::stress
