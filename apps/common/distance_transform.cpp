#include "distance_transform.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "text.hpp"

namespace shape3d::apps {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Lower envelope of the parabolas f(q) + step² (p − q)² over one row.
class Envelope {
 public:
  Envelope(std::int64_t length, double step)
      : step_squared_(step * step),
        values_(static_cast<std::size_t>(length)),
        apices_(values_.size()),
        starts_(values_.size() + 1) {}

  std::vector<double>& values() { return values_; }

  /// Replaces the values by those of the envelope.
  void apply() {
    const auto length = static_cast<std::int64_t>(values_.size());
    std::int64_t last = -1;  // of the parabolas kept
    for (std::int64_t q = 0; q < length; ++q) {
      if (!(values_[at(q)] < kInfinity)) continue;
      while (last >= 0) {
        const double start = crossing(apices_[at(last)], q);
        if (start > starts_[at(last)]) {
          starts_[at(last + 1)] = start;
          break;
        }
        --last;
      }
      ++last;
      apices_[at(last)] = q;
      if (last == 0) starts_[0] = -kInfinity;
    }
    if (last < 0) return;
    starts_[at(last + 1)] = kInfinity;
    result_.resize(values_.size());
    std::int64_t piece = 0;
    for (std::int64_t p = 0; p < length; ++p) {
      while (starts_[at(piece + 1)] < static_cast<double>(p)) ++piece;
      const auto gap = static_cast<double>(p - apices_[at(piece)]);
      result_[at(p)] = values_[at(apices_[at(piece)])] + step_squared_ * gap * gap;
    }
    values_.swap(result_);
  }

 private:
  static std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

  // Where the parabola with its apex at b becomes the lower one; a < b.
  [[nodiscard]] double crossing(std::int64_t a, std::int64_t b) const {
    const auto x = static_cast<double>(a), y = static_cast<double>(b);
    return (x + y) / 2 + (values_[at(b)] - values_[at(a)]) / (2 * step_squared_ * (y - x));
  }

  double step_squared_;
  std::vector<double> values_, result_;
  std::vector<std::int64_t> apices_;
  std::vector<double> starts_;
};

void transform_axis(std::vector<float>& squares, const std::array<std::int64_t, 3>& dims,
                    std::size_t axis, double step) {
  const std::array<std::int64_t, 3> strides{1, dims[0], dims[0] * dims[1]};
  const std::size_t across = axis == 0 ? 1 : 0, above = axis == 2 ? 1 : 2;
  Envelope envelope(dims[axis], step);
  for (std::int64_t k = 0; k < dims[above]; ++k) {
    for (std::int64_t j = 0; j < dims[across]; ++j) {
      float* row = squares.data() + k * strides[above] + j * strides[across];
      std::vector<double>& values = envelope.values();
      for (std::int64_t i = 0; i < dims[axis]; ++i)
        values[static_cast<std::size_t>(i)] = static_cast<double>(row[i * strides[axis]]);
      envelope.apply();
      for (std::int64_t i = 0; i < dims[axis]; ++i)
        row[i * strides[axis]] = static_cast<float>(values[static_cast<std::size_t>(i)]);
    }
  }
}

}  // namespace

std::vector<float> squared_distances(const std::vector<std::uint8_t>& marks,
                                     const std::array<std::int64_t, 3>& dims,
                                     const Eigen::Vector3d& spacing) {
  if (dims[0] < 1 || dims[1] < 1 || dims[2] < 1 ||
      static_cast<std::int64_t>(marks.size()) != dims[0] * dims[1] * dims[2]) {
    throw std::invalid_argument("marks has " + std::to_string(marks.size()) +
                                " samples; expected " + to_text(dims));
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!(spacing[axis] > 0.0) || !std::isfinite(spacing[axis])) {
      throw std::invalid_argument("spacing[" + std::to_string(axis) + "] is " +
                                  to_text(spacing[axis]) + "; expected a finite positive number");
    }
  }
  std::vector<float> squares(marks.size());
  for (std::size_t i = 0; i < marks.size(); ++i)
    squares[i] = marks[i] != 0 ? 0.0F : std::numeric_limits<float>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis)
    transform_axis(squares, dims, axis, spacing[static_cast<Eigen::Index>(axis)]);
  return squares;
}

}  // namespace shape3d::apps
