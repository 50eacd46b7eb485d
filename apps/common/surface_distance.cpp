#include "surface_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>
#include <Eigen/Geometry>

#include "vtk_mesh.hpp"

namespace shape3d::apps {
namespace {

struct Corners {
  Eigen::RowVector3d a, b, c;

  [[nodiscard]] double area() const { return 0.5 * (b - a).cross(c - a).norm(); }
  [[nodiscard]] double longest() const {
    return std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  }
};

Corners corners_of(const Mesh& mesh, Eigen::Index t) {
  return {mesh.V.row(mesh.F(t, 0)), mesh.V.row(mesh.F(t, 1)), mesh.V.row(mesh.F(t, 2))};
}

// The triangles that have an area: on others VTK finds no nearest point, and their points are those
// of their neighbours.
Mesh with_areas(const Mesh& mesh, const char* name) {
  Mesh result;
  result.V = mesh.V;
  result.F.resize(mesh.F.rows(), 3);
  Eigen::Index kept = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Corners corners = corners_of(mesh, t);
    const double side = corners.longest();
    if (corners.area() > 1e-14 * side * side) result.F.row(kept++) = mesh.F.row(t);
  }
  if (kept == 0) {
    throw std::invalid_argument(std::string(name) + " has no triangle with an area");
  }
  result.F.conservativeResize(kept, 3);
  return result;
}

// Distances to a surface.
class Target {
 public:
  explicit Target(const Mesh& mesh) : data_(borrow_polydata(view_of(mesh))) {
    locator_->SetDataSet(data_);
    locator_->BuildLocator();
  }
  [[nodiscard]] double squared(const Eigen::RowVector3d& point, vtkGenericCell* cell) const {
    double nearest[3];
    vtkIdType id = -1;
    int part = 0;
    double distance = std::numeric_limits<double>::infinity();
    const double p[3] = {point[0], point[1], point[2]};
    locator_->FindClosestPoint(p, nearest, cell, id, part, distance);
    return distance;
  }

 private:
  vtkSmartPointer<vtkPolyData> data_;
  vtkNew<vtkStaticCellLocator> locator_;
};

// What one block of triangles gives.
struct Part {
  double integral = 0.0, largest = 0.0;
  std::int64_t samples = 0;
};

Part of_triangle(const Corners& corners, double side, const Target& target, vtkGenericCell* cell) {
  const auto n = static_cast<int>(std::max(1.0, std::ceil(corners.longest() / side)));
  const Eigen::RowVector3d u = (corners.b - corners.a) / n, v = (corners.c - corners.a) / n;
  const double small_area = corners.area() / n / n;
  Part part;
  const auto look = [&](double i, double j) {
    ++part.samples;
    const double squared = target.squared(corners.a + i * u + j * v, cell);
    part.largest = std::max(part.largest, squared);
    return squared;
  };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) {
      look(i, j);
      if (i + j < n) part.integral += small_area * look(i + 1.0 / 3, j + 1.0 / 3);
      if (i + j < n - 1) part.integral += small_area * look(i + 2.0 / 3, j + 2.0 / 3);
    }
  }
  return part;
}

}  // namespace

SurfaceDistance surface_distance(const Mesh& A, const Mesh& B, std::int64_t samples, int threads) {
  if (samples < 1 || samples > 100000000) {
    throw std::invalid_argument("samples is " + std::to_string(samples) +
                                ", expected 1 … 100000000");
  }
  const Mesh from = with_areas(A, "A"), to = with_areas(B, "B");
  const Target target(to);
  double area = 0.0;
  for (Eigen::Index t = 0; t < from.F.rows(); ++t) area += corners_of(from, t).area();
  // Small triangles of about equal sides s have the area √3/4 s².
  const double side = std::sqrt(4.0 / std::sqrt(3.0) * area / static_cast<double>(samples));

  std::vector<char> used(static_cast<std::size_t>(A.V.rows()), 0);
  for (Eigen::Index i = 0; i < A.F.size(); ++i) {
    used[static_cast<std::size_t>(A.F.data()[i])] = 1;
  }
  const auto processors = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t workers = threads > 0 ? static_cast<std::size_t>(threads) : processors;
  std::vector<Part> parts(static_cast<std::size_t>(from.F.rows()));
  std::vector<double> squares(used.size(), 0.0);
  const auto work = [&](std::size_t first) {
    vtkNew<vtkGenericCell> cell;
    for (std::size_t t = first; t < parts.size(); t += workers) {
      parts[t] = of_triangle(corners_of(from, static_cast<Eigen::Index>(t)), side, target, cell);
    }
    for (std::size_t v = first; v < used.size(); v += workers) {
      if (used[v] != 0) squares[v] = target.squared(A.V.row(static_cast<Eigen::Index>(v)), cell);
    }
  };
  std::vector<std::thread> pool;
  for (std::size_t i = 1; i < workers; ++i) pool.emplace_back(work, i);
  work(0);
  for (std::thread& thread : pool) thread.join();

  SurfaceDistance result;
  double integral = 0.0, largest = 0.0;
  for (const Part& part : parts) {
    integral += part.integral;
    largest = std::max(largest, part.largest);
    result.samples += part.samples;
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) continue;
    ++result.vertices;
    result.sum_of_squares += squares[v];
    largest = std::max(largest, squares[v]);
  }
  result.mean_square = integral / area;
  result.largest = std::sqrt(largest);
  result.spacing = side / std::sqrt(3.0);
  return result;
}

}  // namespace shape3d::apps
