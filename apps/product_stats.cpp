#include "apps/product_stats.hpp"

#include <fmt/format.h>

namespace sunfleck::apps {

std::string statsTable(std::span<const ProductCost> costs) {
  std::string text =
      fmt::format("{:<22} {:>8} {:>8} {:>9} {:>10} {:>9}\n", "product", "made", "reused", "adjusted", "skipped", "ms");
  for (const ProductCost& c : costs)
    text += fmt::format("{:<22} {:>8} {:>8} {:>9} {:>10} {:>9.1f}\n", c.name, c.made, c.reused, c.adjusted, c.skipped,
                        1e3 * c.seconds);
  return text;
}

nlohmann::ordered_json statsJson(std::span<const ProductCost> costs) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ProductCost& c : costs)
    list.push_back({{"product", c.name},
                    {"made", c.made},
                    {"reused", c.reused},
                    {"adjusted", c.adjusted},
                    {"skipped", c.skipped},
                    {"seconds", c.seconds}});
  return list;
}

}  // namespace sunfleck::apps
