#pragma once

#include <string>

namespace shape3d::learning::detail {

/// Shortest decimals that read back as the same number: 0.1, 1e-09, nan.
std::string number(double value);

/// Throws std::invalid_argument "<name> is <value>, expected <expected>" unless `good`.
void require(bool good, const char* name, double value, const std::string& expected);

/// The same for an integer between two limits: "expected 8 … 256".
void require_between(const char* name, long long value, long long least, long long largest);

}  // namespace shape3d::learning::detail
