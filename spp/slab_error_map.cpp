#include "spp/slab_error_map.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sunfleck::spp {
namespace {

using Columns = std::array<std::size_t, kSlabQuantities>;

// Where each tier's bytes stand, and the tiers by cost of powers and of radiance.
struct Layout {
  struct Entry {
    const SlabTier* tier;
    Columns columns;
  };
  std::vector<Columns> columns;
  std::array<std::vector<Entry>, 2> by_cost;
  std::size_t count = 0;

  Layout() {
    const std::span<const SlabTier> tiers = slabTiers();
    for (std::size_t i = 0; i < tiers.size(); ++i) {
      const auto powers = static_cast<std::size_t>(tiers[i].powers);
      if (powers == i) {
        columns.push_back({count, count + 1, 0});
        count += 2;
      } else {
        columns.push_back(columns[powers]);
      }
    }
    for (auto& column : columns) column[2] = count++;
    for (const bool radiance : {false, true})
      for (const SlabTier* tier : tiersByCost(radiance))
        by_cost[radiance ? 1 : 0].push_back({tier, columns[static_cast<std::size_t>(tier - tiers.data())]});
  }
};

const Layout& layout() {
  static const Layout kLayout;
  return kLayout;
}

std::size_t cellsOf(const std::vector<MapAxis>& axes) {
  std::size_t cells = 1;
  for (const MapAxis& axis : axes) cells *= static_cast<std::size_t>(axis.cells());
  return cells;
}

}  // namespace

std::uint8_t SlabErrorMap::code(double error) {
  if (!(error > kLeastError)) return std::isnan(error) ? kNoPromise : 0;
  const double step = std::ceil(kStepsPerDecade * std::log10(error / kLeastError));
  return step < kNoPromise ? static_cast<std::uint8_t>(step) : kNoPromise;
}

double SlabErrorMap::error(std::uint8_t code) {
  return code == kNoPromise ? std::numeric_limits<double>::infinity()
                            : kLeastError * std::pow(10., static_cast<double>(code) / kStepsPerDecade);
}

std::size_t SlabErrorMap::columns() {
  return layout().count;
}

std::size_t SlabErrorMap::column(const SlabTier& tier, SlabQuantity quantity) {
  return layout().columns[static_cast<std::size_t>(&tier - slabTiers().data())][static_cast<std::size_t>(quantity)];
}

SlabErrorMap::SlabErrorMap(std::vector<MapAxis> axes, std::vector<std::uint8_t> codes)
    : axes_(std::move(axes)), codes_(std::move(codes)) {
  if (codes_.size() != cellsOf(axes_) * columns()) throw std::logic_error("slab errors: not one byte for each cell");
}

std::string SlabErrorMap::header() const {
  std::string text = "sunfleck slab errors 1";
  for (const MapAxis& axis : axes_) text += "; " + axis.text();
  for (const SlabTier& tier : slabTiers()) text += (&tier == slabTiers().data() ? "; " : " ") + std::string(tier.name);
  return text + "\n";
}

// Column by column, each byte as its difference from the cell before along the first axis: runs of small numbers, which
// zlib packs well.
std::string SlabErrorMap::file() const {
  const std::size_t cells = cellsOf(axes_), width = columns(),
                    before = cells / static_cast<std::size_t>(axes_[0].cells());
  std::vector<Bytef> differences;
  for (std::size_t c = 0; c < width; ++c)
    for (std::size_t i = 0; i < cells; ++i)
      differences.push_back(
          static_cast<Bytef>(codes_[i * width + c] - (i >= before ? codes_[(i - before) * width + c] : 0)));
  uLongf size = compressBound(static_cast<uLong>(differences.size()));
  std::vector<Bytef> packed(size);
  if (compress2(packed.data(), &size, differences.data(), static_cast<uLong>(differences.size()), 9) != Z_OK)
    throw std::runtime_error("slab errors: could not be packed");
  return header() + std::string(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
}

SlabErrorMap::SlabErrorMap(std::vector<MapAxis> axes, std::string_view file) : axes_(std::move(axes)) {
  if (!file.starts_with(header())) throw std::runtime_error("slab errors: made for other axes or tiers");
  file.remove_prefix(header().size());
  const std::size_t cells = cellsOf(axes_), width = columns(),
                    before = cells / static_cast<std::size_t>(axes_[0].cells());
  std::vector<Bytef> differences(cells * width);
  uLongf size = static_cast<uLongf>(differences.size());
  if (uncompress(differences.data(), &size, reinterpret_cast<const Bytef*>(file.data()),
                 static_cast<uLong>(file.size())) != Z_OK ||
      size != differences.size())
    throw std::runtime_error("slab errors: cut short or damaged");
  codes_.resize(differences.size());
  for (std::size_t c = 0; c < width; ++c)
    for (std::size_t i = 0; i < cells; ++i)
      codes_[i * width + c] =
          static_cast<std::uint8_t>(differences[c * cells + i] + (i >= before ? codes_[(i - before) * width + c] : 0));
}

std::span<const std::uint8_t> SlabErrorMap::at(std::span<const double> coordinates) const {
  std::size_t cell = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const int along = axes_[i].cell(coordinates[i]);
    if (along < 0) return {};
    cell = cell * static_cast<std::size_t>(axes_[i].cells()) + static_cast<std::size_t>(along);
  }
  return {codes_.data() + cell * columns(), columns()};
}

const SlabTier* cheapestTier(std::span<const std::uint8_t> cell, std::span<const SlabQuantity> quantities,
                             double max_error) {
  if (cell.empty() || !(max_error >= SlabErrorMap::kLeastError)) return nullptr;
  const double steps = SlabErrorMap::kStepsPerDecade * std::log10(max_error / SlabErrorMap::kLeastError);
  const auto most = static_cast<std::uint8_t>(std::min(std::floor(steps + 1e-9), SlabErrorMap::kNoPromise - 1.));
  bool radiance = false;
  for (const SlabQuantity quantity : quantities) radiance |= quantity == SlabQuantity::kRadiance;
  for (const Layout::Entry& entry : layout().by_cost[radiance ? 1 : 0]) {
    bool keeps = true;
    for (const SlabQuantity quantity : quantities)
      keeps &= cell[entry.columns[static_cast<std::size_t>(quantity)]] <= most;
    if (keeps) return entry.tier;
  }
  return nullptr;
}

}  // namespace sunfleck::spp
