#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "shape3d/learning/features.hpp"

namespace shape3d::learning::detail {

/// CRC-64 (ECMA-182, reflected, as in xz). Finds every change within 64 consecutive bits for
/// certain, so every changed byte.
std::uint64_t crc64(std::string_view bytes);

/// Appends numbers to bytes: little endian, doubles bit for bit, lengths as 64 bits before what
/// they count.
class ByteWriter {
 public:
  void u32(std::uint32_t value) { put(value, 4); }
  void u64(std::uint64_t value) { put(value, 8); }
  void i32(int value) { u32(static_cast<std::uint32_t>(value)); }
  void real(double value);
  void text(std::string_view value);
  void raw(std::string_view value) { bytes_ += value; }  ///< Without its length.
  void integers(const std::vector<int>& values);
  void reals(const double* values, Eigen::Index count);  ///< With their number.
  void vector(const Eigen::VectorXd& values) { reals(values.data(), values.size()); }
  void matrix(const Features& values);  ///< Rows, columns, numbers row by row.

  /// The bytes and after them their check sum.
  [[nodiscard]] std::string finish() const;

 private:
  void put(std::uint64_t value, int size);

  std::string bytes_;
};

/// Reads them back. Every function throws std::invalid_argument "<what> is damaged: …" when the
/// bytes end early; no memory is taken before it is sure that they do not.
class ByteReader {
 public:
  /// @param what  "the SVM", for messages. Checks the sum at the end.
  ByteReader(std::string_view bytes, std::string what);

  std::uint32_t u32() { return static_cast<std::uint32_t>(get(4)); }
  std::uint64_t u64() { return get(8); }
  int i32() { return static_cast<int>(u32()); }
  double real();
  std::string text();
  std::string_view raw(std::size_t size);
  std::vector<int> integers();
  Eigen::VectorXd vector();
  Features matrix();
  /// An enumerator: a number up to `last`.
  template <class Enum>
  Enum enumerator(Enum last) {
    const std::uint32_t value = u32();
    require(value <= static_cast<std::uint32_t>(last), "a number stands for no choice");
    return static_cast<Enum>(value);
  }
  /// Throws unless `good`: "<what> is damaged: <sentence>".
  void require(bool good, const std::string& sentence) const;
  /// Throws unless all bytes are read.
  void finish() const;

 private:
  std::uint64_t get(int size);
  std::size_t count(std::size_t size_of_one);

  std::string_view rest_;
  std::string what_;
};

}  // namespace shape3d::learning::detail
