#pragma once

#include <algorithm>
#include <cstdint>
#include <thread>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "message.hpp"

namespace shape3d::levelset::detail {

/// Number of threads that `requested` stands for: itself, or all processors for 0.
inline int resolve_threads(int requested) {
  require(requested >= 0, "threads", requested, "0 (all processors) or more");
  if (requested > 0) return requested;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Calls body(index) for each of [0, count) on up to `threads` threads. Bodies must not depend on
/// the order. The first exception of a body is rethrown.
template <class Body>
void parallel_for(std::int64_t count, int threads, const Body& body) {
  if (threads <= 1 || count <= 1) {
    for (std::int64_t index = 0; index < count; ++index) body(index);
    return;
  }
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count),
                      [&](const tbb::blocked_range<std::int64_t>& range) {
                        for (std::int64_t i = range.begin(); i < range.end(); ++i) body(i);
                      });
  });
}

}  // namespace shape3d::levelset::detail
