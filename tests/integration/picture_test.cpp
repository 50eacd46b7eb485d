// Pictures, looked at pixel by pixel.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <catch2/catch.hpp>

#include "common/picture.hpp"
#include "png_image.hpp"

namespace {
using namespace shape3d::apps;

using Pixel = std::array<int, 3>;

using shape3d::test::decode_png;
using shape3d::test::PngImage;

Pixel pixel(const PngImage& image, int x, int y) {
  const auto& bytes = image.at(x, y);
  return {bytes[0], bytes[1], bytes[2]};
}

Pixel pixel(const Raster& raster, int x, int y) {
  const std::uint8_t* at = raster.rgb.data() + 3 * (y * raster.width + x);
  return {at[0], at[1], at[2]};
}

double lightness(const Color& color) {  // CIE L* / 100
  const auto linear = [](double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  const double y =
      0.2126 * linear(color[0]) + 0.7152 * linear(color[1]) + 0.0722 * linear(color[2]);
  return y > 0.008856 ? 1.16 * std::cbrt(y) - 0.16 : 9.033 * y;
}

// A square in the plane y = 0, seen from the front, of two triangles.
Mesh square() {
  Mesh mesh;
  mesh.V.resize(4, 3);
  mesh.V << -1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1;
  mesh.F.resize(2, 3);
  mesh.F << 0, 1, 2, 0, 2, 3;
  return mesh;
}

TEST_CASE("color maps grow evenly in lightness", "[picture][color]") {
  for (const ColorMap map : {ColorMap::viridis, ColorMap::inferno, ColorMap::grey}) {
    const double first = lightness(color_at(map, 0)), last = lightness(color_at(map, 1));
    CHECK(last - first > 0.7);
    for (int i = 1; i <= 20; ++i) {
      const double step =
          lightness(color_at(map, i / 20.0)) - lightness(color_at(map, (i - 1) / 20.0));
      INFO(static_cast<int>(map) << " at " << i);
      CHECK(step > 0.0);
      CHECK(step == Approx((last - first) / 20).margin(0.03));
    }
  }
  // The neutral middle is the lightest, and both sides are alike in lightness.
  for (int i = 0; i <= 10; ++i) {
    CHECK(lightness(color_at(ColorMap::cool_warm, i / 20.0)) ==
          Approx(lightness(color_at(ColorMap::cool_warm, 1 - i / 20.0))).margin(0.09));
    if (i > 0) {
      CHECK(lightness(color_at(ColorMap::cool_warm, i / 20.0)) >
            lightness(color_at(ColorMap::cool_warm, (i - 1) / 20.0)));
    }
  }
  CHECK(color_at(ColorMap::grey, -3)[0] == 0.0);
  CHECK(color_at(ColorMap::grey, 7)[0] == 1.0);
}

TEST_CASE("names of colors and color maps", "[picture][color]") {
  CHECK(color_named("#ff8000")->at(1) == Approx(128 / 255.0));
  CHECK(color_named("bone").has_value());
  CHECK_FALSE(color_named("#ff800").has_value());
  CHECK_FALSE(color_named("bones").has_value());
  CHECK(color_map_named("viridis") == ColorMap::viridis);
  CHECK(color_map_named("inferno") == ColorMap::inferno);
  CHECK(color_map_named("cool_warm") == ColorMap::cool_warm);
  CHECK(color_map_named("grey") == ColorMap::grey);
  CHECK_FALSE(color_map_named("jet").has_value());
}

TEST_CASE("numbers and directions become colors", "[picture][color]") {
  const double values[] = {-1.0, 0.0, 5.0, 10.0, 20.0, std::nan("")};
  const auto bytes = colors_of(values, 6, {ColorMap::grey, 0.0, 10.0, false, ""});
  CHECK(bytes == std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 128, 128, 128, 255, 255, 255, 255, 255,
                                           255, 140, 140, 140});
  const ColorScale decades{ColorMap::grey, 1.0, 100.0, true, ""};
  CHECK(decades.share_of(10.0) == Approx(0.5));
  CHECK(decades.share_of(0.5) == 0.0);
  CHECK((ColorScale{ColorMap::grey, 3.0, 3.0, false, ""}.share_of(3.0)) == 0.5);
  const double normals[] = {1, 0, 0, 0, -1, 0};
  CHECK(colors_of_directions(normals, 2) == std::vector<std::uint8_t>{255, 128, 128, 128, 0, 128});
}

TEST_CASE("ticks are round, within the scale and few", "[picture][color]") {
  const auto labels = [](double lower, double upper, bool logarithmic, int most) {
    std::vector<std::string> texts;
    for (const Tick& tick : ticks_of({ColorMap::viridis, lower, upper, logarithmic, ""}, most)) {
      CHECK(tick.value >= lower - 1e-9 * std::abs(lower));
      CHECK(tick.value <= upper + 1e-9 * std::abs(upper));
      texts.push_back(tick.label);
    }
    CHECK(texts.size() >= 2);
    CHECK(texts.size() <= static_cast<std::size_t>(most));
    CHECK(std::set<std::string>(texts.begin(), texts.end()).size() == texts.size());
    return texts;
  };
  CHECK(labels(0, 10, false, 6) == std::vector<std::string>{"0", "2", "4", "6", "8", "10"});
  CHECK(labels(-1, 1, false, 5) == std::vector<std::string>{"-1.0", "-0.5", "0.0", "0.5", "1.0"});
  CHECK(labels(0.013, 0.042, false, 4) == std::vector<std::string>{"0.02", "0.03", "0.04"});
  CHECK(labels(1, 10, true, 6) == std::vector<std::string>{"1", "2", "5", "10"});
  CHECK(labels(1.4, 1.6, true, 4).size() == 2);
  labels(1e-12, 1e12, true, 5);
  labels(12345678, 12345999, false, 5);
  labels(-3e-9, 8e-9, false, 7);
  for (int most = 2; most < 12; ++most) labels(0, std::pow(1.7, most), false, most);
}

TEST_CASE("vertex and triangle colors are drawn as given", "[picture][panels]") {
  const Mesh mesh = square();
  PictureOptions options;
  options.width = options.height = 200;
  options.background = {0, 0, 1};
  SceneMesh item;
  item.mesh = view_of(mesh);
  item.shading = 0.0;
  item.vertex_colors = {200, 10, 30, 200, 10, 30, 200, 10, 30, 200, 10, 30};
  const PngImage one = decode_png(draw_png({item}, options));
  CHECK(one.width == 200);
  CHECK(pixel(one, 100, 100) == Pixel{200, 10, 30});
  CHECK(pixel(one, 1, 1) == Pixel{0, 0, 255});
  // From the corner (-1, -1) below on the left, red, to the other three, black.
  item.vertex_colors = {240, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const PngImage mixed = decode_png(draw_png({item}, options));
  CHECK(pixel(mixed, 100, 140)[0] == Approx(120).margin(2));  // 240 (1 - x) / 2 at x = 0
  item.triangle_colors = {9, 8, 7, 70, 80, 90};
  const PngImage two = decode_png(draw_png({item}, options));
  CHECK(pixel(two, 150, 120) == Pixel{9, 8, 7});   // below the diagonal
  CHECK(pixel(two, 50, 80) == Pixel{70, 80, 90});  // above
  // Light and shade leave no pixel as it was given, but its hue.
  item.shading = 1.0;
  CHECK(pixel(decode_png(draw_png({item}, options)), 150, 120) != Pixel{9, 8, 7});
}

TEST_CASE("edges of triangles are drawn on request", "[picture][panels]") {
  const Mesh mesh = square();
  PictureOptions options;
  options.width = options.height = 200;
  SceneMesh item;
  item.mesh = view_of(mesh);
  item.shading = 0.0;
  item.color = {1, 0, 0};
  CHECK(pixel(decode_png(draw_png({item}, options)), 100, 100) == Pixel{255, 0, 0});
  item.edges = true;
  const PngImage lines = decode_png(draw_png({item}, options));
  int darkest = 255;
  for (int x = 97; x <= 103; ++x) darkest = std::min(darkest, pixel(lines, x, 100)[0]);
  CHECK(darkest < 150);
  CHECK(pixel(lines, 150, 100) == Pixel{255, 0, 0});
}

TEST_CASE("panels stand side by side, with captions and bars", "[picture][panels]") {
  const Mesh mesh = square();
  Panel first, second, third;
  first.meshes.resize(1);
  first.meshes[0].mesh = view_of(mesh);
  first.meshes[0].shading = 0.0;
  first.meshes[0].color = {0, 1, 0};
  first.caption = "a square";
  second.image = {2, 2, {10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120}};
  second.scale = ColorScale{ColorMap::viridis, 0, 90, false, "angle change (degrees)"};
  third.image = second.image;
  third.smooth_image = true;
  PictureOptions options;
  options.width = 900;
  options.height = 400;
  const PngImage page = decode_png(draw_panels({first, second, third}, options));
  REQUIRE(page.width == 900);
  REQUIRE(page.height == 400);
  CHECK(pixel(page, 148, 182) == Pixel{0, 255, 0});
  // The image in squares, and mixed.
  CHECK(pixel(page, 450 - 40, 182 - 40) == Pixel{10, 20, 30});
  CHECK(pixel(page, 450 + 40, 182 - 40) == Pixel{40, 50, 60});
  CHECK(pixel(page, 450 - 40, 182 + 80) == Pixel{70, 80, 90});
  CHECK(pixel(page, 752, 182)[0] == Approx(55).margin(3));
  // Below the second panel alone: the colors of its bar from left to right.
  std::set<Pixel> colors[3];
  for (int y = 350; y < 400; ++y) {
    for (int x = 0; x < 900; ++x) colors[x / 300].insert(pixel(page, x, y));
  }
  CHECK(colors[0] == std::set<Pixel>{{255, 255, 255}});
  CHECK(colors[2] == std::set<Pixel>{{255, 255, 255}});
  CHECK(colors[1].count({0, 0, 0}) == 1);  // frame and text
  bool viridis = false;
  for (const Pixel& found : colors[1]) {
    viridis = viridis || (std::abs(found[0] - 0x21) < 4 && std::abs(found[1] - 0x91) < 4 &&
                          std::abs(found[2] - 0x8c) < 4);
  }
  CHECK(viridis);
  // The caption is there: dark pixels above the first panel, none above the others.
  int dark[2] = {0, 0};
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 600; ++x) dark[x / 300] += pixel(page, x, y)[0] < 128 ? 1 : 0;
  }
  CHECK(dark[0] > 20);
  CHECK(dark[1] == 0);
}

