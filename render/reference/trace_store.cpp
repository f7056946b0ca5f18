#include "render/reference/trace_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/available_memory.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"

namespace sunfleck {

TraceLock::TraceLock(const std::filesystem::path& file)
    : path_(std::filesystem::weakly_canonical(file).string() + ".lock") {
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

TraceLock::~TraceLock() {
  unlink(path_.c_str());
  close(file_);
}

TraceStore::TraceStore(std::filesystem::path file, double seconds_between_writes, TraceIdentity run)
    : path_(std::move(file)), seconds_between_(seconds_between_writes) {
  requireWritable(path_);
  lock_ = std::make_unique<TraceLock>(path_);
  if (std::filesystem::exists(path_)) {
    file_ = readTraceFile(path_);
    requireSame(path_, file_.run, run);
  }
  file_.run = std::move(run);
}

const TraceIdentity* TraceStore::identity(const std::string& name) {
  const TraceSection* section = file_.find(name);
  return section ? &section->identity : nullptr;
}

TraceSection& TraceStore::section(const std::string& name, const TraceJob& job) {
  if (TraceSection* section = file_.find(name)) {
    requireSame(path_, section->identity, job.identity());
    if (section->sums.bins() != job.bins() || section->sums.groups() != job.groups())
      throw InvalidInput(path_.string() + ": damaged: it has other bins than its estimator");
    return *section;
  }
  const double bytes = static_cast<double>(job.bins()) * (sizeof(TraceSums::Bin) + sizeof(double));
  require(bytes <= availableMemory(), "bytes of memory for what is to be found, " + name, bytes,
          "at most what is free, " + std::to_string(static_cast<std::uint64_t>(availableMemory())));
  return file_.sections.emplace_back(
      TraceSection{.name = name, .identity = job.identity(), .sums = TraceSums(job.bins(), job.groups())});
}

void TraceStore::write() {
  if (!lock_) return;
  written_ = std::chrono::steady_clock::now();
  try {
    writeTraceFile(path_, file_);
    failure_.clear();
  } catch (const InvalidInput& e) {
    failure_ = e.what();
  }
}

void TraceStore::writeIfDue() {
  if (std::chrono::duration<double>(std::chrono::steady_clock::now() - written_).count() >= seconds_between_) write();
}

}  // namespace sunfleck
