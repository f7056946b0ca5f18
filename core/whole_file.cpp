#include "core/whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "core/require.hpp"

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void cannotWrite(const fs::path& path, const std::string& reason) {
  throw InvalidInput(path.string() + ": cannot be written: " + reason);
}

// Waits until a file, or the names in a folder, are on the disk; `path` is what the user calls it. Not every file
// system can tell.
void sync(const fs::path& file, const fs::path& path) {
  const int opened = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (opened < 0) return;
  const int status = fsync(opened), reason = errno;
  close(opened);
  if (status != 0 && reason != EINVAL && reason != ENOTSUP) cannotWrite(path, std::strerror(reason));
}

fs::path folderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// Beside `path`, and of the same extension.
fs::path temporaryFor(const fs::path& path) {
  std::string name(".");
  name.append(path.stem().string()).append(".").append(std::to_string(getpid())).append(path.extension().string());
  return folderOf(path) / name;
}

// Path of the file that is being written, where a signal's handler finds it: empty when there is none.
std::array<char, 4096> unfinished{};
std::atomic<bool> is_unfinished{false};
static_assert(std::atomic<bool>::is_always_lock_free);

// Names of folders, one after the other, each ended by a zero, and a zero at the end.
std::array<char, 4096> folders{};
std::atomic<bool> has_folders{false};

// Removes the temporary file unless it has been renamed away.
struct Temporary {
  fs::path path;
  explicit Temporary(fs::path made) : path(std::move(made)) {
    const std::string& name = path.native();
    if (name.size() >= unfinished.size()) return;
    *std::copy(name.begin(), name.end(), unfinished.begin()) = '\0';
    is_unfinished = true;
  }
  ~Temporary() {
    is_unfinished = false;
    std::error_code ignored;
    fs::remove(path, ignored);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
};

}  // namespace

void removeWhenEmpty(std::span<const fs::path> made) {
  has_folders = false;
  char* at = folders.data();
  for (const fs::path& folder : made) {
    const std::string name = fs::absolute(folder).native();
    if (name.size() + 2 > static_cast<std::size_t>(folders.data() + folders.size() - at)) break;
    at = std::copy(name.begin(), name.end(), at);
    *at++ = '\0';
  }
  *at = '\0';
  has_folders = !made.empty();
}

void removeUnfinished() noexcept {
  if (is_unfinished) unlink(unfinished.data());
  if (!has_folders) return;
  for (const char* name = folders.data(); *name != '\0'; name += std::strlen(name) + 1) rmdir(name);
}

void requireWritable(const fs::path& path) {
  std::error_code failure;
  if (path.empty() || !path.has_filename()) cannotWrite(path, "it names no file");
  if (fs::is_directory(path, failure)) cannotWrite(path, "it is a folder");
  if (fs::exists(path, failure) && !fs::is_regular_file(path, failure)) cannotWrite(path, "it is no regular file");
  if (!fs::is_directory(folderOf(path), failure)) cannotWrite(path, "there is no folder " + folderOf(path).string());
  // Permissions do not tell all: not every file system takes files, nor every name.
  const fs::path tried = temporaryFor(path);
  const int file = open(tried.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
  if (file < 0 && errno != EEXIST) cannotWrite(path, std::strerror(errno));
  if (file < 0) return;
  close(file);
  fs::remove(tried, failure);
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
  const Temporary temporary(temporaryFor(target));
  write(temporary.path);
  sync(temporary.path, path);
  fs::rename(temporary.path, target, failure);
  if (failure) cannotWrite(path, failure.message());
  sync(folderOf(target), path);
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
