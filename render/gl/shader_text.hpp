#pragma once

#include <string>
#include <string_view>

namespace sunfleck::gl {

// The text of a shader file of the repository (such as "render/gl/shade.frag"), which the program carries within it,
// with the files it includes in their places. Throws std::logic_error when there is no such file.
//   model  the file that stands for MODEL in "#include MODEL"
std::string shaderText(std::string_view path, std::string_view model = {});

}  // namespace sunfleck::gl
