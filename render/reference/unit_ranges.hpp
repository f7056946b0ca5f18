#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace sunfleck {

// A set of units of a run, kept as ranges [first, last) that neither meet nor overlap.
class UnitRanges {
 public:
  using Range = std::pair<std::uint64_t, std::uint64_t>;

  UnitRanges() = default;
  UnitRanges(std::uint64_t first, std::uint64_t last) { add(first, last); }

  // Throws std::logic_error when one of them is in the set already: no unit counts twice.
  void add(std::uint64_t first, std::uint64_t last);
  void add(std::uint64_t unit) { add(unit, unit + 1); }

  bool contains(std::uint64_t unit) const;
  // The first range that both hold; empty (first = last) if there is none.
  Range overlap(const UnitRanges& other) const;
  std::uint64_t count() const;
  // How many leave `remainder` when divided by `divisor`.
  std::uint64_t countOf(std::uint64_t remainder, std::uint64_t divisor) const;
  std::vector<Range> ranges() const { return {ranges_.begin(), ranges_.end()}; }
  UnitRanges without(const UnitRanges& other) const;
  bool operator==(const UnitRanges&) const = default;

 private:
  std::map<std::uint64_t, std::uint64_t> ranges_;  // last by first
};

// Adds to `units` the lowest `count` of those that leave `remainder` when divided by `divisor` and are not in `done`.
void addMissing(UnitRanges& units, std::uint64_t count, const UnitRanges& done, std::uint64_t remainder,
                std::uint64_t divisor);

}  // namespace sunfleck