TEST_CASE("panels in rows", "[picture][panels]") {
  std::vector<Panel> panels(3);
  for (std::size_t i = 0; i < 3; ++i) {
    panels[i].image = {1, 1, {static_cast<std::uint8_t>(50 * i), 0, 0}};
  }
  PictureOptions options;
  options.width = options.height = 200;
  options.background = {0, 0, 0.2};
  const PngImage page = decode_png(draw_panels(panels, options, 2));
  CHECK(pixel(page, 50, 50) == Pixel{0, 0, 0});
  CHECK(pixel(page, 150, 50) == Pixel{50, 0, 0});
  CHECK(pixel(page, 50, 150) == Pixel{100, 0, 0});
  CHECK(pixel(page, 150, 150) == Pixel{0, 0, 51});
}

TEST_CASE("bodies have one size, whatever their rows have besides", "[picture][panels]") {
  std::vector<Panel> panels(2);
  panels[0].image = panels[1].image = {1, 1, {0, 0, 255}};
  panels[1].caption = "with a bar";
  panels[1].scale = ColorScale{ColorMap::grey, 0, 1, false, "share"};
  PictureOptions options;
  options.width = 200;
  options.height = 400;
  const PngImage page = decode_png(draw_panels(panels, options, 1));
  std::vector<int> heights;  // of the runs of blue from top to bottom
  for (int y = 0; y < 400; ++y) {
    const bool blue = pixel(page, 100, y) == Pixel{0, 0, 255};
    if (blue && (y == 0 || pixel(page, 100, y - 1) != Pixel{0, 0, 255})) heights.push_back(0);
    if (blue) ++heights.back();
  }
  REQUIRE(heights.size() == 2);
  CHECK(heights[0] == heights[1]);
  CHECK(heights[0] > 140);  // the first row keeps no room for a bar
}

