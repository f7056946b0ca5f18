#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/tree_mesh.hpp"

namespace sunfleck::apps {

// One-sided area of the leaves' cards, and what their images leave of it; 0 where there are none [m^2].
struct CardAreas {
  double before = 0., after = 0.;
};

// What `plant` tells of a tree.
class PlantReport {
 public:
  //   how      how leaf and wood were told apart; empty of a grown tree
  //   dropped  triangles of no area that a file held
  PlantReport(const TreeMesh& mesh, std::string source, std::string how, const Dropped& dropped,
              const CardAreas& cards = {});

  double leafArea() const { return area_; }  // [m^2]
  nlohmann::ordered_json json() const;
  std::string text() const;  // lines for people

 private:
  const TreeMesh& mesh_;
  std::string source_, how_;
  Dropped dropped_;
  CardAreas cards_;
  double area_, lai_;                   // [m^2], [1]
  double mean_depth_, mean_thickness_;  // of the leaves, light from overhead [1]
};

}  // namespace sunfleck::apps
