#include "apps/sweep_journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "core/require.hpp"
#include "core/whole_file.hpp"

namespace sunfleck::apps {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kExtension = ".rows";
constexpr std::size_t kSumLength = 8;

std::string checkSum(std::string_view text) {
  return fmt::format("{:08x}", crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size()));
}

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!in) throw InvalidInput(file.string() + ": cannot be read");
  return text;
}

}  // namespace

SweepJournal::SweepJournal(const fs::path& table) : table_(table) {
  const fs::path folder = table.has_parent_path() ? table.parent_path() : fs::path(".");
  const std::string name = table.filename().string();
  std::error_code failure;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure)) {
    const std::string file = entry.path().filename().string();
    if (file.starts_with(name + ".") && file.ends_with(kExtension) && entry.is_regular_file(failure))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) read(file);
}

void SweepJournal::read(const fs::path& file) {
  const std::string text = textOf(file);
  std::string_view left = text;
  for (std::size_t number = 1, end; (end = left.find('\n')) != std::string_view::npos; ++number) {
    const std::string_view line = left.substr(0, end);
    left.remove_prefix(end + 1);
    const std::string_view row = line.substr(std::min(line.size(), kSumLength + 1));
    const std::size_t space = row.find(' ');
    if (space == std::string_view::npos || line.substr(0, kSumLength) != checkSum(row))
      damaged_.push_back(fmt::format("{}:{}", file.string(), number));
    else
      rows_.emplace(row.substr(0, space), row.substr(space + 1));
  }
}

void SweepJournal::open(const RunPart& part) {
  own_ = table_;
  if (part.of > 1) own_ += fmt::format(".{}of{}", part.number + 1, part.of);
  own_ += kExtension;
  requireWritable(own_);
  lock_ = std::make_unique<TraceLock>(own_);
  // What was not finished must not run into the next line.
  if (!fs::exists(own_)) return;
  const std::string text = textOf(own_);
  const std::size_t end = text.rfind('\n');
  fs::resize_file(own_, end == std::string::npos ? 0 : end + 1);
}

void SweepJournal::add(const std::vector<FinishedRow>& rows) {
  std::string text;
  for (const FinishedRow& row : rows) {
    const std::string line = row.key + ' ' + row.figures;
    text += checkSum(line) + ' ' + line + '\n';
    rows_.emplace(row.key, row.figures);
  }
  const int file = ::open(own_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  bool written = file >= 0;
  for (std::string_view left = text; written && !left.empty();) {
    const ssize_t count = write(file, left.data(), left.size());
    written = count >= 0 || errno == EINTR;
    left.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  }
  written = written && (fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP);
  const int reason = errno;
  if (file >= 0) close(file);
  if (!written)
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", own_.string(), std::strerror(reason)));
}

const std::string* SweepJournal::find(const std::string& key) const {
  const auto found = rows_.find(key);
  return found == rows_.end() ? nullptr : &found->second;
}

}  // namespace sunfleck::apps
