#include "parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#ifndef SHAPE3D_ZMC_STD_THREADS
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace shape3d::zmc::detail {

int resolve_threads(int requested) {
  if (requested > 0) return requested;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

#ifdef SHAPE3D_ZMC_STD_THREADS

void parallel_ranges(std::int64_t count, std::int64_t grain, int threads,
                     const std::function<void(std::int64_t, std::int64_t)>& body) {
  if (count <= 0) return;
  if (threads <= 1 || count <= grain) {
    body(0, count);
    return;
  }
  std::atomic<std::int64_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (;;) {
        const std::int64_t first = next.fetch_add(grain);
        if (first >= count) return;
        body(first, std::min(first + grain, count));
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      next.store(count);
    }
  };
  std::vector<std::thread> team;
  try {
    team.reserve(static_cast<std::size_t>(threads - 1));
    for (int t = 1; t < threads; ++t) team.emplace_back(work);
  } catch (const std::exception&) {
    // Memory or threads run short: those that are there do all the work.
  }
  work();
  for (std::thread& member : team) member.join();
  if (failure) std::rethrow_exception(failure);
}

#else

namespace {

/// Whether so many threads can be started beside the calling one. TBB throws in the midst of its
/// work when it cannot start one; a process short of memory or threads is better served by the
/// calling thread alone. Asked once: TBB keeps its threads.
bool can_start(int workers) {
  static std::atomic<int> known{0};
  if (workers <= known.load(std::memory_order_relaxed)) return true;
  std::mutex gate;
  std::vector<std::thread> team;
  bool all = true;
  {
    const std::lock_guard<std::mutex> closed(gate);  // all at a time
    try {
      team.reserve(static_cast<std::size_t>(workers));
      for (int w = 0; w < workers; ++w) {
        team.emplace_back([&gate] { const std::lock_guard<std::mutex> open(gate); });
      }
    } catch (const std::exception&) {
      all = false;
    }
  }
  for (std::thread& member : team) member.join();
  if (all) known.store(workers, std::memory_order_relaxed);
  return all;
}

}  // namespace

void parallel_ranges(std::int64_t count, std::int64_t grain, int threads,
                     const std::function<void(std::int64_t, std::int64_t)>& body) {
  if (count <= 0) return;
  // TBB starts no more threads than there are processors.
  const int workers = std::min(threads, resolve_threads(0)) - 1;
  if (threads <= 1 || count <= grain || !can_start(workers)) {
    body(0, count);
    return;
  }
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, count, static_cast<std::size_t>(grain)),
        [&](const tbb::blocked_range<std::int64_t>& range) { body(range.begin(), range.end()); },
        tbb::simple_partitioner{});
  });
}

#endif

}  // namespace shape3d::zmc::detail
