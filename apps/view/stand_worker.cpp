#include "apps/view/stand_worker.hpp"

#include <utility>

namespace sunfleck::view {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

StandWorker::StandWorker() : thread_([this] { work(); }) {}

StandWorker::~StandWorker() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = cancelled_ = true;
    tasks_.clear();
    wish_.reset();
  }
  changed_.notify_all();
  thread_.join();
}

void StandWorker::wish(StandWish wish) {
  {
    const std::lock_guard lock(mutex_);
    wish_ = std::move(wish);
  }
  changed_.notify_all();
}

void StandWorker::run(std::string name, std::function<void()> work) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back({std::move(name), std::move(work)});
  }
  changed_.notify_all();
}

void StandWorker::cancel() {
  const std::lock_guard lock(mutex_);
  cancelled_ = working_;
  tasks_.clear();
  wish_.reset();
}

std::optional<StandWorker::Result> StandWorker::take() {
  const std::lock_guard lock(mutex_);
  if (!result_) return std::nullopt;
  lent_ = true;
  return std::exchange(result_, std::nullopt);
}

void StandWorker::release() {
  {
    const std::lock_guard lock(mutex_);
    lent_ = false;
  }
  changed_.notify_all();
}

std::exception_ptr StandWorker::failure() {
  const std::lock_guard lock(mutex_);
  return std::exchange(failure_, nullptr);
}

StandWorker::State StandWorker::state() const {
  const std::lock_guard lock(mutex_);
  const bool busy = working_ || wish_ || !tasks_.empty() || result_ || lent_;
  return {.busy = busy, .done = done_, .what = what_, .seconds = working_ ? secondsSince(began_) : 0.};
}

void StandWorker::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    // What is lent or waits to be taken must stay as it is.
    changed_.wait(lock, [this] { return ends_ || !tasks_.empty() || (wish_ && !lent_ && !result_); });
    if (ends_) return;
    Task task;
    if (!tasks_.empty()) {
      task = std::move(tasks_.front());
      tasks_.erase(tasks_.begin());
    } else {
      task = {"light and trees",
              [this, wish = std::make_shared<StandWish>(std::move(*wish_))] { make(std::move(*wish)); }};
      wish_.reset();
    }
    working_ = true;
    cancelled_ = false;
    what_ = task.name;
    done_ = 0.;
    began_ = Clock::now();
    lock.unlock();
    std::exception_ptr failure;
    try {
      task.work();
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    working_ = false;
    if (!cancelled_ && failure) failure_ = failure;
  }
}

void StandWorker::make(StandWish wish) {
  const auto start = Clock::now();
  const auto same = [](const GeometryEffort& a, const GeometryEffort& b) {
    return a.light_resolution == b.light_resolution && a.sample_directions == b.sample_directions &&
           a.sample_resolution == b.sample_resolution && a.cells == b.cells;
  };
  if (!geometry_ || !same(effort_, wish.effort)) geometry_ = std::make_unique<StandGeometry>(wish.effort);
  effort_ = wish.effort;
  geometry_->update(wish.scene, wish.needs, std::nullopt, [this](double done) {
    const std::lock_guard lock(mutex_);
    done_ = done;
    return !cancelled_;
  });
  Result result{.made = std::move(wish),
                .geometry = geometry_.get(),
                .costs = geometry_->lastCosts(),
                .seconds = secondsSince(start)};
  const std::lock_guard lock(mutex_);
  result_ = std::move(result);
}

}  // namespace sunfleck::view
