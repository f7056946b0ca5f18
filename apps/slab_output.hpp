#pragma once

#include <string>

#include "apps/slab_options.hpp"

namespace sunfleck::apps {

// One model's answer.
struct ModelAnswer {
  const SlabModel* model;
  SlabAnswer answer;
};

// For people: shares, then tables by depth and direction.
std::string slabText(const SlabQuestion& question, const ModelAnswer& answer, double tolerance);

// For programs: one object, or for several models {"models": [...]} of objects with a "model" each.
std::string slabJson(const SlabQuestion& question, const std::vector<ModelAnswer>& answers);

}  // namespace sunfleck::apps
