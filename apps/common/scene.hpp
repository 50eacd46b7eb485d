#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "color_map.hpp"
#include "mesh.hpp"
#include "raster.hpp"

namespace shape3d::apps {

/// From where a patient, or any mesh in LPS, is looked at; oblique is between front, left and top.
/// upright is for meshes whose y axis points up and whose z axis points forward, as in most
/// collections of shapes: from in front, a little from the right and above.
enum class View { front, back, left, right, top, bottom, oblique, upright };

/// By its name; empty for another word.
[[nodiscard]] std::optional<View> view_named(std::string_view name);
inline constexpr std::string_view kViewNames =
    "front, back, left, right, top, bottom, oblique, upright";

/// One mesh of a picture. A mesh whose space is RAS is turned into LPS.
struct SceneMesh {
  MeshView mesh;
  Color color{0.96, 0.92, 0.84};
  double opacity = 1.0;       ///< 0 … 1.
  bool largest_only = false;  ///< Only the component of the most triangles.
  /// Red, green and blue of each vertex in turn (colors_of()), instead of `color`; empty: none.
  std::vector<std::uint8_t> vertex_colors = {};
  /// The same of each triangle; goes before vertex_colors.
  std::vector<std::uint8_t> triangle_colors = {};
  bool edges = false;    ///< Draws the edges of the triangles as dark lines.
  double shading = 1.0;  ///< 0 shows colors as they are, without light; 1 is full light and shade.
};

/// Draws meshes with smooth shading, ambient occlusion (when all are opaque and fully shaded) and
/// 2 × 2 samples a pixel, in a window of VTK: call within draw_offscreen().
/// @pre  At least one mesh has a triangle.
[[nodiscard]] Raster render_scene(const std::vector<SceneMesh>& meshes, View view, int width,
                                  int height, const Color& background);

/// Draws one picture after another in one window, which takes less time than a window for each.
/// For use within draw_offscreen().
class SceneRenderer {
 public:
  SceneRenderer(int width, int height, const Color& background);
  ~SceneRenderer();
  SceneRenderer(const SceneRenderer&) = delete;
  SceneRenderer& operator=(const SceneRenderer&) = delete;

  /// As render_scene(); without any triangle, the background.
  [[nodiscard]] Raster render(const std::vector<SceneMesh>& meshes, View view);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shape3d::apps