TEST_CASE("images in other sizes", "[picture][raster]") {
  Raster image = make_raster(6, 4, {0, 0, 0});
  fill(image, 0, 0, 3, 4, {1, 1, 1});
  const Raster same = resampled(image, 6, 4);
  CHECK(same.rgb == image.rgb);
  const Raster half = resampled(image, 2, 2);  // mean brightness is kept
  double sum = 0.0;
  for (const std::uint8_t byte : half.rgb) sum += byte;
  CHECK(sum / 12 == Approx(127.5).margin(1.0));
  CHECK(pixel(resized(image, 60, 40), 29, 39) == Pixel{255, 255, 255});
  CHECK(pixel(resized(image, 60, 40), 30, 0) == Pixel{0, 0, 0});
  // What lies outside is left out.
  Raster page = make_raster(5, 5, {1, 0, 0});
  paste(page, image, -3, 3);
  CHECK(pixel(page, 0, 3) == Pixel{0, 0, 0});
  CHECK(pixel(page, 2, 4) == Pixel{0, 0, 0});
  CHECK(pixel(page, 3, 4) == Pixel{255, 0, 0});
  fill(page, 4, -2, 9, 3, {0, 1, 0});
  CHECK(pixel(page, 4, 0) == Pixel{0, 255, 0});
  CHECK(pixel(page, 4, 1) == Pixel{255, 0, 0});
}

TEST_CASE("pictures that cannot be drawn", "[picture][panels]") {
  using Catch::Matchers::Contains;
  const Mesh mesh = square();
  SceneMesh item;
  item.mesh = view_of(mesh);
  item.vertex_colors = {1, 2, 3};
  CHECK_THROWS_WITH(draw_png({item}, {}),
                    Contains("colors of the vertices are 3 bytes, expected 3 for each of 4"));
  item.vertex_colors.clear();
  item.triangle_colors = {1, 2, 3};
  CHECK_THROWS_WITH(draw_png({item}, {}),
                    Contains("colors of the triangles are 3 bytes, expected 3 for each of 2"));
  CHECK_THROWS_WITH(draw_panels({}, {}), Contains("there is no panel to draw"));
  CHECK_THROWS_WITH(draw_panels({Panel{}}, {}), Contains("neither meshes nor an image"));
  Panel panel;
  panel.image = make_raster(2, 2, {0, 0, 0});
  PictureOptions small;
  small.width = small.height = 60;
  CHECK_THROWS_WITH(draw_panels({panel, panel}, small), Contains("60 × 60 pixels is too small"));
}

}  // namespace
