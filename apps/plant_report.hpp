#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/tree_mesh.hpp"

namespace sunfleck::apps {

// What `plant` tells of a tree.
class PlantReport {
 public:
  //   how      how leaf and wood were told apart; empty of a grown tree
  //   dropped  triangles of no area that a file held
  PlantReport(const TreeMesh& mesh, std::string source, std::string how, const Dropped& dropped);

  double leafArea() const { return area_; }  // [m^2]
  nlohmann::ordered_json json() const;
  std::string text() const;  // lines for people

 private:
  const TreeMesh& mesh_;
  std::string source_, how_;
  Dropped dropped_;
  double area_, lai_;                   // [m^2], [1]
  double mean_depth_, mean_thickness_;  // of the leaves, light from overhead [1]
};

}  // namespace sunfleck::apps
