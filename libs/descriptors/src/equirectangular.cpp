#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "shape3d/descriptors/spherical_image.hpp"
#include "text.hpp"

namespace shape3d::descriptors {
namespace {

unsigned char byte(double share) {
  return static_cast<unsigned char>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

// From blue (0) through white (½) to red (1).
std::array<double, 3> diverging(double share) {
  const std::array<double, 3> blue{0.13, 0.29, 0.60}, red{0.70, 0.09, 0.17};
  const double x = std::clamp(share, 0.0, 1.0);
  const double weight = std::abs(2.0 * x - 1.0);
  std::array<double, 3> color{};
  for (std::size_t i = 0; i < 3; ++i) {
    color[i] = 1.0 - weight * (1.0 - (x < 0.5 ? blue[i] : red[i]));
  }
  return color;
}

}  // namespace

std::vector<unsigned char> equirectangular_picture(const SphericalImage& image, int height,
                                                   double low, double high) {
  const Eigen::Index components = image.samples.cols();
  if (image.size <= 0 || image.samples.rows() != Eigen::Index{2} * image.size * image.size) {
    throw std::invalid_argument("image has " + std::to_string(image.samples.rows()) +
                                " samples, expected 2 size², more than none");
  }
  if (components != 1 && components != 3) {
    throw std::invalid_argument("image has " + std::to_string(components) +
                                " components, expected 1 or 3");
  }
  detail::require_between("height", height, 1, 4096);
  if (!(low < high)) {
    throw std::invalid_argument("low is " + detail::number(low) + ", expected less than high, " +
                                detail::number(high));
  }
  const int width = 2 * height;
  std::vector<unsigned char> bytes;
  bytes.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (int y = 0; y < height; ++y) {
    const int row = static_cast<int>((std::int64_t{2} * y + 1) * image.size / (2 * height));
    for (int x = 0; x < width; ++x) {
      // Columns have φ_k = πk/n; the nearest to φ = −π + 2π(x + ½)/width.
      const double place = image.size * ((2.0 * x + 1.0) / width - 1.0);
      const int column =
          ((static_cast<int>(std::lround(place)) % (2 * image.size)) + 2 * image.size) %
          (2 * image.size);
      const auto sample = image.samples.row(Eigen::Index{2} * image.size * row + column);
      const auto share = [&](Eigen::Index c) { return (sample[c] - low) / (high - low); };
      std::array<double, 3> color{};
      if (components == 1) {
        color = diverging(share(0));
      } else {
        color = {share(0), share(1), share(2)};
      }
      for (const double part : color) bytes.push_back(byte(part));
    }
  }
  return bytes;
}

}  // namespace shape3d::descriptors
