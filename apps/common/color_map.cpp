#include "color_map.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace shape3d::apps {
namespace {

struct NamedColor {
  std::string_view name;
  Color color;
};
constexpr NamedColor kColors[] = {{"bone", {0.96, 0.92, 0.84}},   {"skin", {0.87, 0.68, 0.56}},
                                  {"red", {0.77, 0.25, 0.22}},    {"green", {0.36, 0.60, 0.36}},
                                  {"blue", {0.31, 0.48, 0.70}},   {"yellow", {0.88, 0.75, 0.32}},
                                  {"orange", {0.85, 0.54, 0.25}}, {"purple", {0.52, 0.39, 0.63}},
                                  {"grey", {0.62, 0.62, 0.62}},   {"white", {1.0, 1.0, 1.0}}};

// Ten equal steps of each map, between which colors are mixed.
using Stops = std::array<std::uint32_t, 11>;
constexpr Stops kViridis{0x440154, 0x482475, 0x414487, 0x355f8d, 0x2a788e, 0x21918c,
                         0x22a884, 0x44bf70, 0x7ad151, 0xbddf26, 0xfde725};
constexpr Stops kInferno{0x000004, 0x160b39, 0x420a68, 0x6a176e, 0x932667, 0xbc3754,
                         0xdd513a, 0xf37819, 0xfca50a, 0xf6d746, 0xfcffa4};
constexpr Stops kCoolWarm{0x3b4cc0, 0x5977e3, 0x7b9ff9, 0x9ebeff, 0xc0d4f5, 0xdddcdc,
                          0xf2cbb7, 0xf7ac8e, 0xee8468, 0xd65244, 0xb40426};
constexpr Stops kGrey{0x000000, 0x1a1a1a, 0x333333, 0x4d4d4d, 0x666666, 0x808080,
                      0x999999, 0xb3b3b3, 0xcccccc, 0xe6e6e6, 0xffffff};

constexpr Color unpack(std::uint32_t rgb) {
  return {(rgb >> 16) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0};
}

const Stops& stops_of(ColorMap map) {
  switch (map) {
    case ColorMap::viridis:
      return kViridis;
    case ColorMap::inferno:
      return kInferno;
    case ColorMap::cool_warm:
      return kCoolWarm;
    case ColorMap::grey:
      return kGrey;
  }
  return kGrey;
}

std::uint8_t byte_of(double share) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

// With the digits that tell apart numbers a step from each other.
std::string label_of(double value, double step) {
  std::array<char, 64> text{};
  const double size = std::max(std::abs(value), step);
  if (size >= 1e5 || size < 1e-3) {
    const double digits = std::ceil(std::log10(size / step) - 1e-9) + 1;
    std::snprintf(text.data(), text.size(), "%.*g", std::clamp(static_cast<int>(digits), 3, 17),
                  value);
  } else {
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
    std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  }
  return text.data();
}

std::vector<Tick> even_ticks(double lower, double upper, int most) {
  const double range = upper - lower;
  double step = std::pow(10.0, std::floor(std::log10(range / most)));
  for (const double factor : {2.0, 2.5, 2.0, 2.0, 2.5, 2.0}) {  // 1, 2, 5, 10 …
    const double count = std::floor(upper / step * (1 + 1e-12)) - std::ceil(lower / step) + 1;
    if (count <= most) break;
    step *= factor;
  }
  std::vector<Tick> ticks;
  const double slack = 1e-9 * range;
  for (double n = std::ceil((lower - slack) / step); n * step <= upper + slack; ++n) {
    const double value = n == 0.0 ? 0.0 : n * step;
    ticks.push_back({value, label_of(value, step)});
  }
  return ticks;
}

std::vector<Tick> logarithmic_ticks(double lower, double upper, int most) {
  for (const auto& factors : {std::vector<double>{1.0, 2.0, 5.0}, std::vector<double>{1.0}}) {
    std::vector<Tick> ticks;
    for (double power = std::floor(std::log10(lower)); power <= std::log10(upper) + 1e-9; ++power) {
      for (const double factor : factors) {
        const double value = factor * std::pow(10.0, power);
        if (value < lower * (1 - 1e-9) || value > upper * (1 + 1e-9)) continue;
        ticks.push_back({value, label_of(value, std::pow(10.0, power))});
      }
    }
    if (static_cast<int>(ticks.size()) <= most) return ticks;
  }
  // Powers of ten that skip some.
  const double first = std::ceil(std::log10(lower) - 1e-9);
  const double last = std::floor(std::log10(upper) + 1e-9);
  const double step = std::ceil((last - first + 1) / most);
  std::vector<Tick> ticks;
  for (double power = first; power <= last; power += step) {
    ticks.push_back({std::pow(10.0, power), label_of(std::pow(10.0, power), 1e9)});
  }
  return ticks;
}

}  // namespace

