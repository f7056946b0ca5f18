#include "render/reference/trace_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include "core/require.hpp"
#include "core/whole_file.hpp"

namespace sunfleck {

// A file beside the trace file that one process at a time holds locked. The system lets go of it however the process
// ends.
class TraceStore::Lock {
 public:
  explicit Lock(const std::filesystem::path& file) : path_(file.string() + ".lock") {
    // Whoever had the lock removes the file: what was opened may no longer be what the name stands for.
    for (struct stat opened{}, named{};;) {
      file_ = open(path_.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
      if (file_ < 0) throw InvalidInput(file.string() + ": cannot be written: " + std::strerror(errno));
      if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
        close(file_);
        throw InvalidInput(file.string() + ": in use by another process: must be one process's alone");
      }
      if (fstat(file_, &opened) == 0 && stat(path_.c_str(), &named) == 0 && opened.st_ino == named.st_ino) return;
      close(file_);
    }
  }
  ~Lock() {
    unlink(path_.c_str());
    close(file_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  std::string path_;
  int file_ = -1;
};

TraceStore::TraceStore(std::filesystem::path file, double seconds_between_writes, TraceIdentity run)
    : file_(std::move(file)), seconds_between_(seconds_between_writes), run_(std::move(run)) {
  requireWritable(file_);
  lock_ = std::make_unique<Lock>(file_);
  if (std::filesystem::exists(file_)) sections_ = readTraceFile(file_);
}

TraceStore::TraceStore() = default;
TraceStore::~TraceStore() = default;
TraceStore::TraceStore(TraceStore&&) noexcept = default;
TraceStore& TraceStore::operator=(TraceStore&&) noexcept = default;

const TraceIdentity* TraceStore::identity(const std::string& name) const {
  const auto found = std::find_if(sections_.begin(), sections_.end(), [&](const auto& s) { return s.name == name; });
  return found == sections_.end() ? nullptr : &found->identity;
}

TraceSection& TraceStore::section(const std::string& name, const TraceJob& job) {
  TraceIdentity identity = job.identity();
  identity.insert(run_.begin(), run_.end());
  for (TraceSection& section : sections_) {
    if (section.name != name) continue;
    requireSame(file_, section.identity, identity);
    if (section.sums.bins() != job.bins() || section.sums.groups() != job.groups())
      throw InvalidInput(file_.string() + ": damaged: it has other bins than its estimator");
    return section;
  }
  return sections_.emplace_back(TraceSection{name, std::move(identity), TraceSums(job.bins(), job.groups())});
}

void TraceStore::write() {
  if (!lock_) return;
  writeTraceFile(file_, sections_);
  written_ = std::chrono::steady_clock::now();
}

void TraceStore::writeIfDue() {
  if (std::chrono::duration<double>(std::chrono::steady_clock::now() - written_).count() >= seconds_between_) write();
}

}  // namespace sunfleck
