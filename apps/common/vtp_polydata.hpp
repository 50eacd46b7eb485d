#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh.hpp"

namespace shape3d::apps::formats {

/// What a VTP file holds as far as a mesh needs it, as VTK read it: nothing of it is checked.
struct VtpPolyData {
  std::vector<double> points;              ///< x y z of point 0 first.
  std::vector<std::int64_t> offsets, ids;  ///< Of the polygons: ids[offsets[p] … offsets[p + 1]).
  std::int64_t strips = 0;
  std::int64_t lines_and_points = 0;
  std::vector<MeshArray> point_arrays;  ///< One number a point.
  std::vector<MeshArray> cell_arrays;   ///< One number a cell of any kind.
  std::string space;                    ///< Of the field data; empty without.
};

/// Reads with VTK in a child process, so that a file on which VTK's parser aborts, crashes or hangs
/// does not take this process with it.
/// @throws FileError  VTK reports an error, or ends so.
[[nodiscard]] VtpPolyData read_vtp(std::string_view bytes, const std::string& name);

}  // namespace shape3d::apps::formats
