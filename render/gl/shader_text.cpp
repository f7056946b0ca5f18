#include "render/gl/shader_text.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "render/gl/detail/embedded_text.hpp"

namespace sunfleck::gl {

std::string shaderText(std::string_view path, std::string_view model) {
  const auto texts = detail::embeddedTexts();
  const auto found = std::ranges::find(texts, path, &detail::EmbeddedText::path);
  if (found == texts.end()) throw std::logic_error("no shader text " + std::string(path));

  constexpr std::string_view include = "#include \"";
  std::istringstream in{std::string(found->text)};
  std::string result;
  int line_number = 0;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    const bool of_model = line == "#include MODEL";
    if (of_model || line.starts_with(include)) {
      const std::string_view named =
          of_model ? model : std::string_view(line).substr(include.size(), line.rfind('"') - include.size());
      result += "#line 1\n" + shaderText(named, model);
      result += "#line " + std::to_string(line_number + 1) + "\n";
    } else {
      result += line + "\n";
    }
  }
  return result;
}

}  // namespace sunfleck::gl
