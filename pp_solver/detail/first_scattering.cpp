#include "pp_solver/detail/first_scattering.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pp_solver/detail/table_axis.hpp"

namespace sunfleck::pp::detail {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<float> rounded(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

// Whether `phase` is Henyey and Greenstein's function of asymmetry g, to the bit.
bool isHenyeyGreenstein(const PhaseFunction& phase, double g) {
  if (!(std::abs(g) < 1.)) return false;
  const PhaseFunction other = PhaseFunction::henyeyGreenstein(g);
  for (int i = 0; i <= 16; ++i)
    if (phase(i / 8. - 1.) != other(i / 8. - 1.)) return false;
  return true;
}

void addLeafKernel(const LeafScattering& leaves, FirstScattering& first) {
  constexpr int n = FirstScattering::kDirections, modes = FirstScattering::kModes, samples = modes;
  std::vector<double> values(2 * n * n * modes, 0.);
  // Gamma is the same with both directions exchanged, whichever half they are in.
  tbb::parallel_for(0, n, [&](int i) {
    for (int j = 0; j <= i; ++j)
      for (int half = 0; half < 2; ++half) {
        const double mu = (half ? -1. : 1.) * std::max(cosineFrom(j / (n - 1.)), 1e-9);
        double* modes_of = values.data() + ((half * n + i) * n + j) * modes;
        for (int k = 0; k < samples; ++k) {
          const double azimuth = kPi * (k + 0.5) / samples,
                       value = leafScattering(leaves, mu, std::max(cosineFrom(i / (n - 1.)), 1e-9), azimuth);
          for (int m = 0; m < modes; ++m) modes_of[m] += (m ? 2. : 1.) / samples * value * std::cos(m * azimuth);
        }
      }
  });
  for (int half = 0; half < 2; ++half)
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < n; ++j)
        std::copy_n(values.data() + ((half * n + j) * n + i) * modes, modes,
                    values.data() + ((half * n + i) * n + j) * modes);
  values = splineCoefficients(values, 2, n, static_cast<std::size_t>(n) * modes);
  values = splineCoefficients(values, 2 * (n + 2), n, modes);
  first.kernel = rounded(values);
}

}  // namespace

// (P12)
FirstScattering FirstScattering::of(const Medium& medium) {
  FirstScattering first;
  if (const auto* leaves = std::get_if<LeafScattering>(&medium)) {
    first.kind = Kind::leaves;
    first.albedo = static_cast<float>(leaves->reflectance + leaves->transmittance);
    std::vector<double> projections(kProjections);
    for (int i = 0; i < kProjections; ++i)
      projections[i] = leafProjection(leaves->angles, cosineFrom(i / (kProjections - 1.)));
    first.projection = rounded(splineCoefficients(projections, 1, kProjections, 1));
    addLeafKernel(*leaves, first);
    return first;
  }
  const auto& particles = std::get<Particles>(medium);
  double moments[2];
  particles.phase.moments(moments);
  first.albedo = static_cast<float>(particles.albedo);
  const float most = std::nextafter(1.f, 0.f);  // below 1 in single precision too
  first.asymmetry = std::clamp(static_cast<float>(moments[1]), -most, most);
  if (isHenyeyGreenstein(particles.phase, moments[1])) return first;
  first.kind = Kind::angle;
  std::vector<double> values(kAngles);
  for (int i = 0; i < kAngles; ++i)
    values[i] = particles.albedo * particles.phase(std::clamp(std::cos(kPi * i / (kAngles - 1)), -1., 1.));
  first.phase = rounded(splineCoefficients(values, 1, kAngles, 1));
  return first;
}

float FirstScattering::into(float mu, float mu0, float cos_azimuth) const {
  if (kind == Kind::leaves) {
    constexpr int n = kDirections + 2;
    const SplineWeights in(cosineCoordinate(mu0), kDirections), out(cosineCoordinate(std::abs(mu)), kDirections);
    float modes[kModes] = {};
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const float weight = in.weight[i] * out.weight[j];
        const float* row = kernel.data() + (((mu < 0.f ? n : 0) + in.first + i) * n + out.first + j) * kModes;
        for (int m = 0; m < kModes; ++m) modes[m] += weight * row[m];
      }
    return std::max(0.f, cosineSeries(modes, kModes, cos_azimuth));
  }
  // |s - s0|^2 = 2 (1 - cosine), or |s + s0|^2 where the peak lies backward: neither cancels at its peak.
  const bool backward = kind == Kind::henyeyGreenstein && asymmetry < 0.f;
  const float sign = backward ? -1.f : 1.f, along = mu - sign * mu0;
  const float sine0 = std::sqrt((1.f - mu0) * (1.f + mu0)), sine = std::sqrt((1.f - mu) * (1.f + mu));
  const float square =
      (sine - sine0) * (sine - sine0) + along * along + 2.f * sine * sine0 * (1.f - sign * cos_azimuth);
  const float apart = within(0.f, square, 4.f);
  if (kind == Kind::henyeyGreenstein) {
    const float g = std::abs(asymmetry), base = (1.f - g) * (1.f - g) + g * apart;
    return albedo * (1.f - g * g) / (4.f * std::numbers::pi_v<float> * base * std::sqrt(base));
  }
  const float angle = 2.f * std::asin(0.5f * std::sqrt(apart));
  const SplineWeights at(angle * std::numbers::inv_pi_v<float>, kAngles);
  float value = 0.f;
  for (int i = 0; i < 4; ++i) value += at.weight[i] * phase[at.first + i];
  return std::max(0.f, value);
}

float FirstScattering::extinction(float mu) const {
  if (kind != Kind::leaves) return 1.f;
  const SplineWeights at(cosineCoordinate(mu), kProjections);
  float value = 0.f;
  for (int i = 0; i < 4; ++i) value += at.weight[i] * projection[at.first + i];
  return within(0.f, value, 1.f);
}

}  // namespace sunfleck::pp::detail
