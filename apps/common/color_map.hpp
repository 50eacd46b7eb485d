#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shape3d::apps {

using Color = std::array<double, 3>;  ///< Red, green, blue, 0 … 1.

/// "#rrggbb", or one of the names in kColorNames; empty for another word.
[[nodiscard]] std::optional<Color> color_named(std::string_view name);
inline constexpr std::string_view kColorNames =
    "bone, skin, red, green, blue, yellow, orange, purple, grey, white";

/// How numbers become colors. viridis and inferno grow evenly in lightness from dark to bright;
/// cool_warm runs from blue over light grey to red, for numbers with a neutral middle; grey runs
/// from black to white.
enum class ColorMap { viridis, inferno, cool_warm, grey };

/// By its name; empty for another word.
[[nodiscard]] std::optional<ColorMap> color_map_named(std::string_view name);
inline constexpr std::string_view kColorMapNames = "viridis, inferno, cool_warm, grey";

/// @param t  0 … 1, clamped.
[[nodiscard]] Color color_at(ColorMap map, double t);

/// Numbers as colors, and the bar beside a picture that explains them.
struct ColorScale {
  ColorMap map = ColorMap::viridis;
  double lower = 0.0, upper = 1.0;  ///< Numbers of the first and the last color.
  /// Equal ratios are equal steps of color; needs 0 < lower < upper.
  bool logarithmic = false;
  std::string title;  ///< Over the bar, with the unit: "angle change (degrees)".

  /// Where a number stands, 0 … 1, clamped; 1/2 when lower = upper.
  [[nodiscard]] double share_of(double value) const;
};

inline constexpr Color kNoValueColor{0.55, 0.55, 0.55};  ///< Of NaN.

/// Red, green and blue bytes of each number in turn, for SceneMesh; NaN is kNoValueColor.
[[nodiscard]] std::vector<std::uint8_t> colors_of(const double* values, std::size_t count,
                                                  const ColorScale& scale);

/// Red, green and blue bytes of unit vectors: (x, y, z) → 127.5 (1 + x, 1 + y, 1 + z), as normals
/// are shown in Fig. 4.3. A zero vector is grey.
/// @param vectors  x y z of the first vector first.
[[nodiscard]] std::vector<std::uint8_t> colors_of_directions(const double* vectors,
                                                             std::size_t count);

/// Colors behind dark text for groups that are numbered: light, of hues that are far apart for
/// numbers that are near. White for negative numbers.
[[nodiscard]] Color light_color(int group);

/// A number at a mark of the bar.
struct Tick {
  double value = 0.0;
  std::string label;
};

/// Round numbers within the scale (1, 2 or 5 times a power of ten apart; powers and their doubles
/// and halves when logarithmic), up to `most`, which is at least 2, with as many digits as tell
/// them apart. The two ends when no two round numbers are within.
[[nodiscard]] std::vector<Tick> ticks_of(const ColorScale& scale, int most);

}  // namespace shape3d::apps
