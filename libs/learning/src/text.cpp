#include "text.hpp"

#include <array>
#include <charconv>
#include <stdexcept>

namespace shape3d::learning::detail {

std::string number(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), end.ptr};
}

void require(bool good, const char* name, double value, const std::string& expected) {
  if (good) return;
  throw std::invalid_argument(std::string(name) + " is " + number(value) + ", expected " +
                              expected);
}

void require_between(const char* name, long long value, long long least, long long largest) {
  if (value >= least && value <= largest) return;
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) + ", expected " +
                              std::to_string(least) + " … " + std::to_string(largest));
}

}  // namespace shape3d::learning::detail
