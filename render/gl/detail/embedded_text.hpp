#pragma once

#include <span>
#include <string_view>

namespace sunfleck::gl::detail {

// A file of the repository that the program carries within it.
struct EmbeddedText {
  std::string_view path;  // from the repository's root
  std::string_view text;
};
std::span<const EmbeddedText> embeddedTexts();

}  // namespace sunfleck::gl::detail
