#include "render/gl/detail/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/random.hpp"

namespace sunfleck::gl::detail {
namespace {

constexpr std::uint64_t kSeed = 25;

}  // namespace

std::vector<float> ranks(std::size_t count) {
  std::vector<float> result(count);
  for (std::size_t i = 0; i < count; ++i) result[i] = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
  Random random(kSeed, 0);
  for (std::size_t i = count; i > 1; --i) std::swap(result[i - 1], result[random.bits() % i]);
  return result;
}

std::vector<float> thinned(std::span<const double> areas, std::span<const float> ranks, double piece_area) {
  std::vector<float> enlargement(areas.size(), 0.f);
  double small = 0., kept = 0.;  // areas of the pieces that are smaller: of all, and of those kept when enlarged
  for (std::size_t i = 0; i < areas.size(); ++i) {
    if (areas[i] >= piece_area) {
      enlargement[i] = 1.f;
      continue;
    }
    small += areas[i];
    if (double{ranks[i]} < areas[i] / piece_area) {
      kept += piece_area;
      enlargement[i] = static_cast<float>(std::sqrt(piece_area / std::max(areas[i], 1e-300)));
    }
  }
  if (kept == 0.) return enlargement;
  const auto correction = static_cast<float>(std::sqrt(small / kept));
  for (std::size_t i = 0; i < areas.size(); ++i)
    if (areas[i] < piece_area) enlargement[i] *= correction;
  return enlargement;
}

}  // namespace sunfleck::gl::detail
