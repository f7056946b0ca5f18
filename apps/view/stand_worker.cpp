#include "apps/view/stand_worker.hpp"

#include <algorithm>
#include <utility>

#include "core/require.hpp"

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
  result_.reset();
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
    cancelled_ = superseded_ = false;
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
    if (!cancelled_ && !superseded_ && failure) failure_ = failure;
  }
}

bool StandWorker::tell(double done) {
  const std::lock_guard lock(mutex_);
  done_ = done;
  return !cancelled_;
}

void StandWorker::begin(const std::string& part) {
  const std::lock_guard lock(mutex_);
  what_ = part;
  done_ = 0.;
}

void StandWorker::update(const StandWish& wish) {
  bool field_begun = false;
  const auto of_field = [&](double done) {
    if (!std::exchange(field_begun, true)) begin(wish.needs.preview ? "preview of the light field" : "light field");
    if (!tell(done)) return false;
    const std::lock_guard lock(mutex_);
    // A preview is what is seen while wishes come one after the other.
    superseded_ = !wish.needs.preview && wish_.has_value();
    return !superseded_;
  };
  geometry_->update(
      wish.scene, wish.needs, std::nullopt, [this](double done) { return tell(done); }, of_field);
}

void StandWorker::makeLevels(const Progress& progress) {
  std::vector<MeshLevels> levels;
  for (const StandKind& kind : geometry_->kinds()) {
    MeshLevels& of_kind = levels.emplace_back(MeshLevels{kind.mesh, {}});
    const auto known = std::ranges::find(levels_, kind.mesh, &MeshLevels::mesh);
    if (known != levels_.end()) of_kind.levels = known->levels;
  }
  double done = 0.;
  for (MeshLevels& of_kind : levels) {
    done += 1. / static_cast<double>(levels.size());
    if (!of_kind.mesh || of_kind.levels) continue;
    of_kind.levels = std::make_shared<const gl::TreeLevels>(gl::treeLevels(*of_kind.mesh));
    requireGoOn(progress, done);
  }
  levels_ = std::move(levels);
}

void StandWorker::make(StandWish wish) {
  const auto start = Clock::now();
  leaves_.make(wish.scene.kinds, wish.scene.bands);
  const bool from_nothing = !geometry_ || geometry_->effort() != wish.effort;
  if (from_nothing) geometry_ = std::make_unique<StandGeometry>(wish.effort);
  const auto progress = [this](double done) { return tell(done); };
  wish.needs.preview = wish.needs.field && !wish.previewed && !geometry_->fieldUpToDate(wish.scene);
  try {
    update(wish);
  } catch (const InvalidInput&) {  // such as a stand too wide for cells: then there is no preview
    if (!std::exchange(wish.needs.preview, false)) throw;
    update(wish);
  }
  const double seconds = secondsSince(start);
  begin("levels of detail");
  makeLevels(progress);
  if (wish.exact) {
    begin("tables of the exact solution");
    tables_.make(wish.scene.kinds, progress);
  }
  Result result{.made = std::move(wish),
                .geometry = geometry_.get(),
                .levels = {},
                .costs = geometry_->lastCosts(),
                .seconds = seconds,
                .from_nothing = from_nothing};
  result.costs.push_back(leaves_.lastCost());
  for (const MeshLevels& of_kind : levels_) result.levels.push_back(of_kind.levels);
  const std::lock_guard lock(mutex_);
  if (result.made.needs.preview && !wish_) {
    wish_ = result.made;
    wish_->previewed = true;
  }
  result_ = std::move(result);
}

}  // namespace sunfleck::view
