#include "field/escape_clumping.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "field/grid_field.hpp"

namespace sunfleck {

// (F28)
float clumpingByEscape(const TurnedClusters& alone, const Bounds& box, float side, double escape,
                       const Progress& progress) {
  const ClusteredTree tree{.turned = &alone, .position = glm::vec3(0.f), .kind = 0};
  const StandMedium medium = standMedium({&tree, 1}, box, side, std::nullopt);
  double area = 0.;
  for (const float of_element : medium.cells.area) area += double{of_element};
  const auto escaping = [&](float omega) {
    GridField field(medium.cells, {&omega, 1});
    const float even = 1.f;
    const GridLight light{.optics = {{GridOptics{.leaf = {0.f, 0.f}, .wood_reflectance = 0.f}}},
                          .direct = std::vector<float>(medium.cells.area.size() * 2),
                          .entering = field.evenSky({&even, 1}, {&even, 1}, {})};
    const GridSolution solution = field.solve(light, {}, progress);
    const GridBalance& balance = solution.balance[0];
    return (balance.absorbed_leaves + balance.absorbed_wood) * balance.incoming / (2. * std::numbers::pi * area);
  };
  constexpr float least = 1e-3f;
  double omega = 1., found = escaping(1.f);
  if (found <= escape) return 1.f;
  // What is lost grows with Omega, less and less: the secant from 0 stays on one side.
  double low = 0., of_low = 0.;
  constexpr int steps = 8;
  for (int step = 0; step < steps && std::abs(found - escape) > 1e-3 * escape; ++step) {
    const double next = std::clamp(low + (omega - low) * (escape - of_low) / (found - of_low), double{least}, 1.);
    const double of_next = escaping(static_cast<float>(next));
    if (of_next > escape) {
      omega = next;
      found = of_next;
    } else {
      low = next;
      of_low = of_next;
    }
    if (std::abs(of_next - escape) <= 1e-3 * escape) return static_cast<float>(next);
  }
  return static_cast<float>(omega);
}

}  // namespace sunfleck
