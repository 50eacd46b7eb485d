// The filter beside vtkFlyingEdges3D.

#include <algorithm>
#include <map>

#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <catch2/catch.hpp>

#include "images.hpp"

namespace {
using namespace shape3d::zmc_vtk::test;

/// Finds vertices of a mesh by their places.
class Places {
 public:
  explicit Places(vtkPolyData* mesh) : mesh_(mesh) {
    for (vtkIdType v = 0; v < mesh->GetNumberOfPoints(); ++v)
      ids_.emplace(box(point(mesh, v), 0), v);
  }

  /// The nearest vertex, or −1 if none is within 2^-12.
  [[nodiscard]] vtkIdType nearest(const Eigen::Vector3d& place) const {
    vtkIdType best = -1;
    double distance = kSide;
    for (int n = 0; n < 27; ++n) {
      const auto [first, last] = ids_.equal_range(box(place, n));
      for (auto at = first; at != last; ++at) {
        const double d = (point(mesh_, at->second) - place).norm();
        if (d < distance) best = at->second, distance = d;
      }
    }
    return best;
  }

 private:
  using Box = std::array<long, 3>;
  static constexpr double kSide = 1.0 / 4096;
  /// The box of a place (n = 0) or one of the 26 around it.
  static Box box(const Eigen::Vector3d& place, int n) {
    Box b{};
    for (int d = 0; d < 3; ++d, n /= 3) b[d] = std::lround(place[d] / kSide) + (n % 3 + 1) % 3 - 1;
    return b;
  }

  vtkPolyData* mesh_;
  std::multimap<Box, vtkIdType> ids_;
};

/// Smooth, without ambiguous faces or zero samples at the value 0.37.
double smooth(int i, int j, int k) {
  return std::sin(0.31 * i + 0.1) + std::cos(0.27 * j) * std::sin(0.23 * k + 0.7);
}

struct Pair {
  vtkNew<vtkZeroCrossingMarchingCubes> ours;
  vtkNew<vtkFlyingEdges3D> theirs;

  Pair(vtkImageData* image, double value) {
    const auto set_up = [&](auto& filter) {
      filter->SetInputData(image);
      filter->SetValue(0, value);
      filter->ComputeGradientsOn();
      filter->InterpolateAttributesOn();
      filter->Update();
    };
    set_up(ours);
    set_up(theirs);
  }
};

TEST_CASE("defaults are those of vtkFlyingEdges3D", "[zmc_vtk]") {
  vtkNew<vtkZeroCrossingMarchingCubes> ours;
  vtkNew<vtkFlyingEdges3D> theirs;
  CHECK(ours->GetNumberOfContours() == theirs->GetNumberOfContours());
  CHECK(ours->GetValue(0) == theirs->GetValue(0));
  CHECK(ours->GetComputeNormals() == theirs->GetComputeNormals());
  CHECK(ours->GetComputeGradients() == theirs->GetComputeGradients());
  CHECK(ours->GetComputeScalars() == theirs->GetComputeScalars());
  CHECK(ours->GetInterpolateAttributes() == theirs->GetInterpolateAttributes());
  CHECK(ours->GetArrayComponent() == theirs->GetArrayComponent());
}

TEST_CASE("a sphere is oriented as by vtkFlyingEdges3D, triangle by triangle", "[zmc_vtk]") {
  // Dense inside or dense outside; every triangle of a convex body tells its side by the centre.
  const double sign = GENERATE(1.0, -1.0);
  const Eigen::Vector3d centre(12.3, -3.1, 20.2);
  const Field field = distance_from(centre[0], centre[1], centre[2]);
  const auto image = make_image({2, 23, -13, 8, 9, 31}, VTK_DOUBLE,
                                [&](int i, int j, int k) { return sign * field(i, j, k); });
  Pair pair(image, sign * 743.21);
  for (vtkPolyData* mesh : {pair.ours->GetOutput(), pair.theirs->GetOutput()}) {
    INFO((mesh == pair.ours->GetOutput() ? "zero-crossing" : "flying edges"));
    REQUIRE(mesh->GetNumberOfCells() > 1000);
    vtkDataArray* normals = mesh->GetPointData()->GetNormals();
    int outward = 0, inward = 0, normals_along = 0;
    for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell) {
      const auto corners = triangle(mesh, cell);
      const Eigen::Vector3d area = area_vector(mesh, cell);
      const double side = area.dot(point(mesh, corners[0]) - centre);
      if (area.norm() < 1e-4) continue;  // slivers: single precision decides their side
      (side > 0.0 ? outward : inward)++;
      for (const vtkIdType corner : corners) {
        const double along = area.dot(Eigen::Vector3d(normals->GetTuple3(corner)));
        if (along > 0.0) ++normals_along;
      }
    }
    CHECK(outward == (sign > 0 ? 0 : outward));
    CHECK(inward == (sign > 0 ? inward : 0));
    CHECK(outward + inward > 1000);
    CHECK(normals_along == 3 * (outward + inward));
  }
}

