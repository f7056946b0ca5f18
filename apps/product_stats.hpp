#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "grid/product_graph.hpp"

namespace sunfleck::apps {

// What was computed, reused and skipped, and what it took: for --stats. A table with a line for each product, and the
// same as JSON.
std::string statsTable(std::span<const ProductCost> costs);
nlohmann::ordered_json statsJson(std::span<const ProductCost> costs);

}  // namespace sunfleck::apps
