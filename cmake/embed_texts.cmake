# Writes OUTPUT, a C++ file that holds the FILES (paths below ROOT) as text, so that an installed program needs none of
# them: cmake -D ROOT=... -D OUTPUT=... -D "FILES=a;b" -P embed_texts.cmake
set(entries "")
foreach(file IN LISTS FILES)
  file(READ "${ROOT}/${file}" text)
  string(APPEND entries "    {\"${file}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "// Made by cmake/embed_texts.cmake from the files it names.
#include \"render/gl/detail/embedded_text.hpp\"

namespace sunfleck::gl::detail {
namespace {
constexpr EmbeddedText kTexts[] = {
${entries}};
}  // namespace
std::span<const EmbeddedText> embeddedTexts() {
  return kTexts;
}
}  // namespace sunfleck::gl::detail
")
