#include "scattering/double_gauss.hpp"

#include <boost/math/special_functions/legendre.hpp>
#include <cstddef>

namespace sunfleck {

DoubleGauss doubleGauss(int streams) {
  const int half = streams / 2;
  const auto n = static_cast<std::size_t>(half);
  DoubleGauss gauss{std::vector<double>(n), std::vector<double>(n)};
  // In long double, so that the nodes near 0 and the weights are right to the last digit.
  const std::vector<long double> zeros = boost::math::legendre_p_zeros<long double>(half);  // not negative, rising
  for (std::size_t i = 0; i < zeros.size(); ++i) {
    const long double slope = boost::math::legendre_p_prime(half, zeros[i]);
    const std::size_t low = zeros.size() - 1 - i, high = n - 1 - low;
    gauss.mu[low] = static_cast<double>((1.L - zeros[i]) / 2);
    gauss.mu[high] = static_cast<double>((1.L + zeros[i]) / 2);
    gauss.weight[low] = gauss.weight[high] =
        static_cast<double>(1.L / ((1.L - zeros[i]) * (1.L + zeros[i]) * slope * slope));
  }
  return gauss;
}

}  // namespace sunfleck
