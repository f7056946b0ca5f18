#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/require.hpp"
#include "plants/import.hpp"

namespace sunfleck {
namespace {

using Up = ImportRules::Up;
using Cards = ImportRules::Cards;

constexpr std::array<std::pair<std::string_view, Up>, 3> kUps{{{"x", Up::x}, {"y", Up::y}, {"z", Up::z}}};
constexpr std::array<std::pair<std::string_view, Cards>, 3> kCards{
    {{"cut", Cards::cut}, {"mask", Cards::mask}, {"whole", Cards::whole}}};
constexpr std::array<std::pair<std::string_view, float>, 7> kUnits{
    {{"m", 1.f}, {"dm", 0.1f}, {"cm", 0.01f}, {"mm", 0.001f}, {"km", 1000.f}, {"in", 0.0254f}, {"ft", 0.3048f}}};

template <typename Table>
auto valueOf(const Table& table, const std::string& text, const std::string& what) {
  const auto found = std::ranges::find(table, std::string_view(text), &Table::value_type::first);
  if (found == table.end()) {
    std::string rule = "one of", quoted(1, '"');
    for (const auto& [name, value] : table) rule.append(name == table[0].first ? " " : ", ").append(name);
    quoted.append(text.substr(0, 80)).push_back('"');
    require(false, what, quoted, rule);
  }
  return found->second;
}

template <typename Table, typename Value>
std::string nameIn(const Table& table, Value value) {
  const auto found = std::ranges::find(table, value, &Table::value_type::second);
  return found == table.end() ? "" : std::string(found->first);
}

}  // namespace

Up upwardAxis(const std::string& text, const std::string& what) {
  return valueOf(kUps, text, what);
}
Cards cardsNamed(const std::string& text, const std::string& what) {
  return valueOf(kCards, text, what);
}
float metresPer(const std::string& unit, const std::string& what) {
  return valueOf(kUnits, unit, what);
}
std::string nameOf(Up up) {
  return nameIn(kUps, up);
}
std::string nameOf(Cards cards) {
  return nameIn(kCards, cards);
}

}  // namespace sunfleck