TEST_CASE("a smooth field gives the vertices and attributes of vtkFlyingEdges3D", "[zmc_vtk]") {
  const auto image = make_image({0, 24, 0, 22, 0, 20}, VTK_DOUBLE, smooth);
  image->SetSpacing(1.5, 0.75, 2.0);
  vtkNew<vtkFloatArray> other;
  other->SetName("other");
  other->SetNumberOfComponents(2);
  other->SetNumberOfTuples(image->GetNumberOfPoints());
  for (vtkIdType id = 0; id < image->GetNumberOfPoints(); ++id)
    other->SetTuple2(id, std::sin(0.01 * static_cast<double>(id)),
                     std::cos(0.7 * static_cast<double>(id)));
  image->GetPointData()->AddArray(other);
  Pair pair(image, 0.37);
  vtkPolyData *ours = pair.ours->GetOutput(), *theirs = pair.theirs->GetOutput();
  REQUIRE(ours->GetNumberOfPoints() > 1000);
  CHECK(ours->GetNumberOfPoints() == theirs->GetNumberOfPoints());
  CHECK(ours->GetNumberOfCells() == theirs->GetNumberOfCells());

  const Places places(theirs);
  double worst_place = 0.0, worst_normal = 0.0, worst_gradient = 0.0, worst_other = 0.0;
  int apart = 0;
  const auto tuple = [](vtkPolyData* mesh, const char* name, vtkIdType id) {
    return Eigen::Vector3d(mesh->GetPointData()->GetArray(name)->GetTuple3(id));
  };
  for (vtkIdType v = 0; v < ours->GetNumberOfPoints(); ++v) {
    const vtkIdType w = places.nearest(point(ours, v));
    if (w < 0) {
      ++apart;
      continue;
    }
    worst_place = std::max(worst_place, (point(ours, v) - point(theirs, w)).norm());
    worst_normal =
        std::max(worst_normal, (tuple(ours, "Normals", v) - tuple(theirs, "Normals", w)).norm());
    worst_gradient = std::max(worst_gradient,
                              (tuple(ours, "Gradients", v) - tuple(theirs, "Gradients", w)).norm());
    for (int c = 0; c < 2; ++c) {
      worst_other = std::max(
          worst_other, std::abs(ours->GetPointData()->GetArray("other")->GetComponent(v, c) -
                                theirs->GetPointData()->GetArray("other")->GetComponent(w, c)));
    }
  }
  CHECK(apart == 0);
  CHECK(worst_place < 1e-5);
  CHECK(worst_normal < 1e-5);
  CHECK(worst_gradient < 1e-5);
  CHECK(worst_other < 1e-5);

  // Names and roles of arrays.
  for (const char* name : {"Normals", "Gradients", "other", "samples"}) {
    INFO(name);
    REQUIRE(theirs->GetPointData()->HasArray(name));
    REQUIRE(ours->GetPointData()->HasArray(name));
    CHECK(ours->GetPointData()->GetArray(name)->GetDataType() ==
          theirs->GetPointData()->GetArray(name)->GetDataType());
  }
  CHECK(ours->GetPointData()->GetNumberOfArrays() == theirs->GetPointData()->GetNumberOfArrays());
  CHECK(ours->GetPointData()->GetScalars() == ours->GetPointData()->GetArray("samples"));
  CHECK(ours->GetPointData()->GetNormals() == ours->GetPointData()->GetArray("Normals"));
  CHECK(ours->GetPointData()->GetVectors() == ours->GetPointData()->GetArray("Gradients"));
  CHECK(ours->GetPointData()->GetScalars()->GetTuple1(7) == 0.37);
}

TEST_CASE("under a rotated direction matrix the surface is that of vtkFlyingEdges3D", "[zmc_vtk]") {
  const auto image = make_image({3, 27, -4, 18, 5, 25}, VTK_DOUBLE, smooth);
  const double c = std::cos(0.4), s = std::sin(0.4);
  image->SetDirectionMatrix(c, -s, 0, s, c, 0, 0, 0, 1);
  image->SetOrigin(7.0, -2.0, 1.5);
  image->SetSpacing(0.8, 0.8, 0.8);
  Pair pair(image, 0.37);
  vtkPolyData *ours = pair.ours->GetOutput(), *theirs = pair.theirs->GetOutput();
  REQUIRE(ours->GetNumberOfPoints() > 1000);
  REQUIRE(ours->GetNumberOfPoints() == theirs->GetNumberOfPoints());
  const Places places(theirs);
  int apart = 0;
  double worst = 0.0;
  for (vtkIdType v = 0; v < ours->GetNumberOfPoints(); ++v) {
    const vtkIdType w = places.nearest(point(ours, v));
    if (w < 0) {
      ++apart;
      continue;
    }
    const Eigen::Vector3d a(ours->GetPointData()->GetNormals()->GetTuple3(v)),
        b(theirs->GetPointData()->GetNormals()->GetTuple3(w));
    worst = std::max(worst, (a - b).norm());
  }
  CHECK(apart == 0);
  CHECK(worst < 1e-5);
}
}  // namespace
