#include "segmentation_measures.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "distance_transform.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

using Index3 = std::array<std::int64_t, 3>;

constexpr double kPi = 3.14159265358979323846;

void validate(const MaskView& mask, const std::string& name) {
  if (mask.data == nullptr || mask.dims[0] < 1 || mask.dims[1] < 1 || mask.dims[2] < 1) {
    throw std::invalid_argument("mask " + name + " is " + to_text(mask.dims) +
                                (mask.data == nullptr ? " without data" : " samples") +
                                "; expected one sample or more");
  }
}

std::int64_t index_of(const Index3& dims, std::int64_t i, std::int64_t j, std::int64_t k) {
  return i + dims[0] * (j + dims[1] * k);
}

struct Box {
  Index3 lower, upper;  // half-open

  [[nodiscard]] bool empty() const { return lower[0] >= upper[0]; }
  [[nodiscard]] Index3 dims() const {
    return {upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]};
  }
  void include(const Index3& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], p[axis]);
      upper[axis] = std::max(upper[axis], p[axis] + 1);
    }
  }
};

Box nothing(const Index3& dims) { return {dims, {0, 0, 0}}; }

bool on_surface(const MaskView& mask, std::int64_t i, std::int64_t j, std::int64_t k) {
  const std::uint8_t* p = mask.data + index_of(mask.dims, i, j, k);
  if (*p == 0) return false;
  const std::int64_t y = mask.dims[0], z = mask.dims[0] * mask.dims[1];
  return (i > 0 && p[-1] == 0) || (i + 1 < mask.dims[0] && p[1] == 0) || (j > 0 && p[-y] == 0) ||
         (j + 1 < mask.dims[1] && p[y] == 0) || (k > 0 && p[-z] == 0) ||
         (k + 1 < mask.dims[2] && p[z] == 0);
}

// Calls visit(i, j, k) for the surface samples in the order of the lattice.
template <class Visit>
void for_surface(const MaskView& mask, const Visit& visit) {
  for (std::int64_t k = 0; k < mask.dims[2]; ++k) {
    for (std::int64_t j = 0; j < mask.dims[1]; ++j) {
      for (std::int64_t i = 0; i < mask.dims[0]; ++i) {
        if (on_surface(mask, i, j, k)) visit(i, j, k);
      }
    }
  }
}

// Distances from the surface samples of one mask to the surface of the other.
std::vector<float> distances(const MaskView& from, const MaskView& to, const Box& box) {
  const Index3 dims = box.dims();
  const auto place = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    return static_cast<std::size_t>(
        index_of(dims, i - box.lower[0], j - box.lower[1], k - box.lower[2]));
  };
  std::vector<std::uint8_t> marks(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]), 0);
  for_surface(to,
              [&](std::int64_t i, std::int64_t j, std::int64_t k) { marks[place(i, j, k)] = 1; });
  const std::vector<float> squares = squared_distances(marks, dims, to.spacing);
  std::vector<float> result;
  for_surface(from, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    result.push_back(std::sqrt(squares[place(i, j, k)]));
  });
  return result;
}

using Point = std::array<double, 2>;

double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Andrew's monotone chain; points sorted by (y, x).
std::vector<Point> convex_hull(const std::vector<Point>& points) {
  std::vector<Point> hull;
  const auto chain = [&hull](auto begin, auto end) {
    const std::size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), *p) <= 0.0)
        hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  if (points.size() < 3) return points;
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  return hull;
}

double axial_diameter(const MaskView& mask, std::int64_t k) {
  std::vector<Point> ends;  // the first and last sample of each row: the hull needs no other
  for (std::int64_t j = 0; j < mask.dims[1]; ++j) {
    const std::uint8_t* row = mask.data + index_of(mask.dims, 0, j, k);
    const std::uint8_t* stop = row + mask.dims[0];
    const auto inside = [](std::uint8_t value) { return value != 0; };
    const std::uint8_t* first = std::find_if(row, stop, inside);
    if (first == stop) continue;
    const std::uint8_t* last = stop - 1;
    while (*last == 0) --last;
    ends.push_back({static_cast<double>(first - row) * mask.spacing[0],
                    static_cast<double>(j) * mask.spacing[1]});
    if (last > first) {
      ends.push_back({static_cast<double>(last - row) * mask.spacing[0], ends.back()[1]});
    }
  }
  const std::vector<Point> hull = convex_hull(ends);
  double most = 0.0;
  for (std::size_t a = 0; a < hull.size(); ++a) {
    for (std::size_t b = a + 1; b < hull.size(); ++b)
      most = std::max(most, std::hypot(hull[a][0] - hull[b][0], hull[a][1] - hull[b][1]));
  }
  return most;
}

}  // namespace

