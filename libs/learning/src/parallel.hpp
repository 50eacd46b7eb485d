#pragma once

#include <cstdint>
#include <functional>

namespace shape3d::learning::detail {

/// Number of threads that `requested` stands for: itself, or all processors for 0.
/// @throws std::invalid_argument  it is negative.
int resolve_threads(int requested);

/// Calls body(first, last) for consecutive ranges of at most `grain` that cover [0, count), on up
/// to `threads` threads. Which ranges there are depends on count and grain alone when each is [i ·
/// grain, (i+1) · grain); bodies that reduce rely on that.
void parallel_blocks(std::int64_t count, std::int64_t grain, int threads,
                     const std::function<void(std::int64_t, std::int64_t)>& body);

}  // namespace shape3d::learning::detail
