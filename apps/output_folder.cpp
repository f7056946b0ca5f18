#include "apps/output_folder.hpp"

#include <system_error>

#include "core/require.hpp"
#include "core/whole_file.hpp"

namespace sunfleck::apps {
namespace fs = std::filesystem;

OutputFolder::OutputFolder(const fs::path& folder) {
  if (folder.empty()) throw InvalidInput("-o: must not be empty");
  std::error_code failure;
  for (fs::path above = folder; !above.empty() && !fs::exists(above, failure); above = above.parent_path())
    made_.push_back(above);
  fs::create_directories(folder, failure);
  if (failure) throw InvalidInput(folder.string() + ": cannot be made: " + failure.message());
  removeWhenEmpty(made_);
}

OutputFolder::~OutputFolder() {
  removeWhenEmpty({});
  std::error_code not_empty;
  for (const fs::path& folder : made_) fs::remove(folder, not_empty);
}

}  // namespace sunfleck::apps
