#include "leaves/prospect.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "leaves/detail/data_texts.hpp"
#include "leaves/detail/number_table.hpp"

namespace sunfleck {
namespace {

constexpr std::size_t kColumns = 10;  // wavelength, refractive index, and as many contents absorb

const std::vector<double>& coefficients() {
  static const std::vector<double> table = detail::numberTable(detail::dataText("prospect_pro.txt"));
  return table;
}

const Prospect& everyWavelength() {
  static const Prospect all = [] {
    std::vector<double> wavelengths(kLastWavelength - kFirstWavelength + 1);
    std::iota(wavelengths.begin(), wavelengths.end(), double{kFirstWavelength});
    return Prospect(wavelengths);
  }();
  return all;
}

}  // namespace

Prospect::Prospect(std::span<const double> wavelengths) {
  const std::vector<double>& table = coefficients();
  rows_.reserve(wavelengths.size());
  for (const double wavelength : wavelengths) {
    validate(WavelengthBand{wavelength, wavelength}, "wavelength");
    const double from_first = wavelength - kFirstWavelength;
    const std::size_t below = std::min(static_cast<std::size_t>(from_first), table.size() / kColumns - 2);
    const double share = from_first - static_cast<double>(below);
    const auto column = [&](std::size_t c) {
      return std::lerp(table[below * kColumns + c], table[(below + 1) * kColumns + c], share);
    };
    Row& row = rows_.emplace_back();
    row.faces = plateFaces(column(1));
    for (std::size_t i = 0; i < kAbsorbing; ++i) row.specific[i] = column(i + 2);
  }
}

double Prospect::absorption(const Row& row, const LeafContents& leaf) const {
  double sum = 0.;
  for (std::size_t i = 0; i < kAbsorbing; ++i) sum += row.specific[i] * (leaf.*leafContents()[i + 1].value);
  return sum;
}

void Prospect::solve(const LeafContents& leaf, std::span<LeafSides> sides) const {
  validate(leaf);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double k = absorption(rows_[i], leaf) / leaf.structure;
    sides[i] = plates(rows_[i].faces, plateTransmittance(k), leaf.structure);
  }
}

void Prospect::differentiate(const LeafContents& leaf, std::span<LeafSides> result) const {
  constexpr double kStep = 1e-5;
  validate(leaf);
  const auto slope = [](const LeafSides& low, const LeafSides& high, double step) {
    return LeafSides{.reflectance = (high.reflectance - low.reflectance) / step,
                     .transmittance = (high.transmittance - low.transmittance) / step};
  };
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    const double all = absorption(row, leaf), n = leaf.structure;
    const auto at = [&](double absorbed, double count) {
      return plates(row.faces, plateTransmittance(absorbed / count), count);
    };
    const double more = all + kStep * std::max(all, 0.01), less = std::max(all - kStep * std::max(all, 0.01), 0.);
    const double thicker = n * (1. + kStep), thinner = std::max(n * (1. - kStep), 1.);
    result[i] = slope(at(all, thinner), at(all, thicker), thicker - thinner);
    const LeafSides by_absorption = slope(at(less, n), at(more, n), more - less);
    for (std::size_t c = 0; c < kAbsorbing; ++c)
      result[(c + 1) * rows_.size() + i] = {.reflectance = by_absorption.reflectance * row.specific[c],
                                            .transmittance = by_absorption.transmittance * row.specific[c]};
  }
}

LeafSpectrum prospect(const LeafContents& leaf) {
  LeafSpectrum spectrum{std::vector<LeafSides>(everyWavelength().size())};
  everyWavelength().solve(leaf, spectrum.sides);
  return spectrum;
}

}  // namespace sunfleck
