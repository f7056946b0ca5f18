# Writes OUTPUT, a C++ file that holds the FILES (paths below ROOT) as text, so that an installed program needs none of
# them: std::span<const TYPE> FUNCTION(), each with a path and a text, in NAMESPACE, as HEADER declares it.
# cmake -D ROOT=... -D OUTPUT=... -D HEADER=... -D NAMESPACE=... -D TYPE=... -D FUNCTION=... -D "FILES=a;b"
#   -P embed_texts.cmake
set(entries "")
foreach(file IN LISTS FILES)
  file(READ "${ROOT}/${file}" text)
  string(APPEND entries "    {\"${file}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "// Made by cmake/embed_texts.cmake from the files it names.
#include \"${HEADER}\"

namespace ${NAMESPACE} {
namespace {
constexpr ${TYPE} kTexts[] = {
${entries}};
}  // namespace
std::span<const ${TYPE}> ${FUNCTION}() {
  return kTexts;
}
}  // namespace ${NAMESPACE}
")
