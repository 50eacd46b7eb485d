#pragma once

#include <optional>
#include <string>
#include <vector>

#include "private_display.hpp"
#include "scene.hpp"

namespace shape3d::apps {

struct PictureOptions {
  int width = 1000, height = 1000;  ///< Pixels, 16 … 8192.
  View view = View::front;
  Color background{1.0, 1.0, 1.0};
  bool private_display = false;  ///< Never the display of the environment.
};

/// Draws meshes as render_scene() does.
///
/// The drawing is done in a child process on the display of the environment variable DISPLAY if
/// that is set and works, on a private Xvfb otherwise.
/// @return PNG bytes.
/// @throws PictureError  there is no triangle to draw; a list of colors does not fit its mesh; no
/// display works.
[[nodiscard]] std::string draw_png(const std::vector<SceneMesh>& meshes,
                                   const PictureOptions& options);

/// A part of a picture: meshes or an image, with a line of text above and a color bar below.
struct Panel {
  std::vector<SceneMesh> meshes = {};
  Raster image = {};          ///< Drawn when there are no meshes; as large as fits.
  bool smooth_image = false;  ///< Mixes the pixels of an enlarged image; else they are squares.
  std::string caption = {};   ///< Above; empty: none.
  std::optional<ColorScale> scale = std::nullopt;  ///< Its bar is drawn below.
  std::optional<View> view = std::nullopt;         ///< Instead of PictureOptions::view.
};

/// Draws panels of one size side by side, row after row. Text and bars are black or white,
/// whichever stands out from the background. A picture of images alone needs no display.
/// @param columns  Panels in a row; 0: all in one row. options.width and height are the picture's.
/// @throws PictureError  as draw_png(); there is no panel; a panel is empty; the picture is too
/// small for its panels (each needs 32 pixels square besides its text).
[[nodiscard]] std::string draw_panels(const std::vector<Panel>& panels,
                                      const PictureOptions& options, int columns = 0);

}  // namespace shape3d::apps
