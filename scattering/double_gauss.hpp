#pragma once

#include <vector>

namespace sunfleck {

// (P1) Double-Gauss ordinates: Gauss-Legendre nodes on (0, 1) for each hemisphere (Sykes 1951).
struct DoubleGauss {
  std::vector<double> mu;      // ascending [1], half of the streams
  std::vector<double> weight;  // their sum is 1
};

//   streams  N, of both hemispheres: even, 2 or more
DoubleGauss doubleGauss(int streams);

}  // namespace sunfleck
