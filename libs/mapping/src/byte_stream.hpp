#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace shape3d::mapping::detail {

/// FNV-1a, 64 bits.
inline std::uint64_t checksum(const std::byte* data, std::size_t size) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (std::size_t i = 0; i < size; ++i) {
    hash ^= static_cast<std::uint64_t>(data[i]);
    hash *= 1099511628211ULL;
  }
  return hash;
}

/// Appends numbers to bytes: whole numbers in groups of seven bits, the lowest first, doubles and
/// words in eight bytes, the lowest first.
class ByteWriter {
 public:
  void byte(std::uint8_t value) { bytes_.push_back(static_cast<std::byte>(value)); }
  void number(std::uint64_t value) {
    for (; value >= 128; value >>= 7) byte(static_cast<std::uint8_t>(value | 128));
    byte(static_cast<std::uint8_t>(value));
  }
  void signed_number(std::int64_t value) { number(zigzag(value)); }
  void half_word(std::uint32_t value) {
    for (int i = 0; i < 4; ++i) byte(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  void word(std::uint64_t value) {
    for (int i = 0; i < 8; ++i) byte(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

  /// 0, −1, 1, −2 … as 0, 1, 2, 3 …
  static std::uint64_t zigzag(std::int64_t value) {
    const auto bits = static_cast<std::uint64_t>(value);
    return value < 0 ? ~(bits << 1) : bits << 1;
  }
  /// Bytes that number() takes.
  static int size_of(std::uint64_t value) {
    int size = 1;
    for (; value >= 128; value >>= 7) ++size;
    return size;
  }

 private:
  std::vector<std::byte> bytes_;
};

/// Reads what ByteWriter wrote. Everything that cannot be is refused by std::invalid_argument.
class ByteReader {
 public:
  ByteReader(const std::byte* data, std::size_t size) : data_(data), size_(size) {}

  [[nodiscard]] std::size_t left() const { return size_ - at_; }
  std::uint8_t byte() {
    if (at_ == size_) refuse("they end too early");
    return static_cast<std::uint8_t>(data_[at_++]);
  }
  std::uint64_t number() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const std::uint8_t part = byte();
      value |= static_cast<std::uint64_t>(part & 127) << shift;
      if (part < 128) return value;
    }
    refuse("a number does not end");
  }
  std::int64_t signed_number() {
    const std::uint64_t value = number();
    return static_cast<std::int64_t>((value >> 1) ^ (~(value & 1) + 1));
  }
  std::uint32_t half_word() {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(byte()) << (8 * i);
    return value;
  }
  std::uint64_t word() {
    std::uint64_t value = 0;
    for (int i = 0; i < 8; ++i) value |= static_cast<std::uint64_t>(byte()) << (8 * i);
    return value;
  }
  /// A number of things that take `least` bytes each at least, and no more than 2³¹ − 1.
  std::int64_t count(std::size_t least) {
    const std::uint64_t value = number();
    if (value > left() / least || value > 2147483647) refuse("a count does not fit their size");
    return static_cast<std::int64_t>(value);
  }
  /// A number below `limit`.
  std::int32_t below(std::int64_t limit) {
    const std::uint64_t value = number();
    if (value >= static_cast<std::uint64_t>(limit)) refuse("a number is out of range");
    return static_cast<std::int32_t>(value);
  }
  [[noreturn]] void refuse(const std::string& why) const {
    throw std::invalid_argument("bytes: not a progressive mesh: " + why + " (byte " +
                                std::to_string(at_) + " of " + std::to_string(size_) + ")");
  }

 private:
  const std::byte* data_;
  std::size_t size_, at_ = 0;
};

}  // namespace shape3d::mapping::detail
