#include "som_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/color_map.hpp"

namespace shape3d::apps {
namespace {

using learning::SomLattice;

constexpr int kMargin = 30, kHead = 50, kFoot = 90;
constexpr Color kWhite{1.0, 1.0, 1.0}, kInk{0.12, 0.12, 0.12}, kFaint{0.78, 0.78, 0.78};

// Cells round their middles: hexagons or squares whose neighbours' middles are `pitch` apart.
class Cells {
 public:
  Cells(const Eigen::VectorXd& x, const Eigen::VectorXd& y, SomLattice lattice, double pitch)
      : x_(x), y_(y), hexagonal_(lattice == SomLattice::hexagonal), pitch_(pitch) {}

  // The cell of a place; -1 outside all.
  [[nodiscard]] int at(double x, double y) const {
    Eigen::Index best = 0;
    ((x_.array() - x).square() + (y_.array() - y).square()).minCoeff(&best);
    const double dx = std::abs(x - x_(best)) / pitch_;
    const double dy = std::abs(y - y_(best)) / pitch_;
    const bool inside =
        hexagonal_ ? dx <= 0.5 && 0.5 * dx + std::sqrt(0.75) * dy <= 0.5 : dx <= 0.5 && dy <= 0.5;
    return inside ? static_cast<int>(best) : -1;
  }

 private:
  Eigen::VectorXd x_, y_;
  bool hexagonal_;
  double pitch_;
};

// A part of the picture in which maps are drawn; `scale` pixels are the distance of two units.
struct Frame {
  int left = 0, top = 0, width = 0, height = 0;
  double x0 = 0.0, y0 = 0.0, scale = 1.0;

  [[nodiscard]] double x(double column) const { return x0 + (column - left) / scale; }
  [[nodiscard]] double y(double row) const { return y0 + (row - top) / scale; }
  [[nodiscard]] int column(double place) const {
    return left + static_cast<int>(std::lround((place - x0) * scale));
  }
  [[nodiscard]] int row(double place) const {
    return top + static_cast<int>(std::lround((place - y0) * scale));
  }
};

void set_pixel(Raster& raster, int x, int y, const Color& color) {
  if (x < 0 || y < 0 || x >= raster.width || y >= raster.height) return;
  std::uint8_t* pixel =
      raster.rgb.data() + 3 * (std::size_t(y) * std::size_t(raster.width) + std::size_t(x));
  for (std::size_t c = 0; c < 3; ++c) {
    pixel[c] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(color[c], 0.0, 1.0)));
  }
}

// The cell of each pixel of a frame.
std::vector<int> cell_of_pixels(const Frame& frame, const Cells& cells) {
  std::vector<int> result;
  result.reserve(std::size_t(frame.width) * std::size_t(frame.height));
  for (int j = 0; j < frame.height; ++j) {
    for (int i = 0; i < frame.width; ++i) {
      result.push_back(cells.at(frame.x(frame.left + i + 0.5), frame.y(frame.top + j + 0.5)));
    }
  }
  return result;
}

void draw_cells(Raster& raster, const Frame& frame, const std::vector<int>& cell_of,
                const std::vector<Color>& colors) {
  for (std::size_t p = 0; p < cell_of.size(); ++p) {
    if (cell_of[p] < 0) continue;
    set_pixel(raster, frame.left + static_cast<int>(p) % frame.width,
              frame.top + static_cast<int>(p) / frame.width,
              colors[static_cast<std::size_t>(cell_of[p])]);
  }
}

// Lines where neighbouring pixels belong to different cells; thick and dark where `heavy` says so.
template <class Heavy>
void draw_borders(Raster& raster, const Frame& frame, const std::vector<int>& cell_of,
                  const Heavy& heavy) {
  const auto at = [&](int i, int j) {
    return cell_of[std::size_t(j) * std::size_t(frame.width) + std::size_t(i)];
  };
  for (int pass = 0; pass < 2; ++pass) {
    for (int j = 0; j + 1 < frame.height; ++j) {
      for (int i = 0; i + 1 < frame.width; ++i) {
        for (const int other : {at(i + 1, j), at(i, j + 1)}) {
          if (other == at(i, j)) continue;
          const bool thick = heavy(at(i, j), other);
          if (thick != (pass == 1)) continue;
          const int reach = thick ? 2 : 0;
          for (int dy = -reach; dy <= reach; ++dy) {
            for (int dx = -reach; dx <= reach; ++dx) {
              if (dx * dx + dy * dy > 5) continue;
              set_pixel(raster, frame.left + i + dx, frame.top + j + dy, thick ? kInk : kFaint);
            }
          }
        }
      }
    }
  }
}

// The text, cut so that it is not wider than `width`.
std::string fitted(std::string text, int size, int width) {
  if (text_width(text, size) <= width) return text;
  while (!text.empty() && text_width(text + "..", size) > width) text.pop_back();
  return text.empty() ? "" : text + "..";
}

