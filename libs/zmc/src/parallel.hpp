#pragma once

#include <cstdint>
#include <functional>

namespace shape3d::zmc::detail {

/// Number of threads that `requested` stands for: itself, or all processors for 0.
int resolve_threads(int requested);

/// Calls body(first, last) for consecutive ranges that cover [0, count), on up to `threads`
/// threads. The ranges depend on scheduling; bodies must not. The first exception of a body is
/// rethrown.
void parallel_ranges(std::int64_t count, std::int64_t grain, int threads,
                     const std::function<void(std::int64_t, std::int64_t)>& body);

}  // namespace shape3d::zmc::detail
