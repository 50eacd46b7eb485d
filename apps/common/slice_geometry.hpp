#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace shape3d::apps {

/// One slice of a series as DICOM describes it: LPS, millimetres.
struct SlicePlace {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< Centre of the first sample.
  Eigen::Vector3d row = Eigen::Vector3d::UnitX();      ///< Direction of growing column index (i).
  Eigen::Vector3d column = Eigen::Vector3d::UnitY();   ///< Direction of growing row index (j).
  double column_spacing = 1.0;                         ///< Between columns, along `row`.
  double row_spacing = 1.0;                            ///< Between rows, along `column`.
  std::string name;                                    ///< File, and frame where it has several.
};

/// The lattice that slices form.
struct SliceStack {
  std::vector<std::size_t> order;  ///< Slice k of the volume is slices[order[k]].
  Eigen::Matrix3d steps =
      Eigen::Matrix3d::Identity();  ///< Columns: from sample to sample along i, j, k.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<std::string> warnings;
};

/// Orders slices along row × column and checks that they form a lattice, equal steps on a line. The
/// step along k is (last − first position) / (n − 1): where it is not parallel to row × column
/// (tilted gantry) the lattice is sheared, which is exact, and a warning says by how much.
///
/// Allowed: orientations and spacings that differ by decimal rounding (1e-4 of a unit, 1e-3 of the
/// spacing); positions off the lattice by up to 5 % of the step, with a warning from 1 % on.
///
/// @throws FileError  fewer than two slices; slices of different orientation or spacing; an
/// orientation
///         that is not two orthogonal unit vectors; a spacing that is not finite and positive;
///         several slices at one place (how many volumes, when it is the same number everywhere);
///         missing slices (how many, between which); uneven steps. Messages name slices and
///         distances.
[[nodiscard]] SliceStack stack_slices(const std::vector<SlicePlace>& slices,
                                      const std::filesystem::path& path);

}  // namespace shape3d::apps
