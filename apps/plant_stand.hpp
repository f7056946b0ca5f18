#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/scene.hpp"

namespace sunfleck::apps {

// How `plant` arranges a stand.
struct PlantStand {
  std::string kind;         // regular, jittered, poisson, or a .csv of positions; empty: one tree
  std::vector<float> area;  // sides of the rectangle [m]
  float spacing = 0.f;      // [m]; 0: the crowns' width
  float jitter = 0.5f;      // of jittered, over half of the spacing [1]
};

// A scene of such trees. A .csv has the header x,y or x,y,rotation_deg or x,y,rotation_deg,species; without a species a
// tree is one of `first`, whose leaf optics all have. Throws InvalidInput on what is wrong, a file with its line.
Scene plantStand(const PlantStand& stand, TreeKind first, std::uint64_t seed);

// The stand in a scene file (.toml), or as glTF (.glb, .gltf).
void writeStand(const std::string& file, const Scene& scene);

}  // namespace sunfleck::apps
