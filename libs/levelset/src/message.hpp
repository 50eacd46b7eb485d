#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace shape3d::levelset::detail {

template <class Number>
std::string text(Number value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end.ptr};
}

inline std::string text(const std::array<std::int64_t, 3>& values) {
  return "(" + text(values[0]) + ", " + text(values[1]) + ", " + text(values[2]) + ")";
}

/// "<name> is <value>; expected <expected>".
[[noreturn]] inline void refuse(const std::string& name, const std::string& value,
                                const std::string& expected) {
  throw std::invalid_argument(name + " is " + value + "; expected " + expected);
}

/// Refuses unless `valid`.
template <class Number>
void require(bool valid, const char* name, Number value, const char* expected) {
  if (!valid) refuse(name, text(value), expected);
}

}  // namespace shape3d::levelset::detail
