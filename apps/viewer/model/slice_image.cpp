#include "slice_image.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <shape3d/zmc/contour.hpp>

#include "samples_at.hpp"

namespace shape3d::apps::viewer {
namespace {

// The end of a world axis: 0 … 2 for x, y, z of LPS.
std::string letter(const Eigen::Vector3d& direction) {
  Eigen::Index dominant = 0;
  direction.cwiseAbs().maxCoeff(&dominant);
  constexpr std::string_view kPositive = "LPS", kNegative = "RAI";
  const auto index = static_cast<std::size_t>(dominant);
  return std::string(1, direction[dominant] > 0.0 ? kPositive[index] : kNegative[index]);
}

}  // namespace

SliceGeometry::SliceGeometry(const zmc::VolumeView& volume, int axis)
    : axis_(axis),
      slices_(volume.dims[static_cast<std::size_t>(axis)]),
      axes_(axis == 0   ? std::array<int, 2>{1, 2}
            : axis == 1 ? std::array<int, 2>{0, 2}
                        : std::array<int, 2>{0, 1}),
      direction_(volume.direction) {
  // SlicePlane says which way the axes run: its place of the first sample is at the far end where
  // they are turned round.
  const std::array<double, 2> first = SlicePlane(volume, axis).project(volume.origin);
  for (std::size_t i = 0; i < 2; ++i) {
    spacing_[i] = volume.spacing[axes_[i]];
    flipped_[i] = first[i] > 0.5 * spacing_[i];
  }
  columns_ = static_cast<int>(volume.dims[static_cast<std::size_t>(axes_[0])]);
  rows_ = static_cast<int>(volume.dims[static_cast<std::size_t>(axes_[1])]);
}

std::array<double, 2> SliceGeometry::size() const {
  return {columns_ * spacing_[0], rows_ * spacing_[1]};
}

Eigen::Vector3d SliceGeometry::lattice(const std::array<double, 2>& place, double slice) const {
  Eigen::Vector3d p;
  p[axis_] = slice;
  for (std::size_t i = 0; i < 2; ++i) {
    const double at = place[i] / spacing_[i] - 0.5;
    p[axes_[i]] = flipped_[i] ? (i == 0 ? columns_ : rows_) - 1 - at : at;
  }
  return p;
}

std::array<double, 2> SliceGeometry::place(const Eigen::Vector3d& lattice) const {
  std::array<double, 2> place{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double at = lattice[axes_[i]];
    place[i] = spacing_[i] * ((flipped_[i] ? (i == 0 ? columns_ : rows_) - 1 - at : at) + 0.5);
  }
  return place;
}

std::array<std::int64_t, 3> SliceGeometry::sample(int column, int row, std::int64_t slice) const {
  std::array<std::int64_t, 3> p{};
  p[static_cast<std::size_t>(axis_)] = slice;
  p[static_cast<std::size_t>(axes_[0])] = flipped_[0] ? columns_ - 1 - column : column;
  p[static_cast<std::size_t>(axes_[1])] = flipped_[1] ? rows_ - 1 - row : row;
  return p;
}

std::array<std::string, 4> SliceGeometry::sides() const {
  const Eigen::Vector3d right = (flipped_[0] ? -1.0 : 1.0) * direction_.col(axes_[0]),
                        down = (flipped_[1] ? -1.0 : 1.0) * direction_.col(axes_[1]);
  return {letter(-right), letter(right), letter(-down), letter(down)};
}

std::string SliceGeometry::name() const {
  Eigen::Index dominant = 0;
  direction_.col(axis_).cwiseAbs().maxCoeff(&dominant);
  return dominant == 0 ? "sagittal" : dominant == 1 ? "coronal" : "axial";
}

std::vector<std::uint8_t> slice_image(const zmc::VolumeView& volume, const SliceGeometry& geometry,
                                      std::int64_t slice, const Window& window) {
  const std::array<std::int64_t, 3> strides = volume.effective_strides();
  const auto element = [&strides](const std::array<std::int64_t, 3>& p) {
    return p[0] * strides[0] + p[1] * strides[1] + p[2] * strides[2];
  };
  const std::int64_t first = element(geometry.sample(0, 0, slice)),
                     across = element(geometry.sample(1, 0, slice)) - first,
                     down = element(geometry.sample(0, 1, slice)) - first;
  const int columns = geometry.columns(), rows = geometry.rows();
  std::vector<std::uint8_t> image(static_cast<std::size_t>(columns) *
                                  static_cast<std::size_t>(rows));
  const double black = window.black(), scale = 255.0 / window.width;
  with_samples(volume, [&](const auto* data) {
    std::uint8_t* pixel = image.data();
    for (int row = 0; row < rows; ++row) {
      const auto* at = data + first + row * down;
      for (int column = 0; column < columns; ++column, at += across) {
        const double grey = (static_cast<double>(*at) - black) * scale + 0.5;
        // The comparison also sends NaN to black.
        *pixel++ = grey > 0.0 ? static_cast<std::uint8_t>(std::min(grey, 255.0)) : std::uint8_t{0};
      }
    }
  });
  return image;
}

SliceLines slice_contour(const zmc::VolumeView& volume, const SliceGeometry& geometry,
                         double isovalue, std::int64_t slice, bool exact) {
  return part_contour(volume, geometry, volume, isovalue, slice, exact);
}

SliceLines part_contour(const zmc::VolumeView& whole, const SliceGeometry& geometry,
                        const zmc::VolumeView& part, double isovalue, std::int64_t slice,
                        bool exact) {
  zmc::Options options;
  options.non_finite = zmc::NonFinite::mask;
  zmc::VolumeView layer = part;
  std::int64_t plane = slice;
  if (!exact) {
    const auto axis = static_cast<std::size_t>(geometry.axis());
    std::array<std::int64_t, 3> lower{0, 0, 0}, upper = part.dims;
    // zmc::contour() takes the cells above the plane, below the last one.
    lower[axis] = std::min(slice, part.dims[axis] - 2);
    upper[axis] = lower[axis] + 2;
    layer = zmc::subvolume(part, lower, upper);
    plane = slice - lower[axis];
  }
  const zmc::Contour contour = zmc::contour(layer, isovalue, geometry.axis(), plane, options);
  const Eigen::Matrix3d to_lattice = (whole.direction * whole.spacing.asDiagonal()).inverse();
  SliceLines lines;
  for (const Polyline& line : join_edges(contour)) {
    std::vector<std::array<double, 2>> points;
    for (const std::int32_t v : line.vertices)
      points.push_back(geometry.place(to_lattice * (contour.V.row(v).transpose() - whole.origin)));
    if (line.closed) points.push_back(points.front());
    lines.push_back(std::move(points));
  }
  return lines;
}

}  // namespace shape3d::apps::viewer