double percentile(std::vector<float> values, double p) {
  if (values.empty()) throw std::invalid_argument("values is empty; expected one or more");
  if (!(p >= 0.0 && p <= 100.0))
    throw std::invalid_argument("p is " + to_text(p) + "; expected 0 to 100");
  const double rank = p / 100.0 * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), values.begin() + low, values.end());
  const auto at = static_cast<double>(values[static_cast<std::size_t>(low)]);
  const double rest = rank - static_cast<double>(low);
  if (rest == 0.0) return at;
  const auto next = static_cast<double>(*std::min_element(values.begin() + low + 1, values.end()));
  return at + rest * (next - at);
}

SegmentationMeasures compare_masks(const MaskView& a, const MaskView& b) {
  validate(a, "a");
  validate(b, "b");
  if (a.dims != b.dims) {
    throw std::invalid_argument("mask a has " + to_text(a.dims) + " samples and mask b " +
                                to_text(b.dims) + "; expected as many");
  }
  if (a.spacing != b.spacing)
    throw std::invalid_argument("mask a and mask b differ in spacing; expected the same");
  SegmentationMeasures measures;
  std::int64_t in_a = 0, in_b = 0, common = 0;
  const std::int64_t samples = a.dims[0] * a.dims[1] * a.dims[2];
  for (std::int64_t n = 0; n < samples; ++n) {
    in_a += a.data[n] != 0 ? 1 : 0;
    in_b += b.data[n] != 0 ? 1 : 0;
    common += a.data[n] != 0 && b.data[n] != 0 ? 1 : 0;
  }
  if (in_a + in_b > 0)
    measures.dice = 2.0 * static_cast<double>(common) / static_cast<double>(in_a + in_b);
  Box box_a = nothing(a.dims), box = box_a;
  for_surface(a, [&](std::int64_t i, std::int64_t j, std::int64_t k) { box_a.include({i, j, k}); });
  for_surface(b, [&](std::int64_t i, std::int64_t j, std::int64_t k) { box.include({i, j, k}); });
  if (box_a.empty() || box.empty()) return measures;
  box.include(box_a.lower);
  box.include({box_a.upper[0] - 1, box_a.upper[1] - 1, box_a.upper[2] - 1});
  const std::vector<float> ab = distances(a, b, box), ba = distances(b, a, box);
  const auto greatest = [](const std::vector<float>& values) {
    return static_cast<double>(*std::max_element(values.begin(), values.end()));
  };
  measures.hausdorff95 = std::max(percentile(ab, 95.0), percentile(ba, 95.0));
  measures.hausdorff = std::max(greatest(ab), greatest(ba));
  double sum = 0.0;
  for (const std::vector<float>* values : {&ab, &ba}) {
    for (const float value : *values) sum += static_cast<double>(value);
  }
  measures.mean_distance = sum / static_cast<double>(ab.size() + ba.size());
  return measures;
}

MaskSize measure_mask(const MaskView& mask) {
  validate(mask, "mask");
  MaskSize size;
  const std::int64_t plane = mask.dims[0] * mask.dims[1];
  for (std::int64_t k = 0; k < mask.dims[2]; ++k) {
    const std::uint8_t* slice = mask.data + k * plane;
    const auto inside =
        std::count_if(slice, slice + plane, [](std::uint8_t value) { return value != 0; });
    if (inside == 0) continue;
    size.samples += inside;
    size.axial_diameter = std::max(size.axial_diameter, axial_diameter(mask, k));
  }
  size.volume = static_cast<double>(size.samples) * mask.spacing.prod();
  size.equivalent_diameter = std::cbrt(6.0 * size.volume / kPi);
  return size;
}

}  // namespace shape3d::apps
