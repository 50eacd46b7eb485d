#pragma once

#include <cstddef>

namespace shape3d::bench {

/// Seconds that no extractor can do without, by one thread; medians of five.
struct MemoryFloor {
  double read = 0.0;              ///< Reading each byte of the input once.
  double write_fresh = 0.0;       ///< Writing the output into new memory, on pages of 4 KiB.
  double write_fresh_huge = 0.0;  ///< The same on huge pages, where the system grants them.
  double write_warm = 0.0;        ///< Writing it into memory that was written before.
};

[[nodiscard]] MemoryFloor memory_floor(const void* input, std::size_t input_bytes,
                                       std::size_t output_bytes);

}  // namespace shape3d::bench
