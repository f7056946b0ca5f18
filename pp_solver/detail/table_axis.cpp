#include "pp_solver/detail/table_axis.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <cassert>

namespace sunfleck::pp::detail {

double DepthAxis::depth(double w, double t) {
  const auto stretched = [](double z) { return std::log1p(double{kStretch} * std::sqrt(z)); };
  const double wanted = (2. * t - 1.) * stretched(w);
  double low = 0., high = 1.;  // of the root of the depth's share, so that small ones keep their digits
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high), z = w * middle * middle;
    (stretched(z) - stretched(w - z) < wanted ? low : high) = middle;
  }
  return t <= 0. ? 0. : t >= 1. ? w : w * low * low;
}

std::vector<double> splineCoefficients(const std::vector<double>& values, std::size_t outer, int nodes,
                                       std::size_t inner) {
  assert(nodes >= 4 && values.size() == outer * static_cast<std::size_t>(nodes) * inner);
  const int count = nodes + 2;
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(count, count);
  for (int i = 0; i < nodes; ++i) {
    conditions(i + 1, i) = conditions(i + 1, i + 2) = 1. / 6.;
    conditions(i + 1, i + 1) = 2. / 3.;
  }
  const double jump[] = {1., -4., 6., -4., 1.};
  for (int k = 0; k < 5; ++k) {
    conditions(0, k) = jump[k];
    conditions(count - 1, count - 5 + k) = jump[k];
  }
  const Eigen::MatrixXd solve = conditions.partialPivLu().inverse().middleCols(1, nodes);
  std::vector<double> result(outer * static_cast<std::size_t>(count) * inner, 0.);
  tbb::parallel_for(std::size_t{0}, outer, [&](std::size_t o) {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto columns = static_cast<Eigen::Index>(inner);
    Eigen::Map<Rows>(result.data() + o * static_cast<std::size_t>(count) * inner, count, columns).noalias() =
        solve * Eigen::Map<const Rows>(values.data() + o * static_cast<std::size_t>(nodes) * inner, nodes, columns);
  });
  return result;
}

}  // namespace sunfleck::pp::detail
