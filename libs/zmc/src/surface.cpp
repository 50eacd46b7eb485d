#include "shape3d/zmc/surface.hpp"

#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace shape3d::zmc::detail {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;

/// Arrays from this size on are aligned to huge pages.
constexpr std::size_t kLarge = 4 * kHugePage;

}  // namespace

void* allocate_array(std::size_t bytes) {
#ifdef __linux__
  if (bytes >= kLarge) {
    const std::size_t rounded = (bytes + kHugePage - 1) / kHugePage * kHugePage;
    if (rounded < bytes) throw std::bad_alloc();
    void* array = std::aligned_alloc(kHugePage, rounded);
    if (array == nullptr) throw std::bad_alloc();
    madvise(array, rounded, MADV_HUGEPAGE);  // a hint: without huge pages nothing changes
    return array;
  }
#endif
  void* array = std::malloc(bytes == 0 ? 1 : bytes);
  if (array == nullptr) throw std::bad_alloc();
  return array;
}

void free_array(void* array) noexcept { std::free(array); }

}  // namespace shape3d::zmc::detail
