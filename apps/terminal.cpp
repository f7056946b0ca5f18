#include "apps/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>

#include "core/whole_file.hpp"

namespace sunfleck::apps {
namespace {

std::atomic<bool> interrupt_seen{false};
static_assert(std::atomic<bool>::is_always_lock_free);

using Clock = std::chrono::steady_clock;

struct Bar {
  std::string label;
  Clock::time_point started = Clock::now(), drawn{};
  int percent = -1;

  void draw(double done) {
    const auto now = Clock::now();
    const int now_percent = static_cast<int>(100. * done);
    if (now_percent == percent || (now - drawn < std::chrono::milliseconds(100) && done < 1.)) return;
    percent = now_percent;
    drawn = now;
    const double elapsed = std::chrono::duration<double>(now - started).count();
    const int filled = now_percent / 4;
    fmt::print(stderr, "\r{:<22} [{:<25}] {:3} %  {:.0f} s{}", label,
               std::string(static_cast<std::size_t>(filled), '#'), now_percent,
               done > 0.02 ? elapsed / done - elapsed : elapsed, done > 0.02 ? " left " : "      ");
    std::fflush(stderr);
  }
  void erase() const { fmt::print(stderr, "\r{:<70}\r", ""); }
  ~Bar() {
    if (percent >= 0) erase();
  }
};

}  // namespace

void catchInterrupts() {
  struct sigaction action {};
  action.sa_handler = [](int signal) {
    if (!interrupt_seen.exchange(true)) return;
    removeUnfinished();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() {
  return interrupt_seen;
}

Progress terminalProgress(const std::string& label, bool quiet) {
  if (quiet || !isatty(STDERR_FILENO)) return [](double) { return !interrupt_seen; };
  auto bar = std::make_shared<Bar>(Bar{label});
  return [bar](double done) {
    bar->draw(done);
    return !interrupt_seen;
  };
}

}  // namespace sunfleck::apps
