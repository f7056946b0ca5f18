#include "grid/isolated_read.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/available_memory.hpp"
#include "core/require.hpp"

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

constexpr int kWrongInput = 2;
constexpr int kPatience = 100;              // [ms] between two looks at the clock
constexpr std::size_t kLongestWord = 4096;  // of what the reader says [byte]
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {
    if (number < 0) throw std::runtime_error(std::string("no process can be started: ") + std::strerror(errno));
  }
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

// A process that is ended with its owner.
class Child {
 public:
  Child(const std::string& program, std::array<std::string, 5> words, int output, int errors) {
    std::array<char*, 7> arguments{};
    std::string name = "sunfleck";
    arguments[0] = name.data();
    for (std::size_t i = 0; i < words.size(); ++i) arguments[i + 1] = words[i].data();
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, errors, STDERR_FILENO);
    const int failure = posix_spawn(&process_, program.c_str(), &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (failure != 0) throw std::runtime_error(program + ": cannot be started: " + std::strerror(failure));
  }
  ~Child() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    status();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Waits for its end.
  int status() {
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
  }

 private:
  pid_t process_ = -1;
};

// All that the child says before it ends; nothing when that takes longer than `seconds`.
std::optional<std::string> heard(int from, double seconds, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  std::string text;
  for (;;) {
    if (!goOn(progress, 0.)) throw std::runtime_error("interrupted");
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > seconds) return std::nullopt;
    pollfd ready{.fd = from, .events = POLLIN, .revents = 0};
    if (poll(&ready, 1, kPatience) <= 0) continue;
    std::array<char, 512> part;
    const ssize_t count = read(from, part.data(), part.size());
    if (count == 0) return text;
    if (count > 0 && text.size() < kLongestWord) text.append(part.data(), static_cast<std::size_t>(count));
  }
}

void limit(__rlimit_resource resource, std::uint64_t most) {
  rlimit now{};
  getrlimit(resource, &now);
  now.rlim_cur = std::min<rlim_t>(now.rlim_cur, most);
  setrlimit(resource, &now);
}

std::uint64_t addressSpace() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

int wrong(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  return kWrongInput;
}

}  // namespace

DensityGrid readIsolated(const fs::path& file, const Progress& progress, const IsolatedReader& reader) {
  std::error_code none;
  const std::uintmax_t size = fs::is_regular_file(file, none) ? fs::file_size(file, none) : 0;
  const double seconds = reader.seconds > 0. ? reader.seconds : 60. + 1e-6 * static_cast<double>(size);
  const std::uint64_t bytes = reader.bytes > 0 ? reader.bytes : static_cast<std::uint64_t>(availableMemory());
  const auto refuse = [&](const std::string& why) -> InvalidInput { return InvalidInput(file.string() + ": " + why); };

  const Descriptor output(memfd_create("grid", MFD_CLOEXEC));
  std::array<int, 2> ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) ends = {-1, -1};
  const Descriptor words(ends[0]);
  Descriptor errors(ends[1]);
  Child child(reader.program,
              {"read-grid", file.string(), "/proc/self/fd/" + std::to_string(STDOUT_FILENO), std::to_string(bytes),
               std::to_string(static_cast<std::uint64_t>(std::ceil(seconds)))},
              output.get(), errors.get());
  errors.close();
  const auto too_long = [&] {
    return refuse("takes more than " + std::to_string(static_cast<int>(std::ceil(seconds))) + " s to read");
  };
  std::optional<std::string> said = heard(words.get(), seconds, progress);
  if (!said) throw too_long();
  const int status = child.status();
  if (!goOn(progress, 0.)) throw std::runtime_error("interrupted");  // the reader has heard it too
  said->resize(std::min(said->find('\n'), said->size()));
  if (WIFSIGNALED(status)) {
    if (WTERMSIG(status) == SIGXCPU) throw too_long();
    throw refuse("is corrupt, or needs more memory than there is: reading it ended by signal " +
                 std::to_string(WTERMSIG(status)) + ", " + strsignal(WTERMSIG(status)));
  }
  if (WEXITSTATUS(status) == kWrongInput) throw InvalidInput(*said);
  if (WEXITSTATUS(status) != 0) throw std::runtime_error(file.string() + ": could not be read: " + *said);
  const fs::path made("/proc/self/fd/" + std::to_string(output.get()));
  try {
    return DensityGrid::read(made);
  } catch (const InvalidInput& e) {
    throw refuse("is read as a grid that " + std::string(e.what()).substr(made.string().size() + 2));
  }
}

int serveIsolatedRead(const fs::path& file, const fs::path& output, std::uint64_t bytes, std::uint64_t seconds) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, seconds);
  limit(RLIMIT_FSIZE, bytes);
  if (!kSanitized) limit(RLIMIT_AS, addressSpace() + bytes);
  // Threads would reserve address space, each some 100 MB.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  try {
    DensityGrid::read(file).writeOver(output);
    return 0;
  } catch (const InvalidInput& e) {
    return wrong(e.what());
  } catch (const std::bad_alloc&) {
    return wrong(file.string() + ": needs more memory than there is");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}

}  // namespace sunfleck
