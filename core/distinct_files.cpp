#include "core/distinct_files.hpp"

#include <system_error>

#include "core/require.hpp"

namespace sunfleck {

void requireOther(const std::filesystem::path& output, const std::filesystem::path& other) {
  if (output.empty() || other.empty()) return;
  std::error_code failure;
  if (std::filesystem::equivalent(output, other, failure) ||
      std::filesystem::weakly_canonical(output, failure) == std::filesystem::weakly_canonical(other, failure))
    throw InvalidInput(output.string() + ": must be another file than " + other.string() + ", which it would replace");
}

}  // namespace sunfleck
