#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <glm/mat3x3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "plants/detail/part_opacity.hpp"
#include "plants/import.hpp"

namespace sunfleck::detail {

// What a glTF material means for leaves.
struct GltfMaterial {
  std::string name;
  std::optional<glm::vec3> colour;      // where no image tells it [1]
  std::optional<Opacity> opacity;       // of alphaMode MASK or BLEND
  int texture_coordinates = 0;          // which of a mesh's its image takes
  glm::dmat3 to_image{1.};              // of KHR_texture_transform, from a mesh's coordinates, v down
  std::optional<FileLeafColours> leaf;  // of KHR_materials_diffuse_transmission without images
};

// Of each of the model's. Throws InvalidInput("<source>: ...") on an image of opacity whose bytes are not in the file.
std::vector<GltfMaterial> gltfMaterials(const tinygltf::Model& model, const std::filesystem::path& folder,
                                        const std::string& source);

}  // namespace sunfleck::detail
