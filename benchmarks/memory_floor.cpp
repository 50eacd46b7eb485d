#include "memory_floor.hpp"

#include <chrono>
#include <cstdint>
#include <cstring>
#include <new>
#include <vector>

#include <benchmark/benchmark.h>
#include <sys/mman.h>

#include "statistics.hpp"

namespace shape3d::bench {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;

template <class Function>
double seconds(Function&& function) {
  const auto start = std::chrono::steady_clock::now();
  function();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void read_all(const void* input, std::size_t bytes) {
  std::uint64_t sums[8] = {};
  const char* p = static_cast<const char*>(input);
  for (std::size_t i = 0; i + sizeof sums <= bytes; i += sizeof sums) {
    std::uint64_t block[8];
    std::memcpy(block, p + i, sizeof block);
    for (int k = 0; k < 8; ++k) sums[k] += block[k];
  }
  benchmark::DoNotOptimize(sums);
}

/// Fresh pages of the wanted kind, which are given back at the end.
class Pages {
 public:
  Pages(std::size_t bytes, int advice)
      : bytes_((bytes / kHugePage + 2) * kHugePage),
        data_(mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)) {
    if (data_ == MAP_FAILED) throw std::bad_alloc();
    madvise(data_, bytes_, advice);
  }
  ~Pages() { munmap(data_, bytes_); }
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;

  void write(std::size_t bytes) {
    std::memset(data_, 1, bytes);
    benchmark::ClobberMemory();
  }

 private:
  std::size_t bytes_;
  void* data_;
};

}  // namespace

MemoryFloor memory_floor(const void* input, std::size_t input_bytes, std::size_t output_bytes) {
  std::vector<double> read, fresh, huge, warm;
  for (int repetition = 0; repetition < 5; ++repetition) {
    read.push_back(seconds([&] { read_all(input, input_bytes); }));
    Pages small(output_bytes, MADV_NOHUGEPAGE), large(output_bytes, MADV_HUGEPAGE);
    fresh.push_back(seconds([&] { small.write(output_bytes); }));
    huge.push_back(seconds([&] { large.write(output_bytes); }));
    warm.push_back(seconds([&] { large.write(output_bytes); }));
  }
  return {spread(read).median, spread(fresh).median, spread(huge).median, spread(warm).median};
}

}  // namespace shape3d::bench
