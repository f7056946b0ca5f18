#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck::spp {

// The cells of a map along one coordinate: between rising edges; and some edges are cells of their own, for values that
// are exactly there. Or kinds with nothing between them, numbered from 0.
class MapAxis {
 public:
  MapAxis(std::string name, std::vector<double> edges, const std::vector<double>& own);
  MapAxis(std::string name, const std::vector<std::string_view>& kinds);

  int cells() const { return cells_; }
  int cell(double value) const;  // -1 outside and for NaN

  const std::vector<double>& edges() const { return edges_; }
  // The cells that touch an edge: those beside it, and its own if it has one.
  std::vector<int> around(std::size_t edge) const;
  std::array<double, 2> range(int cell) const;  // twice the same for an edge's own
  // Name, edges with a star on each that is a cell of its own, or kinds: what tells maps apart.
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::vector<double> edges_;
  std::vector<int> own_;  // of each edge: its cell, or -1
  int cells_;
  bool kinds_ = false;
};

}  // namespace sunfleck::spp
