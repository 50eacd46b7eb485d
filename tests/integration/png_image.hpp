#pragma once

#include <array>
#include <string>
#include <vector>

namespace shape3d::test {

/// Pixels of a PNG, row by row from the top.
struct PngImage {
  int width = 0, height = 0;
  std::vector<std::array<unsigned char, 3>> pixels;

  [[nodiscard]] const std::array<unsigned char, 3>& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  /// Whether a pixel is within `tolerance` of a colour, 0 … 1 each channel.
  [[nodiscard]] bool is(int x, int y, const std::array<double, 3>& color,
                        double tolerance = 0.04) const;
  /// Pixels of that colour.
  [[nodiscard]] int count(const std::array<double, 3>& color, double tolerance = 0.04) const;
};

/// @throws std::runtime_error  the bytes are no RGB picture.
[[nodiscard]] PngImage decode_png(const std::string& bytes);

}  // namespace shape3d::test
