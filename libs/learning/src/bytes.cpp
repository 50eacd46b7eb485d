#include "bytes.hpp"

#include <array>
#include <cstring>
#include <stdexcept>

namespace shape3d::learning::detail {
namespace {

std::array<std::uint64_t, 256> crc_table() {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t i = 0; i < 256; ++i) {
    std::uint64_t value = i;
    for (int bit = 0; bit < 8; ++bit) {
      value = (value >> 1) ^ ((value & 1) != 0 ? 0xc96c5795d7870f42ULL : 0);
    }
    table[i] = value;
  }
  return table;
}

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

std::uint64_t crc64(std::string_view bytes) {
  static const std::array<std::uint64_t, 256> table = crc_table();
  std::uint64_t crc = ~std::uint64_t{0};
  for (const char byte : bytes) {
    crc = table[(crc ^ static_cast<unsigned char>(byte)) & 0xff] ^ (crc >> 8);
  }
  return ~crc;
}

void ByteWriter::put(std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes_ += static_cast<char>((value >> (8 * i)) & 0xff);
}

void ByteWriter::real(double value) { u64(bits_of(value)); }

void ByteWriter::text(std::string_view value) {
  u64(value.size());
  bytes_ += value;
}

void ByteWriter::integers(const std::vector<int>& values) {
  u64(values.size());
  for (const int value : values) i32(value);
}

void ByteWriter::reals(const double* values, Eigen::Index count) {
  u64(static_cast<std::uint64_t>(count));
  for (Eigen::Index i = 0; i < count; ++i) real(values[i]);
}

void ByteWriter::matrix(const Features& values) {
  u64(static_cast<std::uint64_t>(values.rows()));
  u64(static_cast<std::uint64_t>(values.cols()));
  for (Eigen::Index i = 0; i < values.size(); ++i) real(values.data()[i]);
}

std::string ByteWriter::finish() const {
  ByteWriter whole = *this;
  whole.u64(crc64(bytes_));
  return std::move(whole.bytes_);
}

ByteReader::ByteReader(std::string_view bytes, std::string what)
    : rest_(bytes), what_(std::move(what)) {
  require(bytes.size() >= 8, "it has " + std::to_string(bytes.size()) + " bytes");
  rest_.remove_prefix(bytes.size() - 8);
  const std::uint64_t sum = u64();
  rest_ = bytes.substr(0, bytes.size() - 8);
  require(sum == crc64(rest_), "its check sum is not that of its bytes");
}

void ByteReader::require(bool good, const std::string& sentence) const {
  if (!good) throw std::invalid_argument(what_ + " is damaged: " + sentence);
}

void ByteReader::finish() const {
  require(rest_.empty(), std::to_string(rest_.size()) + " bytes are left over");
}

std::uint64_t ByteReader::get(int size) {
  require(rest_.size() >= static_cast<std::size_t>(size), "it ends early");
  std::uint64_t value = 0;
  for (int i = 0; i < size; ++i) {
    value |= std::uint64_t{static_cast<unsigned char>(rest_[static_cast<std::size_t>(i)])}
             << (8 * i);
  }
  rest_.remove_prefix(static_cast<std::size_t>(size));
  return value;
}

std::size_t ByteReader::count(std::size_t size_of_one) {
  const std::uint64_t number = u64();
  require(number <= rest_.size() / size_of_one, "it ends early");
  return static_cast<std::size_t>(number);
}

double ByteReader::real() {
  const std::uint64_t bits = u64();
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::string ByteReader::text() { return std::string(raw(count(1))); }

std::string_view ByteReader::raw(std::size_t size) {
  require(rest_.size() >= size, "it ends early");
  const std::string_view value = rest_.substr(0, size);
  rest_.remove_prefix(size);
  return value;
}

std::vector<int> ByteReader::integers() {
  std::vector<int> values(count(4));
  for (int& value : values) value = i32();
  return values;
}

Eigen::VectorXd ByteReader::vector() {
  Eigen::VectorXd values(static_cast<Eigen::Index>(count(8)));
  for (double& value : values) value = real();
  return values;
}

Features ByteReader::matrix() {
  const std::uint64_t rows = u64();
  const std::uint64_t columns = u64();
  const std::uint64_t numbers = rest_.size() / 8;
  require(rows <= numbers && columns <= numbers && (rows == 0 || columns <= numbers / rows),
          "it ends early");
  Features values(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  for (Eigen::Index i = 0; i < values.size(); ++i) values.data()[i] = real();
  return values;
}

}  // namespace shape3d::learning::detail
