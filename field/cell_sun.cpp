#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/require.hpp"
#include "field/grid_field.hpp"

namespace sunfleck {
namespace {

constexpr std::size_t kLanes = SphereOrdinates::kLanes;

}  // namespace

// (F21)
CellSun GridField::sunThroughCells(const Direction& along) const {
  require(along.z < 0.f && std::abs(glm::length(along) - 1.f) < 1e-3f, "the sun's direction down", along.z,
          "below 0 in a unit vector");
  const SphereOrdinates beam = SphereOrdinates::beam(along);
  Sweep sweep(medium_.grid, beam, 1);
  const std::size_t slots = medium_.grid.cells.size();
  const auto seen = [&](std::uint32_t element) {
    const glm::vec3& normal = medium_.normal[element];
    return normal == glm::vec3(0.f) ? 0.5f : std::abs(glm::dot(normal, along));
  };
  std::vector<float> extinction(sweep.extinctionSize()), source(sweep.size()), mean(sweep.size());
  EnteringLight entering{.radiance = std::vector<float>(beam.size())};
  std::size_t row = 0, lane = 0;
  for (std::size_t i = 0; i < beam.size(); ++i)
    if (beam.weight(i) > 0.f) {
      row = i / kLanes;
      lane = i % kLanes;
      entering.radiance[i] = 1.f;
    }
  tbb::parallel_for(std::size_t{0}, slots, [&](std::size_t slot) {
    double area = 0.;
    for (std::uint32_t i = medium_.first_piece[slot]; i < medium_.first_piece[slot + 1]; ++i)
      area += double{medium_.pieces[i].area * seen(medium_.pieces[i].element)};
    extinction[sweep.extinctionPlace(row, slot) + lane] =
        clumping_[slot] * static_cast<float>(area) / medium_.grid.volume();
  });
  // A low sun crosses a stand that repeats many times; what it still changes is of no account long before the last.
  constexpr int most_crossings = 1000;
  const double steady = 1e-6 * sweep.enteringPower(entering, 0);
  for (int crossing = 0; crossing < most_crossings; ++crossing) {
    sweep.follow(extinction, source, entering, mean);
    if (sweep.wallChange(0) <= steady) break;
  }
  CellSun sun{.direct = std::vector<float>(medium_.area.size() * 2),
              .ground = {sweep.groundIrradiance().begin(), sweep.groundIrradiance().end()}};
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const float light = clumping_[slot] * mean[sweep.place(row, slot) + lane];
    for (std::uint32_t i = medium_.first_piece[slot]; i < medium_.first_piece[slot + 1]; ++i) {
      const CellPiece& piece = medium_.pieces[i];
      const float share = light * piece.area / medium_.area[piece.element] * seen(piece.element);
      const float back = glm::dot(medium_.normal[piece.element], along);
      if (back <= 0.f) sun.direct[piece.element * 2] += back < 0.f ? share : 0.5f * share;
      if (back >= 0.f) sun.direct[piece.element * 2 + 1] += back > 0.f ? share : 0.5f * share;
    }
  }
  // Wood counts half of its surface from either side, but is told of with all of it.
  for (std::size_t i = 0; i < medium_.area.size(); ++i)
    if (medium_.material[i] % 2 == 1) {
      sun.direct[2 * i] *= 0.5f;
      sun.direct[2 * i + 1] *= 0.5f;
    }
  return sun;
}

}  // namespace sunfleck
