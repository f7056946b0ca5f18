#include "spp/mode_numbers.hpp"

#include <cstddef>

namespace sunfleck::spp {

// The modes are orthogonal: with M the streams' solid angles times cosines, X' M Y = N is diagonal. So X^-1 = N^-1 Y'
// M, and nothing need be inverted.
ModeCouplings modeCouplings(const StreamConstants& constants, const StreamModes& modes) {
  const std::size_t n = modes.rate.size();
  ModeCouplings result{.sum_of_difference = std::vector<double>(n * n),
                       .difference_of_sum = std::vector<double>(n * n)};
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t l = j; l < n; ++l) {
      double of_differences = 0., of_sums = 0., norm = 0.;
      for (std::size_t i = 0; i < n; ++i) {
        const double weight = constants.solid_angles[i] * constants.cosines[i];
        const std::size_t at = i * n;
        of_sums += weight * modes.sum[at + j] * modes.sum[at + l];
        of_differences += weight * modes.difference[at + j] * modes.difference[at + l];
        norm += weight * modes.sum[at] * modes.difference[at];
      }
      result.sum_of_difference[j * n + l] = result.sum_of_difference[l * n + j] = of_differences / norm;
      result.difference_of_sum[j * n + l] = result.difference_of_sum[l * n + j] = of_sums / norm;
    }
  return result;
}

PowerWeights powerWeights(const StreamConstants& constants) {
  const StreamModes& mean = constants.orders.front();
  const std::size_t n = mean.rate.size();
  PowerWeights result;
  for (std::size_t j = 0; j < n; ++j) {
    double power_sum = 0., power_difference = 0., flux_sum = 0., flux_difference = 0., met_sum = 0.;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = constants.solid_angles[i], cosine = constants.cosines[i];
      power_sum += angle * mean.sum[i * n + j];
      power_difference += angle * mean.difference[i * n + j];
      met_sum += angle * constants.projections[i] * mean.sum[i * n + j];
      flux_sum += angle * cosine * mean.sum[i * n + j];
      flux_difference += angle * cosine * mean.difference[i * n + j];
    }
    result.power_sum.push_back(power_sum);
    result.power_difference.push_back(power_difference);
    result.met_sum.push_back(met_sum);
    result.flux_sum.push_back(flux_sum);
    result.flux_difference.push_back(flux_difference);
  }
  return result;
}

template <typename Real>
std::vector<Real> modeNumbers(const StreamConstants& constants) {
  std::vector<Real> result;
  const auto append = [&](double value) { result.push_back(static_cast<Real>(value)); };
  for (const StreamModes& modes : constants.orders) {
    for (std::size_t j = 0; j < modes.rate.size(); ++j)
      for (const double value : {modes.rate[j], modes.gain[j], modes.entering[j]}) append(value);
    const ModeCouplings couplings = modeCouplings(constants, modes);
    for (const double value : couplings.sum_of_difference) append(value);
    for (const double value : couplings.difference_of_sum) append(value);
  }
  return result;
}
template std::vector<float> modeNumbers(const StreamConstants&);
template std::vector<double> modeNumbers(const StreamConstants&);

}  // namespace sunfleck::spp
