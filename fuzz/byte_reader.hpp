#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace shape3d::fuzz {

/// Turns the bytes of an input into numbers, one after another. Behind the end it starts again from
/// its beginning, so that few bytes can describe much; of an empty input everything is zero.
class ByteReader {
 public:
  ByteReader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  [[nodiscard]] std::uint8_t byte() {
    if (size_ == 0) return 0;
    if (at_ == size_) at_ = 0;
    return data_[at_++];
  }
  /// A whole number, 0 ≤ n < count ≤ 256.
  [[nodiscard]] int below(int count) { return byte() % count; }
  [[nodiscard]] bool flag() { return (byte() & 1) != 0; }

  /// A value of the type's own bytes.
  template <class T>
  [[nodiscard]] T raw() {
    std::uint8_t bytes[sizeof(T)];
    for (std::uint8_t& b : bytes) b = byte();
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  /// What is read from here on starts again at this place, too, instead of at the beginning.
  void mark() {
    const std::size_t left = size_ - std::min(at_, size_);
    if (left == 0) return;
    data_ += at_;
    size_ = left;
    at_ = 0;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

}  // namespace shape3d::fuzz
