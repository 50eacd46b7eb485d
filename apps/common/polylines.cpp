#include "polylines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <Eigen/LU>

#include "vtk_mesh.hpp"

namespace shape3d::apps {
namespace {

// Walks along unused edges.
class EdgeJoiner {
 public:
  explicit EdgeJoiner(const zmc::Contour& contour)
      : edges_(contour.E), start_(contour.V.rows() + 1, 0) {
    for (Eigen::Index e = 0; e < edges_.rows(); ++e) {
      for (int side = 0; side < 2; ++side) ++start_[index(edges_(e, side)) + 1];
    }
    for (std::size_t v = 1; v < start_.size(); ++v) start_[v] += start_[v - 1];
    at_vertex_.resize(start_.back());
    std::vector<std::size_t> fill(start_.begin(), start_.end());
    for (Eigen::Index e = 0; e < edges_.rows(); ++e) {
      for (int side = 0; side < 2; ++side) at_vertex_[fill[index(edges_(e, side))]++] = e;
    }
    used_.assign(static_cast<std::size_t>(edges_.rows()), false);
    position_on_walk_.assign(start_.size() - 1, -1);
  }

  std::vector<Polyline> join() {
    // From the ends first: a vertex of odd degree begins or ends an open line. Starting where an
    // edge leaves keeps the direction of the edges.
    for (const bool leaving : {true, false}) {
      for (std::size_t v = 0; v + 1 < start_.size(); ++v) {
        while (unused_degree(v) % 2 == 1) {
          if (leaving && next_edge(static_cast<std::int32_t>(v), true) < 0) break;
          walk(static_cast<std::int32_t>(v));
        }
      }
    }
    for (Eigen::Index e = 0; e < edges_.rows(); ++e) {
      if (!used_[index(e)]) walk(edges_(e, 0));
    }
    return std::move(lines_);
  }

 private:
  template <class Integer>
  static std::size_t index(Integer i) {
    return static_cast<std::size_t>(i);
  }

  [[nodiscard]] std::size_t unused_degree(std::size_t v) const {
    std::size_t degree = 0;
    for (std::size_t i = start_[v]; i < start_[v + 1]; ++i)
      degree += used_[index(at_vertex_[i])] ? 0 : 1;
    return degree;
  }

  // An unused edge at v, if possible one that leaves it; −1 for none.
  [[nodiscard]] Eigen::Index next_edge(std::int32_t v, bool leaving_only = false) const {
    Eigen::Index other = -1;
    for (std::size_t i = start_[index(v)]; i < start_[index(v) + 1]; ++i) {
      const Eigen::Index e = at_vertex_[i];
      if (used_[index(e)]) continue;
      if (edges_(e, 0) == v) return e;
      if (other < 0) other = e;
    }
    return leaving_only ? -1 : other;
  }

  // Follows edges from v until none is left; each return to a vertex of the walk cuts off a closed
  // line.
  void walk(std::int32_t v) {
    std::vector<std::int32_t> path{v};
    position_on_walk_[index(v)] = 0;
    for (Eigen::Index e = next_edge(v); e >= 0; e = next_edge(v)) {
      used_[index(e)] = true;
      v = edges_(e, 0) == v ? edges_(e, 1) : edges_(e, 0);
      const std::int64_t seen = position_on_walk_[index(v)];
      if (seen < 0) {
        position_on_walk_[index(v)] = static_cast<std::int64_t>(path.size());
        path.push_back(v);
        continue;
      }
      lines_.push_back({{path.begin() + seen, path.end()}, true});
      for (std::size_t i = index(seen) + 1; i < path.size(); ++i)
        position_on_walk_[index(path[i])] = -1;
      path.resize(index(seen) + 1);
    }
    for (const std::int32_t u : path) position_on_walk_[index(u)] = -1;
    if (path.size() > 1) lines_.push_back({std::move(path), false});
  }

