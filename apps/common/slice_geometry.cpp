#include "slice_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include <Eigen/Geometry>

#include "error.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

// Decimal strings of DICOM have at least six digits.
constexpr double kAxisRounding = 1e-4;
constexpr double kSpacingRounding = 1e-3;
// Parts of the step by which a slice may be off the lattice.
constexpr double kUneven = 0.05;
constexpr double kNoticeable = 0.01;
// Slices closer than this part of the typical step are at one place.
constexpr double kSamePlace = 0.01;
// Angle between step and normal from which a gantry counts as tilted; what rounding of positions to
// 0.001 mm makes stays below it.
constexpr double kTiltDegrees = 0.1;
constexpr double kDegrees = 57.29577951308232;

std::string rounded(double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.6g", value);
  return buffer.data();
}

void check_slice(const SlicePlace& slice, const SlicePlace& first,
                 const std::filesystem::path& path) {
  if (!slice.position.allFinite() || !slice.row.allFinite() || !slice.column.allFinite()) {
    throw FileError(path, slice.name + ": its position or orientation is not finite");
  }
  for (const double spacing : {slice.column_spacing, slice.row_spacing}) {
    if (std::isfinite(spacing) && spacing > 0.0) continue;
    throw FileError(path, slice.name + ": pixel spacing " + to_text(spacing) +
                              "; expected a finite positive number");
  }
  if (std::abs(slice.row.norm() - 1.0) > kAxisRounding ||
      std::abs(slice.column.norm() - 1.0) > kAxisRounding ||
      std::abs(slice.row.dot(slice.column)) > kAxisRounding) {
    throw FileError(path, slice.name +
                              ": its orientation is not two orthogonal unit vectors (lengths " +
                              rounded(slice.row.norm()) + " and " + rounded(slice.column.norm()) +
                              ", cosine " + rounded(slice.row.dot(slice.column)) + ")");
  }
  if ((slice.row - first.row).norm() > kAxisRounding ||
      (slice.column - first.column).norm() > kAxisRounding) {
    throw FileError(path, "slices differ in orientation: " + first.name + " and " + slice.name);
  }
  const double scale = kSpacingRounding * first.column_spacing;
  if (std::abs(slice.column_spacing - first.column_spacing) > scale ||
      std::abs(slice.row_spacing - first.row_spacing) > scale) {
    throw FileError(path, "slices differ in pixel spacing: " + to_text(first.row_spacing) + " x " +
                              to_text(first.column_spacing) + " in " + first.name + ", " +
                              to_text(slice.row_spacing) + " x " + to_text(slice.column_spacing) +
                              " in " + slice.name);
  }
}

// The lower one of two in the middle: a gap between others is the exception.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Slices in order with the distances between neighbours along the normal.
struct Ordered {
  std::vector<std::size_t> order;
  std::vector<double> gaps;  ///< gaps[k]: from slice k to k + 1; not negative.
};

// Several slices at one place make a series of volumes, or copies.
void check_places(const std::vector<SlicePlace>& slices, const Ordered& ordered,
                  const std::filesystem::path& path) {
  std::vector<double> steps;
  for (const double gap : ordered.gaps) {
    if (gap > 0.0) steps.push_back(gap);
  }
  const double same = steps.empty() ? 0.0 : kSamePlace * median(steps);
  std::vector<std::size_t> counts{1};
  std::size_t first = slices.size();
  for (std::size_t k = 0; k < ordered.gaps.size(); ++k) {
    if (ordered.gaps[k] > same) {
      counts.push_back(1);
    } else {
      ++counts.back();
      first = std::min(first, k);
    }
  }
  if (first == slices.size()) return;
  const bool volumes =
      std::all_of(counts.begin(), counts.end(), [&](std::size_t n) { return n == counts.front(); });
  if (volumes && counts.size() > 1) {
    throw FileError(path, "holds " + std::to_string(counts.front()) +
                              " frames (4-D), volumes at the same place; expected one");
  }
  throw FileError(path, "holds several slices at one place: " + slices[ordered.order[first]].name +
                            " and " + slices[ordered.order[first + 1]].name);
}

