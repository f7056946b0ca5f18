#pragma once

#include <string>

#include "apps/slab_options.hpp"
#include "render/compare/slab_choice.hpp"

namespace sunfleck::apps {

// One model's answer.
struct ModelAnswer {
  const SlabModel* model;
  SlabAnswer answer;
};

// For people: shares, then tables by depth and direction.
std::string slabText(const SlabQuestion& question, const ModelAnswer& answer, double tolerance);

// The same after what was chosen within an error, by how much it may be off, and what is cheaper and dearer.
std::string slabText(const SlabQuestion& question, const ModelAnswer& answer, const SlabChoice& choice,
                     double max_error);
std::string slabJson(const SlabQuestion& question, const ModelAnswer& answer, const SlabChoice& choice,
                     double max_error);

// For programs: one object, or for several models {"models": [...]} of objects with a "model" each.
std::string slabJson(const SlabQuestion& question, const std::vector<ModelAnswer>& answers);

}  // namespace sunfleck::apps
