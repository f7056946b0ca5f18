#include "field/anderson.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sunfleck {
namespace {

constexpr std::size_t kPart = 8192;

std::size_t parts(std::size_t size) {
  return (size + kPart - 1) / kPart;
}

// Calls work(begin, end, part) for parts of a vector.
template <typename Work>
void inParts(std::size_t size, const Work& work) {
  tbb::parallel_for(std::size_t{0}, parts(size),
                    [&](std::size_t part) { work(part * kPart, std::min(size, (part + 1) * kPart), part); });
}

// Solves the symmetric system by elimination; steps that add nothing to those before are left out with 0.
std::vector<double> solved(std::vector<std::vector<double>> matrix, std::vector<double> right) {
  const std::size_t n = right.size();
  std::vector<double> pivots(n);
  for (std::size_t i = 0; i < n; ++i) pivots[i] = matrix[i][i];
  constexpr double negligible = 1e-10;  // of a step's own square: what single precision leaves of it
  std::vector<char> used(n, 0);
  for (std::size_t k = n; k-- > 0;) {  // the newest first
    if (!(matrix[k][k] > negligible * pivots[k])) continue;
    used[k] = 1;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = matrix[i][k] / matrix[k][k];
      for (std::size_t j = 0; j < n; ++j) matrix[i][j] -= factor * matrix[k][j];
      right[i] -= factor * right[k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) right[k] = used[k] ? right[k] / matrix[k][k] : 0.;
  return right;
}

}  // namespace

Anderson::Anderson(std::size_t depth, std::vector<float> weights) : depth_(depth), weights_(std::move(weights)) {}

template <typename Terms>
std::vector<double> Anderson::sums(std::size_t count, const Terms& terms) const {
  const std::size_t size = weights_.size();
  std::vector<double> of_parts(parts(size) * count);
  inParts(size, [&](std::size_t begin, std::size_t end, std::size_t part) {
    for (std::size_t k = 0; k < count; ++k) {
      double sum = 0.;
      for (std::size_t i = begin; i < end; ++i) sum += static_cast<double>(terms(k, i));
      of_parts[part * count + k] = sum;
    }
  });
  std::vector<double> total(count);
  for (std::size_t part = 0; part < parts(size); ++part)
    for (std::size_t k = 0; k < count; ++k) total[k] += of_parts[part * count + k];
  return total;
}

// (F18)
void Anderson::next(std::span<float> x, std::span<const float> g) {
  const std::size_t size = weights_.size();
  std::vector<float> residual(size);
  inParts(size, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) residual[i] = g[i] - x[i];
  });
  if (!last_residual_.empty()) {
    Step step{std::vector<float>(size), std::vector<float>(size)};
    inParts(size, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        step.residual[i] = residual[i] - last_residual_[i];
        step.value[i] = g[i] - last_value_[i];
      }
    });
    if (steps_.size() == depth_) {
      steps_.erase(steps_.begin());
      gram_.erase(gram_.begin());
      for (auto& line : gram_) line.erase(line.begin());
    }
    steps_.push_back(std::move(step));
    const std::vector<double> products = sums(steps_.size(), [&](std::size_t k, std::size_t i) {
      return weights_[i] * steps_[k].residual[i] * steps_.back().residual[i];
    });
    for (std::size_t k = 0; k < gram_.size(); ++k) gram_[k].push_back(products[k]);
    gram_.push_back(products);
  }
  last_residual_ = residual;
  last_value_.assign(g.begin(), g.end());
  const std::vector<double> mixture = solved(gram_, sums(steps_.size(), [&](std::size_t k, std::size_t i) {
                                               return weights_[i] * steps_[k].residual[i] * residual[i];
                                             }));
  inParts(size, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::copy(g.begin() + static_cast<std::ptrdiff_t>(begin), g.begin() + static_cast<std::ptrdiff_t>(end),
              x.begin() + static_cast<std::ptrdiff_t>(begin));
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const auto share = static_cast<float>(mixture[k]);
      for (std::size_t i = begin; i < end; ++i) x[i] -= share * steps_[k].value[i];
    }
  });
}

}  // namespace sunfleck
