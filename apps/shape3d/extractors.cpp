#include "extractors.hpp"

#include <algorithm>
#include <array>

#include <vtkCellArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkImageImport.h>
#include <vtkMarchingCubes.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <shape3d/zmc/extract.hpp>

#include "common/position_table.hpp"
#include "common/vtk_samples.hpp"
#include "stopwatch.hpp"

namespace shape3d::apps {
namespace {

template <class From, class To>
void copy_samples(const zmc::VolumeView& view, std::vector<To>& to) {
  const std::array<std::int64_t, 3> strides = view.effective_strides();
  const From* data = static_cast<const From*>(view.data);
  to.reserve(static_cast<std::size_t>(view.dims[0] * view.dims[1] * view.dims[2]));
  for (std::int64_t k = 0; k < view.dims[2]; ++k) {
    for (std::int64_t j = 0; j < view.dims[1]; ++j) {
      for (std::int64_t i = 0; i < view.dims[0]; ++i) {
        to.push_back(static_cast<To>(data[i * strides[0] + j * strides[1] + k * strides[2]]));
      }
    }
  }
}

template <class T>
void negate_all(std::vector<T>& samples) {
  for (T& sample : samples) sample = static_cast<T>(-sample);
}

Mesh to_mesh(vtkPolyData* data) {
  Mesh mesh;
  mesh.V.resize(data->GetNumberOfPoints(), 3);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    data->GetPoint(i, mesh.V.data() + 3 * i);
  vtkCellArray* polys = data->GetPolys();
  mesh.F.resize(polys->GetNumberOfCells(), 3);
  for (vtkIdType cell = 0; cell < polys->GetNumberOfCells(); ++cell) {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    polys->GetCellAtId(cell, size, ids);
    for (int c = 0; c < 3; ++c) mesh.F(cell, c) = static_cast<std::int32_t>(ids[c]);
  }
  return mesh;
}

template <class Filter>
ExtractedMesh run_vtk(const zmc::VolumeView& view, double isovalue, const zmc::Options& options) {
  vtkSMPTools::Initialize(options.threads);
  vtkNew<vtkImageImport> import;
  const std::array<int, 3> last{static_cast<int>(view.dims[0] - 1),
                                static_cast<int>(view.dims[1] - 1),
                                static_cast<int>(view.dims[2] - 1)};
  import->SetImportVoidPointer(
      const_cast<void*>(view.data));  // read only; VTK's interface has no const
  import->SetDataScalarType(vtk_type(view.type));
  import->SetNumberOfScalarComponents(1);
  import->SetDataExtent(0, last[0], 0, last[1], 0, last[2]);
  import->SetWholeExtent(0, last[0], 0, last[1], 0, last[2]);
  import->SetDataSpacing(view.spacing[0], view.spacing[1], view.spacing[2]);
  import->Update();
  vtkNew<Filter> filter;
  filter->SetInputData(import->GetOutput());
  filter->ComputeNormalsOff();
  filter->ComputeGradientsOff();
  filter->ComputeScalarsOff();
  filter->SetValue(0, isovalue);
  ExtractedMesh result;
  Stopwatch watch;
  filter->Update();
  result.seconds = watch.lap();
  result.mesh = to_mesh(filter->GetOutput());
  return result;
}

std::vector<std::array<std::int64_t, 3>> sorted_triangles(const Mesh& mesh,
                                                          PositionTable<double>& table) {
  std::vector<std::int64_t> ids(static_cast<std::size_t>(mesh.V.rows()));
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    ids[static_cast<std::size_t>(v)] = table.id_of({mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2)});
  }
  std::vector<std::array<std::int64_t, 3>> triangles;
  triangles.reserve(static_cast<std::size_t>(mesh.F.rows()));
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    std::array<std::int64_t, 3> f{};
    for (std::size_t c = 0; c < 3; ++c)
      f[c] = ids[static_cast<std::size_t>(mesh.F(t, static_cast<Eigen::Index>(c)))];
    std::sort(f.begin(), f.end());
    if (f[0] != f[1] && f[1] != f[2]) triangles.push_back(f);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace

NegatableVolume::NegatableVolume(const zmc::VolumeView& view) {
  switch (view.type) {
    case zmc::SampleType::int8:
      copy_samples<std::int8_t>(view, shorts_);
      break;
    case zmc::SampleType::uint8:
      copy_samples<std::uint8_t>(view, shorts_);
      break;
    case zmc::SampleType::int16:
      copy_samples<std::int16_t>(view, integers_);
      break;
    case zmc::SampleType::uint16:
      copy_samples<std::uint16_t>(view, integers_);
      break;
    case zmc::SampleType::int32:
      copy_samples<std::int32_t>(view, doubles_);
      break;
    case zmc::SampleType::float32:
      copy_samples<float>(view, floats_);
      break;
    case zmc::SampleType::float64:
      copy_samples<double>(view, doubles_);
      break;
  }
  if (!shorts_.empty()) view_ = zmc::make_view(shorts_.data(), view.dims, view.spacing);
  if (!integers_.empty()) view_ = zmc::make_view(integers_.data(), view.dims, view.spacing);
  if (!floats_.empty()) view_ = zmc::make_view(floats_.data(), view.dims, view.spacing);
  if (!doubles_.empty()) view_ = zmc::make_view(doubles_.data(), view.dims, view.spacing);
}

void NegatableVolume::negate() {
  negate_all(shorts_);
  negate_all(integers_);
  negate_all(floats_);
  negate_all(doubles_);
}

std::string to_string(Extractor extractor) {
  switch (extractor) {
    case Extractor::zmc:
      return "Shape3D::zmc";
    case Extractor::vtk_flying_edges:
      return "vtkFlyingEdges3D";
    case Extractor::vtk_marching_cubes:
      return "vtkMarchingCubes";
  }
  return {};
}

ExtractedMesh run_extractor(Extractor extractor, const zmc::VolumeView& view, double isovalue,
                            const zmc::Options& options) {
  if (extractor == Extractor::vtk_flying_edges)
    return run_vtk<vtkFlyingEdges3D>(view, isovalue, options);
  if (extractor == Extractor::vtk_marching_cubes)
    return run_vtk<vtkMarchingCubes>(view, isovalue, options);
  Stopwatch watch;
  zmc::Surface<double, std::int32_t> surface;
  if (zmc::extract(view, isovalue, options, surface) == zmc::Status::too_many_vertices) {
    throw std::length_error("the surface has more vertices than 32-bit ids can number");
  }
  ExtractedMesh result;
  result.seconds = watch.lap();
  result.mesh.V = surface.V();
  result.mesh.F = surface.F();
  return result;
}

std::int64_t merge_coincident(Mesh& mesh) {
  std::vector<double> positions;
  PositionTable<double> table(positions, static_cast<std::size_t>(mesh.V.rows()));
  std::vector<std::int32_t> ids(static_cast<std::size_t>(mesh.V.rows()));
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    ids[static_cast<std::size_t>(v)] =
        static_cast<std::int32_t>(table.id_of({mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2)}));
  }
  const std::int64_t merged = mesh.V.rows() - table.size();
  mesh.V = Eigen::Map<const Mesh::Points>(positions.data(), table.size(), 3);
  for (Eigen::Index i = 0; i < mesh.F.size(); ++i)
    mesh.F.data()[i] = ids[static_cast<std::size_t>(mesh.F.data()[i])];
  return merged;
}

std::int64_t triangles_in_one_only(const Mesh& a, const Mesh& b) {
  std::vector<double> positions;
  PositionTable<double> table(positions, static_cast<std::size_t>(a.V.rows()));
  const std::vector<std::array<std::int64_t, 3>> in_a = sorted_triangles(a, table),
                                                 in_b = sorted_triangles(b, table);
  std::vector<std::array<std::int64_t, 3>> difference;
  std::set_symmetric_difference(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(),
                                std::back_inserter(difference));
  return static_cast<std::int64_t>(difference.size());
}

}  // namespace shape3d::apps
