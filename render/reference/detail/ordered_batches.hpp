#pragma once

#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <type_traits>

namespace sunfleck::detail {

using Stopped = std::atomic<bool>;

// Runs work(i, stopped) for i = 0 .. count - 1 side by side on `threads` threads (0: all cores) and hands each result
// to merge(i, result), one at a time and in the order of i, so that what comes out does not depend on the threads. Few
// results are alive at once. When merge answers false, no further result is merged and `stopped` turns true.
template <typename Work, typename Merge>
void inOrder(std::size_t count, int threads, const Work& work, const Merge& merge) {
  using Result = std::invoke_result_t<Work, std::size_t, const Stopped&>;
  struct Item {
    std::size_t number;
    std::shared_ptr<Result> result;
  };
  Stopped stopped = false;
  std::size_t next = 0;
  const auto number = [&](tbb::flow_control& flow) {
    if (stopped || next == count) flow.stop();
    return next++;
  };
  const auto run = [&](std::size_t i) { return Item{i, std::make_shared<Result>(work(i, stopped))}; };
  const auto add = [&](const Item& item) {
    if (!stopped && !merge(item.number, *item.result)) stopped = true;
  };
  using tbb::filter_mode;
  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(threads > 0 ? std::min(threads, cores) : cores);
  arena.execute([&] {
    tbb::parallel_pipeline(2 * static_cast<std::size_t>(arena.max_concurrency()),
                           tbb::make_filter<void, std::size_t>(filter_mode::serial_in_order, number) &
                               tbb::make_filter<std::size_t, Item>(filter_mode::parallel, run) &
                               tbb::make_filter<Item, void>(filter_mode::serial_in_order, add));
  });
}

}  // namespace sunfleck::detail
