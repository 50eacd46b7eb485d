#pragma once

#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/picture.hpp"

namespace shape3d::apps {

/// A drawing of flat and solid things side by side, seen along the z axis without perspective.
///
/// Positions are in pixels: x from the left, y from the bottom, z towards the eye.
class Page {
 public:
  enum class Align { left, centre };

  Page(int width, int height) : width_(width), height_(height) {}
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// A triangle with a color for each side: `front` is where the corners run counter-clockwise.
  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Color& front, const Color& back, double opacity = 1.0);
  void rod(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius, const Color& color);
  /// A rod in pieces, each about as long as the gap behind it.
  void broken_rod(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
                  const Color& color);
  /// A ball with a dark outline.
  void ball(const Eigen::Vector3d& centre, double radius, const Color& color);
  /// One line; (x, y) is its left end or its middle, and its foot.
  void text(double x, double y, double size, const std::string& line, Align align = Align::centre,
            bool bold = false);

  /// Draws in a child process on a private Xvfb.
  /// @return PNG bytes.
  /// @throws PictureError  Xvfb does not start, or drawing failed.
  [[nodiscard]] std::string png() const;

 private:
  struct Corners {
    Eigen::Vector3d a, b, c;
  };
  struct Segment {
    Eigen::Vector3d a, b;
  };
  struct Line {
    double x, y, size;
    std::string text;
    Align align;
    bool bold;
  };

  [[nodiscard]] std::string draw() const;

  int width_, height_;
  std::map<std::tuple<Color, Color, double>, std::vector<Corners>> triangles_;
  std::map<std::pair<double, Color>, std::vector<Segment>> rods_;
  std::map<std::pair<double, Color>, std::vector<Eigen::Vector3d>> balls_;
  std::vector<Line> lines_;
};

}  // namespace shape3d::apps
