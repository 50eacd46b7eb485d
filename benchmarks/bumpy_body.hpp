#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "shape3d/descriptors/surface.hpp"

namespace shape3d::bench {

struct Body {
  descriptors::Points V;
  descriptors::Triangles F;
};

/// A bumpy closed body on a grid of latitude and longitude, 2 n (n − 1) · 2 triangles for n rows.
inline Body bumpy(int rows) {
  const int columns = 2 * rows;
  Body body;
  body.V.resize(static_cast<Eigen::Index>(rows - 1) * columns + 2, 3);
  const auto place = [](double theta, double phi) {
    const double x = std::sin(theta) * std::cos(phi), y = std::sin(theta) * std::sin(phi),
                 z = std::cos(theta);
    const double r = 1 + 0.3 * x + 0.5 * x * y * z + 0.3 * (x * x - y * y) + 0.2 * std::sin(5 * z) +
                     0.15 * std::cos(4 * phi) * std::sin(theta);
    return Eigen::RowVector3d(r * x, 0.7 * r * y, 1.4 * r * z);
  };
  const double pi = std::acos(-1.0);
  for (int i = 1; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      body.V.row(static_cast<Eigen::Index>(i - 1) * columns + j) =
          place(pi * i / rows, 2 * pi * j / columns);
    }
  }
  const auto north = static_cast<std::int32_t>(body.V.rows() - 2), south = north + 1;
  body.V.row(north) = place(0, 0);
  body.V.row(south) = place(pi, 0);
  std::vector<std::int32_t> ids;
  const auto vertex = [&](int i, int j) {
    if (i == 0) return north;
    if (i == rows) return south;
    return static_cast<std::int32_t>((i - 1) * columns + j % columns);
  };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      if (i + 1 < rows)
        ids.insert(ids.end(), {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      if (i > 0) ids.insert(ids.end(), {vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  body.F = Eigen::Map<const descriptors::Triangles>(ids.data(),
                                                    static_cast<Eigen::Index>(ids.size() / 3), 3);
  return body;
}

/// Rows of bumpy() for a number of triangles, 4 rows² − 4 rows.
inline int rows_for(double triangles) {
  return static_cast<int>(std::lround(std::sqrt(triangles / 4))) + 1;
}

}  // namespace shape3d::bench
