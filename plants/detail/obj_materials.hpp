#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "plants/detail/part_opacity.hpp"

namespace sunfleck::detail {

// What an OBJ's .mtl files say of its materials, by name.
struct ObjMaterials {
  std::map<std::string, glm::vec3, std::less<>> colours;  // diffuse [1]
  std::map<std::string, Opacity, std::less<>> opacities;  // of those that are not there all over
  std::string missing;                                    // a remark on material files that are not there
};

// `named`: what follows each mtllib of the OBJ: one name that may hold blanks, or several. Throws
// InvalidInput("<file>: ...") on a file of more than 10,000 materials.
ObjMaterials readObjMaterials(const std::filesystem::path& folder, const std::vector<std::string_view>& named);

}  // namespace sunfleck::detail
