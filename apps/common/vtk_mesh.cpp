#include "vtk_mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLPolyDataWriter.h>

#include "error.hpp"
#include "vtk_messages.hpp"

namespace shape3d::apps {
namespace {

template <class VtkArray, class Value>
vtkSmartPointer<VtkArray> borrow(const Value* values, std::int64_t count, int components) {
  auto array = vtkSmartPointer<VtkArray>::New();
  array->SetNumberOfComponents(components);
  // VTK's interface has no const; the writer reads only, and save = 1 leaves the memory to its
  // owner.
  using Element = typename VtkArray::ValueType;
  static_assert(sizeof(Element) == sizeof(Value));  // VTK's 64-bit integers are long long
  array->SetArray(reinterpret_cast<Element*>(const_cast<Value*>(values)), count, 1);
  return array;
}

template <class VtkArray>
void set_polygons(vtkPolyData* data, VtkArray* connectivity, std::int64_t triangles) {
  using Index = typename VtkArray::ValueType;
  vtkNew<VtkArray> offsets;
  offsets->SetNumberOfValues(triangles + 1);
  for (std::int64_t t = 0; t <= triangles; ++t) offsets->SetValue(t, static_cast<Index>(3 * t));
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  data->SetPolys(cells);
}

void add_arrays(vtkDataSetAttributes* data, const std::vector<MeshArray>* arrays) {
  if (arrays == nullptr) return;
  for (const MeshArray& array : *arrays) {
    vtkSmartPointer<vtkDataArray> copy;
    if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&array.values)) {
      copy =
          borrow<vtkUnsignedCharArray>(bytes->data(), static_cast<std::int64_t>(bytes->size()), 1);
    } else {
      const auto& numbers = std::get<std::vector<double>>(array.values);
      copy = borrow<vtkDoubleArray>(numbers.data(), static_cast<std::int64_t>(numbers.size()), 1);
    }
    copy->SetName(array.name.c_str());
    data->AddArray(copy);
  }
}

}  // namespace

vtkSmartPointer<vtkPolyData> borrow_polydata(const MeshView& mesh) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetData(borrow<vtkDoubleArray>(mesh.positions, 3 * mesh.vertex_count, 3));
  data->SetPoints(points);
  if (const auto* narrow = std::get_if<const std::int32_t*>(&mesh.indices)) {
    if (3 * mesh.triangle_count <= std::numeric_limits<std::int32_t>::max()) {
      set_polygons<vtkTypeInt32Array>(
          data, borrow<vtkTypeInt32Array>(*narrow, 3 * mesh.triangle_count, 1),
          mesh.triangle_count);
    } else {
      vtkNew<vtkTypeInt64Array> wide;  // the offsets need it
      wide->SetNumberOfValues(3 * mesh.triangle_count);
      std::copy(*narrow, *narrow + 3 * mesh.triangle_count, wide->GetPointer(0));
      set_polygons<vtkTypeInt64Array>(data, wide.Get(), mesh.triangle_count);
    }
  } else {
    const auto* ids = std::get<const std::int64_t*>(mesh.indices);
    set_polygons<vtkTypeInt64Array>(
        data, borrow<vtkTypeInt64Array>(ids, 3 * mesh.triangle_count, 1), mesh.triangle_count);
  }
  add_arrays(data->GetPointData(), mesh.vertex_arrays);
  add_arrays(data->GetCellData(), mesh.triangle_arrays);
  return data;
}

vtkSmartPointer<vtkUnsignedCharArray> color_array(const std::vector<std::uint8_t>& bytes) {
  auto colors = vtkSmartPointer<vtkUnsignedCharArray>::New();
  colors->SetName("Colors");
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(static_cast<vtkIdType>(bytes.size() / 3));
  std::copy(bytes.begin(), bytes.end(), colors->GetPointer(0));
  return colors;
}

void write_polydata(OutputFile& file, vtkPolyData* data) {
  const VtkMessages messages;
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(data);
  writer->SetFileName(file.temporary_path().c_str());
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToNone();
  writer->SetHeaderTypeToUInt64();
  file.finish();
  const bool written = writer->Write() != 0 && writer->GetErrorCode() == 0;
  const std::string error = messages.first_error();
  if (!written || !error.empty()) {
    throw FileError(file.path(),
                    "cannot be written: " + (error.empty() ? "no space is left" : error));
  }
}

}  // namespace shape3d::apps
