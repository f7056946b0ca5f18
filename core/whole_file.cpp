#include "core/whole_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "core/require.hpp"

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void cannotWrite(const fs::path& path, const std::string& reason) {
  throw InvalidInput(path.string() + ": cannot be written: " + reason);
}

fs::path folderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// Removes the temporary file unless it has been renamed away.
struct Temporary {
  fs::path path;
  ~Temporary() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

}  // namespace

void requireWritable(const fs::path& path) {
  std::error_code failure;
  if (path.empty() || !path.has_filename()) cannotWrite(path, "it names no file");
  if (fs::is_directory(path, failure)) cannotWrite(path, "it is a folder");
  if (fs::exists(path, failure) && !fs::is_regular_file(path, failure)) cannotWrite(path, "it is no regular file");
  if (!fs::is_directory(folderOf(path), failure)) cannotWrite(path, "there is no folder " + folderOf(path).string());
  if (access(folderOf(path).c_str(), W_OK | X_OK) != 0) cannotWrite(path, std::strerror(errno));
}

void requireNamed(const fs::path& path, std::string_view extension) {
  if (path.extension() != extension)
    throw InvalidInput(path.string() + ": must be named with the extension " + std::string(extension));
  requireWritable(path);
}

void writeWhole(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  requireWritable(path);
  std::error_code failure;
  // Through a symbolic link it is the file behind it that is replaced.
  const fs::path target = fs::is_symlink(path, failure) ? fs::weakly_canonical(path) : path;
  const Temporary temporary{folderOf(target) /
                            ("." + path.stem().string() + "." + std::to_string(getpid()) + path.extension().string())};
  write(temporary.path);
  fs::rename(temporary.path, target, failure);
  if (failure) cannotWrite(path, failure.message());
}

void writeWhole(const fs::path& path, std::string_view text) {
  writeWhole(path, [&](const fs::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) cannotWrite(path, std::strerror(errno));
  });
}

}  // namespace sunfleck
