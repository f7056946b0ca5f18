#include "spp/map_axis.hpp"

#include <algorithm>
#include <sstream>

namespace sunfleck::spp {

MapAxis::MapAxis(std::string name, std::vector<double> edges, const std::vector<double>& own)
    : edges_(std::move(edges)), cells_(static_cast<int>(edges_.size()) - 1) {
  std::ostringstream text;
  text << name;
  for (const double edge : edges_) {
    own_.push_back(std::ranges::find(own, edge) == own.end() ? -1 : cells_++);
    text << ' ' << edge << (own_.back() >= 0 ? "*" : "");
  }
  text_ = text.str();
}

MapAxis::MapAxis(std::string name, const std::vector<std::string_view>& kinds)
    : text_(std::move(name)), cells_(static_cast<int>(kinds.size())), kinds_(true) {
  for (int kind = 0; kind < cells_; ++kind) {
    edges_.push_back(kind);
    own_.push_back(kind);
    text_ += ' ';
    text_ += kinds[static_cast<std::size_t>(kind)];
  }
}

int MapAxis::cell(double value) const {
  if (!(value >= edges_.front() && value <= edges_.back())) return -1;
  if (kinds_) return static_cast<int>(value);
  std::size_t edge = 0;  // of a dozen edges all are compared: no branch to be guessed
  for (std::size_t i = 1; i < edges_.size(); ++i) edge += value >= edges_[i] ? 1 : 0;
  if (own_[edge] >= 0 && value == edges_[edge]) return own_[edge];
  return static_cast<int>(std::min(edge, edges_.size() - 2));
}

std::vector<int> MapAxis::around(std::size_t edge) const {
  std::vector<int> cells;
  if (edge > 0 && !kinds_) cells.push_back(static_cast<int>(edge) - 1);
  if (edge + 1 < edges_.size() && !kinds_) cells.push_back(static_cast<int>(edge));
  if (own_[edge] >= 0) cells.push_back(own_[edge]);
  return cells;
}

std::array<double, 2> MapAxis::range(int cell) const {
  if (cell + 1 < static_cast<int>(edges_.size()) && !kinds_)
    return {edges_[static_cast<std::size_t>(cell)], edges_[static_cast<std::size_t>(cell) + 1]};
  const double edge = edges_[static_cast<std::size_t>(std::ranges::find(own_, cell) - own_.begin())];
  return {edge, edge};
}

}  // namespace sunfleck::spp
