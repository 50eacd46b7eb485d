#include "surface_data.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataNormals.h>
#include <vtkQuadricClustering.h>
#include <vtkTypeInt32Array.h>
#include <Eigen/Geometry>

#include "common/mesh.hpp"
#include "common/vertex_normals.hpp"

namespace shape3d::apps::viewer {
namespace {

template <class Array, class T>
vtkSmartPointer<Array> adopt(zmc::detail::Buffer<T>&& buffer, int components) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(components);
  const auto size = static_cast<vtkIdType>(buffer.size());
  if (size == 0) return array;
  array->SetArray(zmc::detail::release_array(std::move(buffer)), size, 0,
                  vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
  array->SetArrayFreeFunction([](void* memory) { zmc::detail::free_array(memory); });
  return array;
}

// Cells of `corners` vertices each.
vtkSmartPointer<vtkCellArray> cells_of(vtkTypeInt32Array* ids, int corners) {
  const vtkIdType count = ids->GetNumberOfValues() / corners;
  vtkNew<vtkTypeInt32Array> offsets;
  offsets->SetNumberOfValues(count + 1);
  for (vtkIdType n = 0; n <= count; ++n)
    offsets->SetValue(n, static_cast<std::int32_t>(corners * n));
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, ids);
  return cells;
}

// Those vertices of a surface that some ids name, and the ids numbered anew.
vtkSmartPointer<vtkPolyData> part_of(const Surface& surface, const std::int32_t* ids,
                                     std::int64_t count, int corners) {
  std::vector<std::int32_t> used(ids, ids + count);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(static_cast<vtkIdType>(used.size()));
  for (std::size_t n = 0; n < used.size(); ++n)
    points->SetPoint(static_cast<vtkIdType>(n),
                     surface.positions.data() + 3 * static_cast<std::ptrdiff_t>(used[n]));
  vtkNew<vtkTypeInt32Array> renumbered;
  renumbered->SetNumberOfValues(count);
  for (std::int64_t n = 0; n < count; ++n) {
    const auto at = std::lower_bound(used.begin(), used.end(), ids[n]) - used.begin();
    renumbered->SetValue(n, static_cast<std::int32_t>(at));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  const auto cells = cells_of(renumbered, corners);
  if (corners == 2) {
    data->SetLines(cells);
  } else {
    data->SetPolys(cells);
  }
  return data;
}

}  // namespace

std::vector<std::int32_t> nonmanifold_edges(const Surface& surface) {
  const auto is_zero = [&surface](std::int32_t v) {
    const auto n = static_cast<std::size_t>(v);
    return surface.edges[n] >= 0 && surface.edge_parameters[n] == 0.0F;
  };
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  if (surface.edges.empty()) return {};
  for (std::int64_t t = 0; t < surface.triangle_count(); ++t) {
    const std::int32_t* corner = surface.indices.data() + 3 * t;
    for (int side = 0; side < 3; ++side) {
      const std::int32_t a = corner[side], b = corner[(side + 1) % 3];
      if (is_zero(a) && is_zero(b)) edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::int32_t> result;
  for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
    while (end < edges.size() && edges[end] == edges[first]) ++end;
    if (end - first > 2) result.insert(result.end(), {edges[first].first, edges[first].second});
  }
  return result;
}

vtkSmartPointer<vtkPolyData> zero_faces(const Surface& surface) {
  const std::int64_t count = surface.first_closing - surface.first_zero_face;
  if (count <= 0) return nullptr;
  return part_of(surface, surface.indices.data() + 3 * surface.first_zero_face, 3 * count, 3);
}

vtkSmartPointer<vtkPolyData> line_data(const Surface& surface,
                                       const std::vector<std::int32_t>& edges) {
  if (edges.empty()) return nullptr;
  return part_of(surface, edges.data(), static_cast<std::int64_t>(edges.size()), 2);
}

vtkSmartPointer<vtkPolyData> surface_data(Surface&& surface) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetData(adopt<vtkFloatArray>(std::move(surface.positions), 3));
  data->SetPoints(points);
  const auto ids = adopt<vtkTypeInt32Array>(std::move(surface.indices), 1);
  data->SetPolys(cells_of(ids, 3));
  if (!surface.normals.empty()) {
    const auto normals = adopt<vtkFloatArray>(std::move(surface.normals), 3);
    normals->SetName("Normals");
    data->GetPointData()->SetNormals(normals);
  }
  return data;
}

vtkSmartPointer<vtkPolyData> mesh_data(const Mesh& mesh) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkFloatArray> positions, normals;
  for (vtkFloatArray* array : {positions.Get(), normals.Get()}) {
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(mesh.V.rows());
  }
  Eigen::Map<Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      positions->GetPointer(0), mesh.V.rows(), 3) = mesh.V.cast<float>();
  Eigen::Map<Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      normals->GetPointer(0), mesh.V.rows(), 3) = vertex_normals(mesh).cast<float>();
  vtkNew<vtkPoints> points;
  points->SetData(positions);
  data->SetPoints(points);
  normals->SetName("Normals");
  data->GetPointData()->SetNormals(normals);
  vtkNew<vtkTypeInt32Array> ids;
  ids->SetNumberOfValues(mesh.F.size());
  std::copy(mesh.F.data(), mesh.F.data() + mesh.F.size(), ids->GetPointer(0));
  data->SetPolys(cells_of(ids, 3));
  return data;
}

vtkSmartPointer<vtkPolyData> twin_of(vtkPolyData* surface) {
  auto twin = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetData(surface->GetPoints()->GetData());
  vtkNew<vtkCellArray> cells;
  cells->ShallowCopy(surface->GetPolys());
  twin->SetPoints(points);
  twin->SetPolys(cells);
  return twin;
}

vtkSmartPointer<vtkPolyData> level_of_detail(vtkPolyData* surface, std::int64_t triangles) {
  if (surface->GetNumberOfPolys() <= triangles) return nullptr;
  double bounds[6];
  surface->GetBounds(bounds);
  double longest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    longest = std::max(longest, bounds[2 * axis + 1] - bounds[2 * axis]);
  if (!(longest > 0.0)) return nullptr;
  // Clusters are cubes. How many a surface meets grows with the square of the divisions and with
  // its area in the box: it is tried out for a convex body and put right once.
  vtkNew<vtkQuadricClustering> cluster;
  cluster->SetInputData(surface);
  cluster->UseInputPointsOn();
  cluster->CopyCellDataOff();
  cluster->AutoAdjustNumberOfDivisionsOff();
  double divisions = std::sqrt(static_cast<double>(triangles) / 10.0);
  for (int attempt = 0; attempt < 2; ++attempt) {
    const auto along = [&](int axis) {
      return std::max(
          2, static_cast<int>(divisions * (bounds[2 * axis + 1] - bounds[2 * axis]) / longest));
    };
    cluster->SetNumberOfDivisions(along(0), along(1), along(2));
    cluster->Update();
    const double ratio = static_cast<double>(cluster->GetOutput()->GetNumberOfPolys()) /
                         static_cast<double>(triangles);
    if (ratio > 0.7 && ratio < 1.3) break;
    divisions /= std::sqrt(std::max(ratio, 0.01));
  }
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputConnection(cluster->GetOutputPort());
  normals->SplittingOff();
  normals->ConsistencyOff();
  normals->Update();
  return normals->GetOutput();
}

}  // namespace shape3d::apps::viewer
