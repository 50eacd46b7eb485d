#include "parallel.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <thread>

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace shape3d::learning::detail {

int resolve_threads(int requested) {
  if (requested < 0) {
    throw std::invalid_argument("threads is " + std::to_string(requested) +
                                ", expected 0 for all processors, or more");
  }
  if (requested > 0) return requested;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_blocks(std::int64_t count, std::int64_t grain, int threads,
                     const std::function<void(std::int64_t, std::int64_t)>& body) {
  if (count <= 0) return;
  const std::int64_t blocks = (count + grain - 1) / grain;
  const auto block = [&](std::int64_t i) { body(i * grain, std::min(count, (i + 1) * grain)); };
  if (threads <= 1 || blocks == 1) {
    for (std::int64_t i = 0; i < blocks; ++i) block(i);
    return;
  }
  // More threads than processors would not help, and TBB says so on standard error.
  tbb::task_arena arena(std::min(threads, tbb::info::default_concurrency()));
  arena.execute([&] { tbb::parallel_for(std::int64_t{0}, blocks, block); });
}

}  // namespace shape3d::learning::detail