// Gaps of a multiple of the typical step are missing slices, others are uneven.
void check_gaps(const std::vector<SlicePlace>& slices, const Ordered& ordered,
                const std::filesystem::path& path) {
  const double typical = median(ordered.gaps);
  std::size_t missing = 0;
  std::string places;
  constexpr int kListed = 5;
  int listed = 0;
  std::size_t worst = ordered.gaps.size();
  double worst_error = kUneven;
  for (std::size_t k = 0; k < ordered.gaps.size(); ++k) {
    const double ratio = ordered.gaps[k] / typical;
    const double whole = std::max(std::round(ratio), 1.0);
    // The first of several alike, whatever the rounding.
    constexpr double kMore = 1.0 + 1e-6;
    if (std::abs(ratio - whole) > kMore * worst_error) {
      worst = k;
      worst_error = std::abs(ratio - whole);
    }
    if (whole < 2.0 || !(ratio < 1e6)) continue;
    missing += static_cast<std::size_t>(whole) - 1;
    if (++listed <= kListed) {
      places += (listed > 1 ? "; " : " ") + std::to_string(static_cast<std::size_t>(whole) - 1) +
                " between " + slices[ordered.order[k]].name + " and " +
                slices[ordered.order[k + 1]].name + ", " + rounded(ordered.gaps[k]) + " mm apart";
    }
  }
  if (worst < ordered.gaps.size()) {
    throw FileError(path, "slices are unevenly spaced: " + rounded(ordered.gaps[worst]) +
                              " mm between " + slices[ordered.order[worst]].name + " and " +
                              slices[ordered.order[worst + 1]].name + ", where most are " +
                              rounded(typical) + " mm apart");
  }
  if (missing > 0) {
    throw FileError(path, std::to_string(missing) + (missing == 1 ? " slice is" : " slices are") +
                              " missing where most are " + rounded(typical) +
                              " mm apart:" + places + (listed > kListed ? "; and more" : ""));
  }
}

}  // namespace

SliceStack stack_slices(const std::vector<SlicePlace>& slices, const std::filesystem::path& path) {
  if (slices.size() < 2) {
    throw FileError(
        path, "holds " + std::to_string(slices.size()) + " slice; a volume needs at least two");
  }
  const SlicePlace& first = slices.front();
  for (const SlicePlace& slice : slices) check_slice(slice, first, path);
  const Eigen::Vector3d normal = first.row.cross(first.column).normalized();

  Ordered ordered;
  ordered.order.resize(slices.size());
  std::iota(ordered.order.begin(), ordered.order.end(), std::size_t{0});
  const auto height = [&](std::size_t n) { return slices[n].position.dot(normal); };
  std::stable_sort(ordered.order.begin(), ordered.order.end(),
                   [&](std::size_t a, std::size_t b) { return height(a) < height(b); });
  for (std::size_t k = 0; k + 1 < slices.size(); ++k) {
    ordered.gaps.push_back(height(ordered.order[k + 1]) - height(ordered.order[k]));
  }
  check_places(slices, ordered, path);
  check_gaps(slices, ordered, path);

  SliceStack stack;
  const auto last = static_cast<double>(slices.size() - 1);
  stack.origin = slices[ordered.order.front()].position;
  const Eigen::Vector3d step = (slices[ordered.order.back()].position - stack.origin) / last;
  const double length = step.norm();

  // Equal gaps do not exclude a drift, nor slices beside the line.
  double worst_error = 0.0;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    const Eigen::Vector3d expected = stack.origin + static_cast<double>(k) * step;
    const double error = (slices[ordered.order[k]].position - expected).norm();
    if (error > worst_error) {
      worst_error = error;
      worst = k;
    }
  }
  const std::string off = slices[ordered.order[worst]].name + " is " + rounded(worst_error) +
                          " mm off an even stack of slices " + rounded(length) + " mm apart";
  if (worst_error > kUneven * length) throw FileError(path, "slices are unevenly spaced: " + off);
  if (worst_error > kNoticeable * length)
    stack.warnings.push_back("slices are not quite even: " + off);

  const double tilt = std::atan2(step.cross(normal).norm(), step.dot(normal)) * kDegrees;
  if (tilt > kTiltDegrees) {
    stack.warnings.push_back("the gantry was tilted: slices are sheared by " + rounded(tilt) +
                             " degrees, which the volume's axes keep");
  }
  stack.steps.col(0) = first.row * first.column_spacing;
  stack.steps.col(1) = first.column * first.row_spacing;
  stack.steps.col(2) = step;
  stack.order = std::move(ordered.order);
  return stack;
}

}  // namespace shape3d::apps
