// The exact Euclidean distance transform of Felzenszwalb and Huttenlocher (2012): along each axis
// in turn, the lower envelope of parabolas. Squared distances are whole numbers, exact in float.
#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel.hpp"
#include "voxel_fills.hpp"

namespace shape3d::descriptors::detail {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

// Lower envelope of (i − q)² + f(q) over the q with finite f.
class Envelope {
 public:
  explicit Envelope(std::size_t n) : values_(n), places_(n), bounds_(n + 1) {}

  void transform(float* line, std::size_t stride, std::size_t n) {
    std::size_t count = 0;
    for (std::size_t q = 0; q < n; ++q) {
      values_[q] = line[q * stride];
      if (values_[q] == kFar) continue;
      double bound = -std::numeric_limits<double>::infinity();
      while (count > 0) {
        const std::size_t p = places_[count - 1];
        bound = ((static_cast<double>(values_[q]) + static_cast<double>(q * q)) -
                 (static_cast<double>(values_[p]) + static_cast<double>(p * p))) /
                (2.0 * static_cast<double>(q - p));
        if (bound > bounds_[count - 1]) break;
        --count;
        bound = -std::numeric_limits<double>::infinity();
      }
      places_[count] = q;
      bounds_[count] = bound;
      ++count;
    }
    if (count == 0) return;
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      while (nearest + 1 < count && bounds_[nearest + 1] < static_cast<double>(i)) ++nearest;
      const std::size_t q = places_[nearest];
      const float away = i > q ? static_cast<float>(i - q) : static_cast<float>(q - i);
      line[i * stride] = away * away + values_[q];
    }
  }

 private:
  std::vector<float> values_;
  std::vector<std::size_t> places_;
  std::vector<double> bounds_;
};

}  // namespace

std::vector<float> gaussian_of_voxels(const std::vector<std::uint8_t>& set, int side, double sigma,
                                      double reach, int threads) {
  const auto n = static_cast<std::size_t>(side);
  std::vector<float> squares(n * n * n);
  std::transform(set.begin(), set.end(), squares.begin(),
                 [](std::uint8_t mark) { return mark != 0 ? 0.0F : kFar; });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t stride = axis == 0 ? 1 : axis == 1 ? n : n * n;
    const std::size_t inner = axis == 0 ? n : 1, outer = axis == 2 ? n : n * n;
    parallel_blocks(
        static_cast<std::int64_t>(n), 4, threads, [&](std::int64_t first, std::int64_t last) {
          Envelope envelope(n);
          for (auto o = static_cast<std::size_t>(first); o < static_cast<std::size_t>(last); ++o) {
            for (std::size_t i = 0; i < n; ++i) {
              envelope.transform(squares.data() + o * outer + i * inner, stride, n);
            }
          }
        });
  }
  const auto limit = static_cast<float>(reach * reach);
  const auto scale = static_cast<float>(-0.5 / (sigma * sigma));
  parallel_blocks(static_cast<std::int64_t>(squares.size()), 1 << 14, threads,
                  [&](std::int64_t first, std::int64_t last) {
                    for (std::int64_t i = first; i < last; ++i) {
                      float& value = squares[static_cast<std::size_t>(i)];
                      value = value <= limit ? std::exp(scale * value) : 0.0F;
                    }
                  });
  return squares;
}

}  // namespace shape3d::descriptors::detail