  const Eigen::Matrix<std::int32_t, Eigen::Dynamic, 2, Eigen::RowMajor>& edges_;
  std::vector<std::size_t> start_;  // of the edges at a vertex in at_vertex_
  std::vector<Eigen::Index> at_vertex_;
  std::vector<bool> used_;
  std::vector<std::int64_t> position_on_walk_;
  std::vector<Polyline> lines_;
};

std::string decimals(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

}  // namespace

std::vector<Polyline> join_edges(const zmc::Contour& contour) { return EdgeJoiner(contour).join(); }

SlicePlane::SlicePlane(const zmc::VolumeView& volume, int axis)
    : to_lattice_((volume.direction * volume.spacing.asDiagonal()).inverse()),
      origin_(volume.origin),
      axis_(axis) {
  axes_ = axis == 0   ? std::array<int, 2>{1, 2}
          : axis == 1 ? std::array<int, 2>{0, 2}
                      : std::array<int, 2>{0, 1};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto column = volume.direction.col(axes_[i]);
    Eigen::Index dominant = 0;
    column.cwiseAbs().maxCoeff(&dominant);
    const bool along_world = column[dominant] > 0.0;
    // Left and posterior run right and down; superior runs up.
    flipped_[i] = i == 1 && dominant == 2 ? along_world : !along_world;
    spacing_[i] = volume.spacing[axes_[i]];
    size_[i] =
        static_cast<double>(volume.dims[static_cast<std::size_t>(axes_[i])] - 1) * spacing_[i];
  }
}

std::array<double, 2> SlicePlane::project(const Eigen::Vector3d& world) const {
  const Eigen::Vector3d lattice = to_lattice_ * (world - origin_);
  std::array<double, 2> p{};
  for (std::size_t i = 0; i < 2; ++i) {
    p[i] = lattice[axes_[i]] * spacing_[i];
    if (flipped_[i]) p[i] = size_[i] - p[i];
  }
  return p;
}

Eigen::Vector3d SlicePlane::lattice(const std::array<double, 2>& place, std::int64_t slice) const {
  Eigen::Vector3d p;
  p[axis_] = static_cast<double>(slice);
  for (std::size_t i = 0; i < 2; ++i)
    p[axes_[i]] = (flipped_[i] ? size_[i] - place[i] : place[i]) / spacing_[i];
  return p;
}

void write_svg(OutputFile& file, const zmc::Contour& contour, const std::vector<Polyline>& lines,
               const SlicePlane& plane, const std::string& title) {
  const auto [width, height] = plane.size();
  const double stroke = std::max(width, height) / 800.0;
  file.write(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
      "width=\"" +
      decimals(width) + "mm\" height=\"" + decimals(height) + "mm\" viewBox=\"0 0 " +
      decimals(width) + " " + decimals(height) + "\">\n<title>" + escaped(title) + "</title>\n");
  file.write("<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n");
  file.write(
      "<path fill=\"#e9dfcb\" fill-rule=\"evenodd\" stroke=\"#3b3a36\" stroke-linejoin=\"round\" "
      "stroke-width=\"" +
      decimals(stroke) + "\" d=\"");
  for (const bool closed : {true, false}) {
    if (!closed) {
      file.write(
          "\"/>\n<path fill=\"none\" stroke=\"#3b3a36\" stroke-linejoin=\"round\" stroke-width=\"" +
          decimals(stroke) + "\" d=\"");
    }
    for (const Polyline& line : lines) {
      if (line.closed != closed) continue;
      for (std::size_t i = 0; i < line.vertices.size(); ++i) {
        const auto [x, y] = plane.project(contour.V.row(line.vertices[i]).transpose());
        file.write(i == 0 ? "M" : i == 1 ? "L" : " ");
        file.write(decimals(x));
        file.write_char(' ');
        file.write(decimals(y));
      }
      file.write(closed ? "Z\n" : "\n");
    }
  }
  file.write("\"/>\n</svg>\n");
}

void write_contour_vtp(OutputFile& file, const zmc::Contour& contour,
                       const std::vector<Polyline>& lines, const std::string& space) {
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetNumberOfTuples(contour.V.rows());
  std::copy(contour.V.data(), contour.V.data() + contour.V.size(), coordinates->GetPointer(0));
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  vtkNew<vtkCellArray> cells;
  for (const Polyline& line : lines) {
    cells->InsertNextCell(static_cast<int>(line.vertices.size()) + (line.closed ? 1 : 0));
    for (const std::int32_t v : line.vertices) cells->InsertCellPoint(v);
    if (line.closed) cells->InsertCellPoint(line.vertices.front());
  }
  vtkNew<vtkStringArray> label;
  label->SetName("SPACE");
  label->InsertNextValue(space);
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  data->GetFieldData()->AddArray(label);
  write_polydata(file, data);
}

}  // namespace shape3d::apps
