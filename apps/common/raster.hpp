#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "color_map.hpp"

namespace shape3d::apps {

/// Pixels of red, green and blue bytes, the top row first.
struct Raster {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 · width · height.
};

/// @pre  width and height are positive.
[[nodiscard]] Raster make_raster(int width, int height, const Color& color);

/// Copies `source` so that its top left pixel is at (x, y); what lies outside is left out.
void paste(Raster& target, const Raster& source, int x, int y);

/// Fills a rectangle; what lies outside is left out.
void fill(Raster& target, int x, int y, int width, int height, const Color& color);

/// Each pixel becomes the pixel of `source` under its centre: for enlarging data without mixing.
[[nodiscard]] Raster resized(const Raster& source, int width, int height);

/// The same picture in another size: mixes neighbouring pixels (with weights that fall off linearly
/// over a pixel, of the old or the new size, whichever is larger).
[[nodiscard]] Raster resampled(const Raster& source, int width, int height);

enum class TextAlign { left, centre, right };

/// Writes one line of text (Latin letters, digits and signs; others are left out) with its baseline
/// at y, its left end, middle or right end at x.
/// @param size  Height of a line, pixels.
void draw_text(Raster& target, const std::string& text, int x, int y, int size, TextAlign align,
               const Color& color = {0.0, 0.0, 0.0}, bool bold = false);

/// Width of a line of text, pixels.
[[nodiscard]] int text_width(const std::string& text, int size, bool bold = false);

/// The bytes of a PNG file.
[[nodiscard]] std::string to_png(const Raster& raster);

}  // namespace shape3d::apps
