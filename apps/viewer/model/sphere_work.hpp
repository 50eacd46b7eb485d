#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/color_map.hpp"
#include "common/mesh.hpp"
#include "common/raster.hpp"

namespace shape3d::apps::viewer {

/// What mesh and sphere are coloured by.
enum class SphereColor { normal, curvature, coordinates, angle, area };

struct SphereColorName {
  SphereColor color;
  std::string_view name, title;
};
inline constexpr std::array<SphereColorName, 5> kSphereColors{
    {{SphereColor::normal, "normal", "Normal (SNI)"},
     {SphereColor::curvature, "curvature", "Curvature (SCI)"},
     {SphereColor::coordinates, "coordinates", "Coordinates (SGI)"},
     {SphereColor::angle, "angle", "Angle distortion"},
     {SphereColor::area, "area", "Area factor"}}};

/// A colouring of mesh and sphere, and the image in latitude and longitude.
struct SphereColoring {
  std::vector<std::uint8_t> bytes;  ///< Red, green, blue of each vertex or triangle.
  bool of_triangles = false;
  Raster image;
  ColorScale scale;  ///< Of numbers; not used by normals and coordinates.
  bool has_scale = false;
};

/// A mesh, its spherical map and what is shown of both.
struct SphereResult {
  std::string error;  ///< A sentence on why there is no map; empty: there is one.
  bool cancelled = false;
  Mesh mesh;    ///< Scaled to RMS radius 1 round its centroid, in its own orientation.
  Mesh sphere;  ///< The same triangles on the unit sphere, turned as the mesh is.
  std::array<SphereColoring, 5> colorings;  ///< In the order of SphereColor.
  double median_angle_change = 0.0, p95_angle_change = 0.0, energy_over_area = 0.0;
  double seconds = 0.0;
};

struct SphereWish {
  bool linear = false;        ///< Without Ceres: faster, less conformal.
  double area_balance = 0.0;  ///< As in mapping::SphericalMapOptions.
  int image_size = 256;       ///< Rows of the image.
};

/// Maps a mesh to the sphere and colours it. The image is that of the mesh in its canonical pose
/// (mapping::align), as descriptors see it: north is its third axis.
/// @param progress  Share done, 0 … 1; false cancels.
/// No exceptions but std::bad_alloc: what cannot be mapped is `error`.
[[nodiscard]] SphereResult map_and_color(const Mesh& mesh, const SphereWish& wish,
                                         const std::function<bool(double)>& progress);

}  // namespace shape3d::apps::viewer
