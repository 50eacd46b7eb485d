#include "volume_header.hpp"

#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "error.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

// Below it the volume of the parallelepiped of three unit axes counts as none: its two axes closest
// to each other are then less than about 1e-6 rad apart.
constexpr double kFlat = 1e-6;

constexpr std::array<const char*, 3> kAxes{"i", "j", "k"};

std::string vector_text(const Eigen::Vector3d& v) {
  return "(" + to_text(v[0]) + ", " + to_text(v[1]) + ", " + to_text(v[2]) + ")";
}

void check_axes(const Eigen::Matrix3d& direction, const std::filesystem::path& path) {
  const double volume = direction.determinant();
  if (std::abs(volume) >= kFlat) return;
  throw FileError(path, "direction is singular: the axes " + vector_text(direction.col(0)) + ", " +
                            vector_text(direction.col(1)) + ", " + vector_text(direction.col(2)) +
                            " lie in a plane");
}

void check_origin(const Eigen::Vector3d& origin, const std::filesystem::path& path) {
  if (!origin.allFinite())
    throw FileError(path, "origin " + vector_text(origin) + " is not finite");
}

}  // namespace

std::string_view to_string(StoredType type) {
  switch (type) {
    case StoredType::int8:
      return "int8";
    case StoredType::uint8:
      return "uint8";
    case StoredType::int16:
      return "int16";
    case StoredType::uint16:
      return "uint16";
    case StoredType::int32:
      return "int32";
    case StoredType::uint32:
      return "uint32";
    case StoredType::int64:
      return "int64";
    case StoredType::uint64:
      return "uint64";
    case StoredType::float32:
      return "float32";
    case StoredType::float64:
      return "float64";
  }
  return "unknown";
}

std::size_t sample_size(StoredType type) {
  switch (type) {
    case StoredType::int8:
    case StoredType::uint8:
      return 1;
    case StoredType::int16:
    case StoredType::uint16:
      return 2;
    case StoredType::int32:
    case StoredType::uint32:
    case StoredType::float32:
      return 4;
    case StoredType::int64:
    case StoredType::uint64:
    case StoredType::float64:
      return 8;
  }
  return 0;
}

void set_affine(VolumeHeader& header, const Eigen::Matrix3d& columns, const Eigen::Vector3d& origin,
                const std::filesystem::path& path) {
  // Lengths within a few roundings of 1 are unit vectors as a file writes them.
  constexpr double kUnit = 8 * std::numeric_limits<double>::epsilon();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = columns.col(axis);
    const double length = step.stableNorm();
    if (!std::isfinite(length) || !(length > 0.0)) {
      throw FileError(path, std::string("the step from sample to sample along ") + kAxes[axis] +
                                " is " + vector_text(step) +
                                "; expected a finite vector that is not zero");
    }
    header.spacing[axis] = std::abs(length - 1.0) <= kUnit ? 1.0 : length;
    header.direction.col(axis) = step / header.spacing[axis];
  }
  header.origin = origin;
  check_origin(origin, path);
  check_axes(header.direction, path);
}

void check_header(const VolumeHeader& header, const std::filesystem::path& path) {
  const auto& dims = header.dims;
  std::int64_t bytes = static_cast<std::int64_t>(sample_size(header.type));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (dims[axis] < 1) {
      throw FileError(path, "dimensions " + to_text(dims) + ": " + std::to_string(dims[axis]) +
                                " along " + kAxes[axis] + "; expected a positive number");
    }
    if (__builtin_mul_overflow(bytes, dims[axis], &bytes)) {
      throw FileError(path, "dimensions " + to_text(dims) + ": more samples than can be addressed");
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (dims[axis] == 1) {
      throw FileError(path, "dimensions " + to_text(dims) + ": one sample thick along " +
                                kAxes[axis] +
                                "; a volume needs at least two samples along each axis");
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double spacing = header.spacing[axis];
    if (!std::isfinite(spacing) || !(spacing > 0.0)) {
      throw FileError(path, "spacing " + to_text(spacing) + " along " + kAxes[axis] +
                                "; expected a finite positive number");
    }
  }
  check_origin(header.origin, path);
  if (!header.direction.allFinite()) throw FileError(path, "direction is not finite");
  check_axes(header.direction, path);
  if (!std::isfinite(header.slope) || !std::isfinite(header.intercept)) {
    throw FileError(path, "slope " + to_text(header.slope) + " and intercept " +
                              to_text(header.intercept) + "; expected finite numbers");
  }
}

std::uint64_t payload_bytes(const VolumeHeader& header) {
  std::uint64_t bytes = sample_size(header.type);
  for (const std::int64_t n : header.dims) bytes *= static_cast<std::uint64_t>(n);
  return bytes;
}

std::string samples_text(const std::array<std::int64_t, 3>& dims, StoredType type) {
  return to_text(dims) + " " + std::string(to_string(type)) + " samples";
}

}  // namespace shape3d::apps