std::optional<Color> color_named(std::string_view name) {
  for (const NamedColor& color : kColors) {
    if (color.name == name) return color.color;
  }
  std::uint32_t value = 0;
  if (name.size() != 7 || name[0] != '#') return std::nullopt;
  const auto [end, error] = std::from_chars(name.data() + 1, name.data() + 7, value, 16);
  if (error != std::errc{} || end != name.data() + 7) return std::nullopt;
  return unpack(value);
}

std::optional<ColorMap> color_map_named(std::string_view name) {
  if (name == "viridis") return ColorMap::viridis;
  if (name == "inferno") return ColorMap::inferno;
  if (name == "cool_warm") return ColorMap::cool_warm;
  if (name == "grey") return ColorMap::grey;
  return std::nullopt;
}

Color color_at(ColorMap map, double t) {
  const Stops& stops = stops_of(map);
  const double at = 10.0 * std::clamp(t, 0.0, 1.0);
  const auto low = std::min<std::size_t>(9, static_cast<std::size_t>(at));
  const double share = at - static_cast<double>(low);
  const Color a = unpack(stops[low]), b = unpack(stops[low + 1]);
  Color mixed{};
  for (std::size_t c = 0; c < 3; ++c) mixed[c] = (1 - share) * a[c] + share * b[c];
  return mixed;
}

double ColorScale::share_of(double value) const {
  const double share = logarithmic ? std::log(value / lower) / std::log(upper / lower)
                                   : (value - lower) / (upper - lower);
  if (std::isnan(share)) return 0.5;
  return std::clamp(share, 0.0, 1.0);
}

std::vector<std::uint8_t> colors_of(const double* values, std::size_t count,
                                    const ColorScale& scale) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const Color color =
        std::isnan(values[i]) ? kNoValueColor : color_at(scale.map, scale.share_of(values[i]));
    for (const double part : color) bytes.push_back(byte_of(part));
  }
  return bytes;
}

std::vector<std::uint8_t> colors_of_directions(const double* vectors, std::size_t count) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * count);
  for (std::size_t i = 0; i < 3 * count; ++i) bytes.push_back(byte_of(0.5 * (1 + vectors[i])));
  return bytes;
}

Color light_color(int group) {
  if (group < 0) return {1.0, 1.0, 1.0};
  const double hue = std::fmod(0.08 + 0.6180339887498949 * group, 1.0) * 6.0;
  const double lowest = group % 2 == 0 ? 0.72 : 0.60;
  Color color{};
  for (int c = 0; c < 3; ++c) {
    const double k = std::fmod(hue + 5.0 - 2.0 * c + 6.0, 6.0);
    const double share = std::clamp(std::min(k, 4.0 - k), 0.0, 1.0);
    color[static_cast<std::size_t>(c)] = 1.0 - (1.0 - lowest) * share;
  }
  return color;
}

std::vector<Tick> ticks_of(const ColorScale& scale, int most) {
  std::vector<Tick> ticks;
  if (scale.lower < scale.upper) {
    ticks = scale.logarithmic ? logarithmic_ticks(scale.lower, scale.upper, std::max(2, most))
                              : even_ticks(scale.lower, scale.upper, std::max(2, most));
  }
  if (ticks.size() >= 2) return ticks;
  const double step = (scale.upper - scale.lower) / 10;
  const auto end = [step](double value) {
    return Tick{value, label_of(value, step > 0 ? std::pow(10.0, std::floor(std::log10(step)))
                                                : std::max(std::abs(value), 1e-9) / 100)};
  };
  if (scale.lower == scale.upper) return {end(scale.lower)};
  return {end(scale.lower), end(scale.upper)};
}

}  // namespace shape3d::apps
