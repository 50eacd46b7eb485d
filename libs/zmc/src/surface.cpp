#include "shape3d/zmc/surface.hpp"

#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace shape3d::zmc::detail {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;

}  // namespace

void* allocate_array(std::size_t bytes) {
#ifdef __linux__
  if (bytes >= kHugePage) {
    const std::size_t whole = bytes / kHugePage * kHugePage;
    const std::size_t rounded = whole == bytes ? bytes : whole + kHugePage;
    if (rounded < bytes) throw std::bad_alloc();
    void* array = std::aligned_alloc(kHugePage, rounded);
    if (array == nullptr) throw std::bad_alloc();
    // A hint: without huge pages nothing changes. The last page, of which only a part is used,
    // stays in small ones, so that no more memory is taken than is written.
    madvise(array, whole, MADV_HUGEPAGE);
    return array;
  }
#endif
  void* array = std::malloc(bytes == 0 ? 1 : bytes);
  if (array == nullptr) throw std::bad_alloc();
  return array;
}

void free_array(void* array) noexcept { std::free(array); }

}  // namespace shape3d::zmc::detail