void draw_bar(Raster& raster, const Frame& frame, const ColorScale& scale) {
  const int top = frame.top + frame.height + 16;
  const int height = 16;
  const int width = frame.width;
  for (int i = 0; i < width; ++i) {
    fill(raster, frame.left + i, top, 1, height,
         color_at(scale.map, static_cast<double>(i) / std::max(1, width - 1)));
  }
  for (const Tick& tick : ticks_of(scale, 6)) {
    const int x =
        frame.left + static_cast<int>(std::lround(scale.share_of(tick.value) * (width - 1)));
    fill(raster, x, top + height, 1, 5, kInk);
    draw_text(raster, tick.label, x, top + height + 22, 16, TextAlign::centre, kInk);
  }
  draw_text(raster, scale.title, frame.left + width / 2, top + height + 44, 16, TextAlign::centre,
            kInk);
}

}  // namespace

Raster draw_som(const learning::SomModel& model, const SomPictureOptions& options) {
  const learning::UMatrix u = learning::u_matrix(model.som);
  const Eigen::MatrixX2d R = learning::som_positions(model.som.grid);
  const SomLattice lattice = model.som.grid.lattice;
  const double rise = lattice == SomLattice::hexagonal ? 1.0 / std::sqrt(3.0) : 0.5;

  // Both parts have room for the units; elements between them are smaller and inside, but for those
  // that lead round a toroid.
  Frame frame;
  frame.x0 = -0.55;
  frame.y0 = -rise - 0.05;
  const double wide = std::max(R.col(0).maxCoeff() + 0.55, u.x.maxCoeff() + 0.3) - frame.x0;
  const double tall = std::max(R.col(1).maxCoeff() + rise + 0.05, u.y.maxCoeff() + 0.35) - frame.y0;
  frame.scale = std::min({150.0, (options.height - kHead - kFoot - kMargin) / tall, 1900.0 / wide});
  frame.width = static_cast<int>(std::ceil(wide * frame.scale));
  frame.height = static_cast<int>(std::ceil(tall * frame.scale));
  frame.left = kMargin;
  frame.top = kHead;
  Raster raster = make_raster(3 * kMargin + 2 * frame.width, kHead + frame.height + kFoot, kWhite);

  ColorScale scale;
  scale.map = ColorMap::viridis;
  scale.lower = u.values.minCoeff();
  scale.upper = u.values.maxCoeff();
  scale.title = "distance of neighbouring prototypes";
  std::vector<Color> colors;
  const Eigen::MatrixXd values = u.values;
  for (const double value : values.reshaped()) {
    colors.push_back(color_at(scale.map, scale.share_of(value)));
  }
  const Cells elements(u.x.reshaped(), u.y.reshaped(), lattice, 0.5);
  draw_cells(raster, frame, cell_of_pixels(frame, elements), colors);
  draw_bar(raster, frame, scale);
  draw_text(raster, "U-matrix", frame.left + frame.width / 2, 34, 22, TextAlign::centre, kInk,
            true);
  const int dot = std::max(1, static_cast<int>(0.05 * frame.scale));
  for (Eigen::Index i = 0; i < R.rows(); ++i) {
    // A mark where a unit is, so that both parts can be compared.
    fill(raster, frame.column(R(i, 0)) - dot / 2, frame.row(R(i, 1)) - dot / 2, dot, dot, kWhite);
  }

  frame.left = 2 * kMargin + frame.width;
  const Cells units(R.col(0), R.col(1), lattice, 1.0);
  colors.clear();
  for (const int group : options.groups) colors.push_back(light_color(group));
  const std::vector<int> unit_of = cell_of_pixels(frame, units);
  draw_cells(raster, frame, unit_of, colors);
  draw_borders(raster, frame, unit_of, [&](int a, int b) {
    return a >= 0 && b >= 0 &&
           model.clusters[static_cast<std::size_t>(a)] !=
               model.clusters[static_cast<std::size_t>(b)];
  });
  draw_text(raster, "labels, numbers of models, borders of clusters", frame.left + frame.width / 2,
            34, 22, TextAlign::centre, kInk, true);
  const int size = std::clamp(static_cast<int>(0.17 * frame.scale), 7, 20);
  if (frame.scale >= 36.0) {
    for (Eigen::Index i = 0; i < R.rows(); ++i) {
      const auto unit = static_cast<std::size_t>(i);
      if (model.hits[unit] == 0) continue;
      const int x = frame.column(R(i, 0));
      const int y = frame.row(R(i, 1));
      draw_text(raster, fitted(options.labels[unit], size, static_cast<int>(0.92 * frame.scale)), x,
                y, size, TextAlign::centre, kInk);
      draw_text(raster, std::to_string(model.hits[unit]), x, y + size + 3, size, TextAlign::centre,
                {0.35, 0.35, 0.35});
    }
  }
  return raster;
}

}  // namespace shape3d::apps
