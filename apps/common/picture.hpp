#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh.hpp"
#include "private_display.hpp"

namespace shape3d::apps {

/// From where a patient, or any mesh in LPS, is looked at; oblique is between front, left and top.
enum class View { front, back, left, right, top, bottom, oblique };

/// By its name; empty for another word.
[[nodiscard]] std::optional<View> view_named(std::string_view name);
/// "front, back, left, right, top, bottom, oblique".
inline constexpr std::string_view kViewNames = "front, back, left, right, top, bottom, oblique";

using Color = std::array<double, 3>;  ///< Red, green, blue, 0 … 1.

/// "#rrggbb", or one of the names in kColorNames; empty for another word.
[[nodiscard]] std::optional<Color> color_named(std::string_view name);
inline constexpr std::string_view kColorNames =
    "bone, skin, red, green, blue, yellow, orange, purple, grey, white";

/// One mesh of a picture. A mesh whose space is RAS is turned into LPS.
struct SceneMesh {
  MeshView mesh;
  Color color{0.96, 0.92, 0.84};
  double opacity = 1.0;       ///< 0 … 1.
  bool largest_only = false;  ///< Only the component of the most triangles.
};

struct PictureOptions {
  int width = 1000, height = 1000;  ///< Pixels, 16 … 8192.
  View view = View::front;
  Color background{1.0, 1.0, 1.0};
  bool private_display = false;  ///< Never the display of the environment.
};

/// Draws meshes with smooth shading, ambient occlusion (when all are opaque) and 2 × 2 samples a
/// pixel.
///
/// The drawing is done in a child process on the display of the environment variable DISPLAY if
/// that is set and works, on a private Xvfb otherwise.
/// @return PNG bytes.
/// @throws PictureError  there is no triangle to draw; no display works.
[[nodiscard]] std::string draw_png(const std::vector<SceneMesh>& meshes,
                                   const PictureOptions& options);

}  // namespace shape3d::apps
