#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/view/document.hpp"
#include "apps/view/exact_tables.hpp"
#include "apps/view/made_leaves.hpp"
#include "render/gl/tree_levels.hpp"

namespace sunfleck::view {

// What the worker is to make: whole, so that it needs nothing else.
struct StandWish {
  Scene scene;
  GeometryNeeds needs;  // the worker says whether the field's preview comes first
  GeometryEffort effort;
  bool exact = false;          // with tables of the exact solution for its leaves
  std::uint64_t revision = 0;  // of the wisher's, given back with the result
  bool previewed = false;      // whether there was a result with a preview of the field
};

// Reads scenes and grows trees and brings a stand's geometry up to date, on a thread of its own, which alone works on
// the geometry. What is wished for while it works waits; of several wishes the last counts. A light field that takes
// work is made twice, each time with a result: on cells at once, then along lines, which another wish ends.
class StandWorker {
 public:
  // What the geometry holds now. Until release() it stays as it is, and its receiver alone reads it.
  struct Result {
    StandWish made;  // with what follows from its leaves' textures
    const StandGeometry* geometry = nullptr;
    std::vector<std::shared_ptr<const gl::TreeLevels>> levels;  // of each of the geometry's kinds that stands
    std::vector<ProductCost> costs;                             // of this update alone
    double seconds = 0.;                                        // wall time of leaf maps and geometry
    bool from_nothing = false;                                  // it held nothing before
  };

  StandWorker();
  ~StandWorker();  // cancels what is under way and waits for its end
  StandWorker(const StandWorker&) = delete;
  StandWorker& operator=(const StandWorker&) = delete;

  void wish(StandWish wish);
  // Long work besides, in turn, before what is wished for: such as reading a file. `name` tells people what it is.
  void run(std::string name, std::function<void()> work);
  // Ends what is under way early and forgets what waits.
  void cancel();

  // The result that is there, if one is; none before it has been made.
  std::optional<Result> take();
  void release();
  // What went wrong since it was last asked, such as InvalidInput; none if nothing did, or it was cancelled.
  std::exception_ptr failure();

  struct State {
    bool busy = false;  // working, or about to
    double done = 0.;   // share of what is under way
    std::string what;
    double seconds = 0.;  // since it began
  };
  State state() const;
  ExactTables& tables() { return tables_; }

 private:
  struct Task {
    std::string name;
    std::function<void()> work;
  };

  void work();
  void make(StandWish wish);
  void update(const StandWish& wish);
  void makeLevels(const Progress& progress);
  void begin(const std::string& part);  // of the work under way
  bool tell(double done);               // whether to go on

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Task> tasks_;
  std::optional<StandWish> wish_;
  std::optional<Result> result_;
  bool lent_ = false, working_ = false, cancelled_ = false, superseded_ = false, ends_ = false;
  std::exception_ptr failure_;
  std::string what_;
  double done_ = 0.;
  std::chrono::steady_clock::time_point began_;

  std::unique_ptr<StandGeometry> geometry_;  // the thread's own, but while it is lent
  struct MeshLevels {
    std::shared_ptr<const TreeMesh> mesh;
    std::shared_ptr<const gl::TreeLevels> levels;
  };
  std::vector<MeshLevels> levels_;  // of each of the geometry's kinds
  MadeLeaves leaves_;
  ExactTables tables_;
  std::thread thread_;
};

}  // namespace sunfleck::view
