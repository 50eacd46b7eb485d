#pragma once

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <utility>

namespace shape3d::fuzz {

/// A property does not hold for an input.
class Violation : public std::exception {
 public:
  explicit Violation(std::string property) : property_(std::move(property)) {}
  [[nodiscard]] const char* what() const noexcept override { return property_.c_str(); }

 private:
  std::string property_;
};

inline void check(bool holds, const char* property) {
  if (!holds) throw Violation(property);
}
inline void check(bool holds, const std::string& property) {
  if (!holds) throw Violation(property);
}

/// Runs a test; what it throws ends the process with a message, so that the fuzzer keeps the input.
template <class Test>
void expect_no_exception(const Test& test, const std::string& input) {
  try {
    test();
  } catch (const Violation& violation) {
    std::fprintf(stderr, "%s: violated: %s\n", input.c_str(), violation.what());
    std::abort();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: unexpected exception: %s\n", input.c_str(), error.what());
    std::abort();
  }
}

}  // namespace shape3d::fuzz
