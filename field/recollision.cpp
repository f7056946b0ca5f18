#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "field/detail/returning.hpp"
#include "field/field_solver.hpp"

namespace sunfleck {
namespace {

using detail::kBlock;
using detail::KindOptics;
using detail::overBlocks;
using detail::Returning;

// Largest eigenvalue of a symmetric tridiagonal matrix, by Sturm's sequence (Golub & Van Loan), and how much of its
// vector lies on the last row.
struct Largest {
  double value, last;
};
Largest largestEigenvalue(std::span<const double> diagonal, std::span<const double> beside) {
  double low = -1., high = 1.;
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    const double around = (i > 0 ? beside[i - 1] : 0.) + (i + 1 < diagonal.size() ? beside[i] : 0.);
    high = std::max(high, diagonal[i] + around);
    low = std::min(low, diagonal[i] - around);
  }
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    double pivot = diagonal[0] - middle;
    bool above = pivot > 0.;  // whether an eigenvalue lies above
    for (std::size_t i = 1; i < diagonal.size(); ++i) {
      pivot = diagonal[i] - middle - beside[i - 1] * beside[i - 1] / (std::abs(pivot) > 1e-30 ? pivot : -1e-30);
      above = above || pivot > 0.;
    }
    (above ? low : high) = middle;
  }
  std::vector<double> vector{1.};
  double squares = 1.;
  for (std::size_t i = 0; i + 1 < diagonal.size(); ++i) {
    const double before = i > 0 ? beside[i - 1] * vector[i - 1] : 0.;
    vector.push_back(((high - diagonal[i]) * vector[i] - before) / std::max(beside[i], 1e-30));
    squares += vector.back() * vector.back();
  }
  return {high, std::abs(vector.back()) / std::sqrt(squares)};
}

}  // namespace

// (F5)
double recollision(const FieldGeometry& geometry, const FieldAlbedo& albedo, const Progress& progress) {
  constexpr int kMostSteps = 12;
  const LineExchange& exchange = geometry.exchange;
  const std::span<const std::uint32_t> kinds = geometry.kinds;
  const bool periodic = geometry.periodic;
  const std::size_t elements = kinds.size(), ground = 2 * elements;
  std::vector<KindOptics> optics(albedo.of_kinds.size());
  for (std::size_t kind = 0; kind < optics.size(); ++kind)
    optics[kind].reflectance[0] = albedo.of_kinds[kind].reflectance;
  const Returning returning(geometry, optics);
  // Lanczos's method on the symmetric matrix C (K + own) C. C^2 is what the sides of an element send by themselves of
  // what comes to them, in absolute values of its eigenvalues: (rho - e) + tau of the sum of both sides and
  // (rho - e) - tau of their difference. K is made symmetric by the square roots of the lines' numbers.
  struct Root {
    float same = 0.f, other = 0.f;
  };
  std::vector<Root> root(elements);
  std::vector<float> scale(ground + 1), own(ground + 1), from(ground + 1), to(ground + 1), before(ground + 1),
      sent(ground + 1);
  for (std::size_t i = 0; i < elements; ++i) {
    if (exchange.lines[i] == 0) continue;
    const ElementOptics& of_kind = albedo.of_kinds[kinds[i]];
    const float reflected = (1.f - returning.back[i]) * of_kind.reflectance;
    const float sum = std::sqrt(std::max(0.f, reflected + of_kind.transmittance)),
                difference = std::sqrt(std::abs(reflected - of_kind.transmittance));
    root[i] = {0.5f * (sum + difference), 0.5f * (sum - difference)};
    for (std::size_t side = 2 * i; side < 2 * i + 2; ++side) {
      scale[side] = std::sqrt(returning.gain[side][0] / static_cast<float>(exchange.lines[i]));
      own[side] = returning.own[side][0] / static_cast<float>(exchange.lines[i]);
      // Light even on all that scatters is not far from the vector sought.
      from[side] = sum * std::sqrt(static_cast<float>(exchange.lines[i]));
    }
  }
  if (periodic && exchange.all_lines > 0) {
    scale[ground] = std::sqrt(albedo.ground / static_cast<float>(exchange.all_lines));
    from[ground] = std::sqrt(albedo.ground * static_cast<float>(exchange.all_lines));
  }
  const std::size_t blocks = (elements + kBlock - 1) / kBlock;
  const auto product = [&](const std::vector<float>& a, const std::vector<float>& b) {
    std::vector<double> parts(blocks);
    overBlocks(elements, [&](std::size_t block, std::size_t begin, std::size_t end) {
      for (std::size_t side = 2 * begin; side < 2 * end; ++side) parts[block] += double{a[side]} * double{b[side]};
    });
    return std::accumulate(parts.begin(), parts.end(), double{a[ground]} * double{b[ground]});
  };
  double norm = std::sqrt(product(from, from));
  if (!(norm > 0.)) return 0.;
  for (float& value : from) value = static_cast<float>(double{value} / norm);
  std::vector<double> diagonal, beside;
  Largest largest{0., 1.};
  for (int step = 0; step < kMostSteps; ++step) {
    requireGoOn(progress, 0.);
    overBlocks(elements, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t side = 2 * begin; side < 2 * end; ++side)
        sent[side] = scale[side] * (root[side / 2].same * from[side] + root[side / 2].other * from[side ^ 1]);
    });
    sent[ground] = scale[ground] * from[ground];
    std::vector<double> down(blocks);
    overBlocks(elements, [&](std::size_t block, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::array<float, 2> come{};
        for (std::size_t side = 2 * i; side < 2 * i + 2; ++side) {
          float sum = 0.f;
          for (std::uint64_t link = exchange.first[side]; link < exchange.first[side + 1]; ++link)
            sum += sent[exchange.sees[link]];
          if (periodic) {
            sum += static_cast<float>(exchange.below[side]) * sent[ground];
            down[block] += double{static_cast<float>(exchange.below[side]) * sent[side]};
          }
          come[side % 2] = scale[side] * sum;
          if (scale[side] > 0.f) come[side % 2] += own[side] / scale[side] * sent[side];
        }
        to[2 * i] = root[i].same * come[0] + root[i].other * come[1];
        to[2 * i + 1] = root[i].same * come[1] + root[i].other * come[0];
      }
    });
    to[ground] = scale[ground] * static_cast<float>(std::accumulate(down.begin(), down.end(), 0.));
    diagonal.push_back(product(from, to));
    for (std::size_t side = 0; side <= ground; ++side)
      to[side] -= static_cast<float>(diagonal.back()) * from[side] +
                  (beside.empty() ? 0.f : static_cast<float>(beside.back()) * before[side]);
    norm = std::sqrt(product(to, to));
    beside.push_back(norm);
    largest = largestEigenvalue(diagonal, beside);
    // The eigenvalue is as near as this residual's square over the distance to the next one, which is no smaller here
    // than a hundredth.
    if (norm * largest.last < 3e-3 * (1. - largest.value) || norm < 1e-7) break;
    for (float& value : to) value = static_cast<float>(double{value} / norm);
    std::swap(before, from);
    std::swap(from, to);
  }
  // What is not absorbed is no more than the albedo.
  float most = periodic ? albedo.ground : 0.f;
  for (const ElementOptics& of_kind : albedo.of_kinds) most = std::max(most, of_kind.albedo());
  return std::min(double{most}, largest.value + norm * largest.last);
}

}  // namespace sunfleck
