#include "parallel.hpp"

#include <algorithm>
#include <thread>

#ifdef SHAPE3D_ZMC_STD_THREADS
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>
#else
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

void parallel_ranges(std::int64_t count, std::int64_t grain, int threads,
                     const std::function<void(std::int64_t, std::int64_t)>& body) {
  if (count <= 0) return;
  if (threads <= 1 || count <= grain) {
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
