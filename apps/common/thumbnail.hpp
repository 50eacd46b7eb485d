#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mesh.hpp"
#include "private_display.hpp"
#include "raster.hpp"

namespace shape3d::apps {

class SceneRenderer;

inline constexpr int kThumbnailSize = 256;  ///< Pixels, width and height.
inline constexpr Color kThumbnailPaper{1.0, 1.0, 1.0};

/// Draws small pictures of meshes, seen from in front, a little from the right and above, with the
/// y axis upwards; several processes draw at a time.
class ThumbnailPainter {
 public:
  /// @param threads  Processes that draw at the same time; 0: as many as processors.
  explicit ThumbnailPainter(int threads = 0);
  ~ThumbnailPainter();

  /// A PNG for each mesh file; empty where it cannot be read or drawn.
  /// @throws PictureError  no display works.
  [[nodiscard]] std::vector<std::string> draw(const std::vector<std::string>& paths);

 private:
  std::string display_;
  std::unique_ptr<PrivateDisplay> own_display_;
  std::size_t processes_;
};

/// The same of one mesh in memory.
/// @throws PictureError  it has no triangle; no display works.
[[nodiscard]] std::string draw_thumbnail(const Mesh& mesh);

/// The same with a renderer of that size and paper, where windows of VTK can be opened.
/// @pre  The mesh has a triangle.
[[nodiscard]] Raster thumbnail_raster(const Mesh& mesh, SceneRenderer& renderer);

/// The pixels of a PNG of thumbnails. @throws PictureError  it is no PNG.
[[nodiscard]] Raster decode_png_raster(const std::string& png);

}  // namespace shape3d::apps
