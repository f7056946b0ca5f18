#pragma once

#define TOML_EXCEPTIONS 1
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cstdint>
#include <glm/trigonometric.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "core/require.hpp"
#include "core/stand.hpp"
#include "render/scene.hpp"

namespace sunfleck::detail {

// One table of a scene file. Every key is read through it; `done` refuses what nobody asked for.
class SceneTable {
 public:
  SceneTable(const toml::table& file, std::string file_name, std::string name)
      : file_(std::move(file_name)), name_(std::move(name)) {
    const toml::node* node = file.get(name_);
    if (node && !node->is_table()) refuse(*node, name_, "a table: [" + name_ + "]");
    if (node) table_ = node->as_table();
  }

  bool has(const std::string& key) const { return table_ && table_->contains(key); }

  double number(const std::string& key, double fallback, double low, double high, const std::string& rule) {
    const toml::node* node = take(key);
    return node ? checked(*node, key, low, high, rule) : fallback;
  }

  int count(const std::string& key, int fallback, int high) {
    const toml::node* node = take(key);
    if (!node) return fallback;
    const auto value = node->value<std::int64_t>();
    if (!node->is_integer() || *value < 1 || *value > high)
      refuse(*node, key, fmt::format("a whole number, 1 to {}", high));
    return static_cast<int>(*value);
  }

  std::string text(const std::string& key, const std::string& fallback) {
    const toml::node* node = take(key);
    if (!node) return fallback;
    if (!node->is_string()) refuse(*node, key, "a text in quotes");
    return *node->value<std::string>();
  }

  // A list of exactly `count` numbers.
  std::vector<double> numbers(const std::string& key, std::size_t count, double low, double high,
                              const std::string& rule) {
    const toml::node* node = take(key);
    return numbersOf(*node, key, count, low, high, rule);
  }

  // One number for all bands, or one for each.
  glm::vec3 perBand(const std::string& key, float fallback) {
    const toml::node* node = take(key);
    if (!node) return glm::vec3(fallback);
    const std::string rule = "in [0, 1]: one number, or three for red, green and blue";
    if (!node->is_array()) return glm::vec3(static_cast<float>(checked(*node, key, 0., 1., rule)));
    const std::vector<double> v = numbersOf(*node, key, kBands, 0., 1., rule);
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  }

  // A list of [x, y] or [x, y, rotation_deg].
  std::vector<Placement> placements(const std::string& key) {
    const toml::node* node = take(key);
    const std::string rule = "a list of [x, y] or [x, y, rotation_deg], at least one, each number in [-1e6, 1e6]";
    if (!node->is_array() || node->as_array()->empty()) refuse(*node, key, rule);
    std::vector<Placement> trees;
    for (const toml::node& item : *node->as_array()) {
      const std::size_t length = item.is_array() && item.as_array()->size() == 2 ? 2 : 3;
      const std::vector<double> v = numbersOf(item, key, length, -1e6, 1e6, rule);
      trees.push_back({.position = {static_cast<float>(v[0]), static_cast<float>(v[1]), 0.f},
                       .rotation = length == 3 ? glm::radians(static_cast<float>(v[2])) : 0.f});
    }
    return trees;
  }

  void done() const {
    if (!table_) return;
    for (const auto& [key, node] : *table_)
      if (std::find(taken_.begin(), taken_.end(), key.str()) == taken_.end())
        throw InvalidInput(fmt::format("{}:{}: unknown key \"{}\" in [{}]; see: sunfleck --help scene", file_,
                                       node.source().begin.line, key.str(), name_));
  }

  [[noreturn]] void refuse(const toml::node& node, const std::string& key, const std::string& rule) const {
    std::ostringstream value;
    if (node.is_table())
      value << "a table";
    else
      node.visit([&](const auto& v) { value << v; });
    throw InvalidInput(fmt::format("{}:{}: {} = {}: must be {}", file_, node.source().begin.line,
                                   key == name_ ? key : name_ + "." + key, value.str(), rule));
  }

 private:
  const toml::node* take(const std::string& key) {
    taken_.push_back(key);
    return table_ ? table_->get(key) : nullptr;
  }

  double checked(const toml::node& node, const std::string& key, double low, double high,
                 const std::string& rule) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !(*value >= low && *value <= high)) refuse(node, key, rule);
    return *value;
  }

  std::vector<double> numbersOf(const toml::node& node, const std::string& key, std::size_t count, double low,
                                double high, const std::string& rule) const {
    if (!node.is_array() || node.as_array()->size() != count) refuse(node, key, rule);
    std::vector<double> values;
    for (const toml::node& item : *node.as_array()) values.push_back(checked(item, key, low, high, rule));
    return values;
  }

  std::string file_, name_;
  const toml::table* table_ = nullptr;
  std::vector<std::string> taken_;
};

}  // namespace sunfleck::detail
