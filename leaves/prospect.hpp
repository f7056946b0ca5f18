#pragma once

#include <array>
#include <span>
#include <vector>

#include "leaves/leaf_contents.hpp"
#include "leaves/leaf_plates.hpp"
#include "leaves/leaf_spectrum.hpp"

namespace sunfleck {

// (L6) PROSPECT-D (Feret et al. 2017) and, where dry matter is told as protein and carbon-based constituents,
// PROSPECT-PRO (Feret et al. 2021): a leaf as a pile of N plates (L3), each of which absorbs
// k = sum of content times specific absorption, over N. Throws InvalidInput as validate(leaf) does. Some 0.4 ms.
LeafSpectrum prospect(const LeafContents& leaf);

// The same at wavelengths of one's own [nm], 400 .. 2500, where index and absorption are linear between those of the
// table. It keeps what does not depend on the leaf. Throws InvalidInput on wavelengths out of range.
class Prospect {
 public:
  explicit Prospect(std::span<const double> wavelengths);

  std::size_t size() const { return rows_.size(); }

  // `sides` has size() entries. Throws InvalidInput as validate(leaf) does.
  void solve(const LeafContents& leaf, std::span<LeafSides> sides) const;

  // Partial derivatives of both by the contents, in the order of leafContents():
  // result[content * size() + i]. By differences of the plates' formulas; right to 1e-6 of the largest.
  void differentiate(const LeafContents& leaf, std::span<LeafSides> result) const;

 private:
  static constexpr std::size_t kAbsorbing = 8;  // contents but the structure
  struct Row {
    PlateFaces faces;
    std::array<double, kAbsorbing> specific{};  // absorption per content
  };
  double absorption(const Row& row, const LeafContents& leaf) const;  // of the whole leaf [1]

  std::vector<Row> rows_;
};

}  // namespace sunfleck
