#include "apps/output_folder.hpp"

#include "core/require.hpp"

namespace sunfleck::apps {

void makeFolder(const std::filesystem::path& folder) {
  if (folder.empty()) throw InvalidInput("-o: must not be empty");
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw InvalidInput(folder.string() + ": cannot be made: " + failure.message());
}

}  // namespace sunfleck::apps
