#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace shape3d::apps {

/// Memory that a child process shares with its parent; zeros at first.
class SharedBytes {
 public:
  /// @throws std::bad_alloc
  explicit SharedBytes(std::size_t size);
  ~SharedBytes();
  SharedBytes(const SharedBytes&) = delete;
  SharedBytes& operator=(const SharedBytes&) = delete;

  [[nodiscard]] std::byte* data() { return data_; }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Runs `work` in a child process, for libraries that abort or crash on damaged data: what it
/// writes to shared memory stays, all else is lost. The child prints nothing, leaves no core file
/// and is ended after `cpu_seconds` of processor time.
/// @return empty when `work` returned; else the text of the exception that it threw, or how the
/// child ended.
[[nodiscard]] std::string run_isolated(const std::function<void()>& work,
                                       std::uint64_t cpu_seconds);

}  // namespace shape3d::apps
