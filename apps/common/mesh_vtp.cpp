#include <charconv>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include "mesh_formats.hpp"
#include "vtk_mesh.hpp"
#include "vtk_messages.hpp"

namespace shape3d::apps::formats {
namespace {

// zlib compresses 1032 to 1 at best; other compressors VTK knows reach less on arrays of this kind.
constexpr double kBestCompression = 1100.0;

// VTK allocates what the Piece element announces; this compares it with the bytes there are.
void check_counts(std::string_view bytes, const std::string& name) {
  struct Count {
    std::string_view attribute;
    double bytes_each;  // the least one takes: coordinates of 12 bytes, a cell's offset and one id
  };
  for (const Count& count :
       {Count{"NumberOfPoints", 12.0}, Count{"NumberOfPolys", 5.0}, Count{"NumberOfStrips", 5.0},
        Count{"NumberOfLines", 5.0}, Count{"NumberOfVerts", 5.0}}) {
    for (std::size_t at = bytes.find(count.attribute); at != std::string_view::npos;
         at = bytes.find(count.attribute, at + 1)) {
      std::size_t value_at = bytes.find_first_not_of(" \t\r\n", at + count.attribute.size());
      if (value_at == std::string_view::npos || bytes[value_at] != '=') continue;
      value_at = bytes.find_first_of("\"'", value_at);
      if (value_at == std::string_view::npos) continue;
      std::int64_t value = 0;
      const char* start = bytes.data() + value_at + 1;
      const auto [end, error] = std::from_chars(start, bytes.data() + bytes.size(), value);
      if (error == std::errc::result_out_of_range || value < 0 || value > kMaxCount ||
          static_cast<double>(value) * count.bytes_each >
              kBestCompression * static_cast<double>(bytes.size())) {
        throw FileError(name, "byte " + std::to_string(value_at + 1) + ": " +
                                  std::string(count.attribute) + " is " + std::string(start, end) +
                                  ", more than " + std::to_string(bytes.size()) +
                                  " bytes can hold");
      }
    }
  }
}

std::vector<MeshArray> read_arrays(vtkDataSetAttributes* data, vtkIdType tuples) {
  std::vector<MeshArray> arrays;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = data->GetArray(i);
    if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() != 1 ||
        array->GetNumberOfTuples() != tuples) {
      continue;
    }
    MeshArray copy;
    copy.name = array->GetName();
    std::vector<double> values(static_cast<std::size_t>(tuples));
    for (vtkIdType t = 0; t < tuples; ++t)
      values[static_cast<std::size_t>(t)] = array->GetComponent(t, 0);
    copy.values = std::move(values);
    arrays.push_back(std::move(copy));
  }
  return arrays;
}

void read_points(vtkPolyData* data, const std::string& name, Mesh& mesh) {
  const vtkIdType count = data->GetNumberOfPoints();
  mesh.V.resize(count, 3);
  for (vtkIdType i = 0; i < count; ++i) {
    data->GetPoint(i, mesh.V.data() + 3 * i);
    if (!mesh.V.row(i).allFinite()) {
      throw FileError(name, "expected finite coordinates of point " + std::to_string(i));
    }
  }
}

void read_faces(vtkPolyData* data, const std::string& name, MeshFile& file) {
  vtkCellArray* polys = data->GetPolys();
  const vtkIdType points = data->GetNumberOfPoints();
  const vtkIdType cells = polys->GetNumberOfCells();
  vtkDataArray* offsets = polys->GetOffsetsArray();
  const vtkIdType ids = polys->GetNumberOfConnectivityIds();
  std::vector<std::int32_t> indices;
  FaceCollector collector(indices);
  for (vtkIdType cell = 0; cell < cells; ++cell) {
    const auto begin = static_cast<vtkIdType>(offsets->GetComponent(cell, 0));
    const auto end = static_cast<vtkIdType>(offsets->GetComponent(cell + 1, 0));
    if (begin < 0 || end < begin || end > ids) {
      throw FileError(name, "the offsets of polygon " + std::to_string(cell) + " are " +
                                std::to_string(begin) + " and " + std::to_string(end) +
                                ", expected to rise and to stay within " + std::to_string(ids));
    }
    vtkIdType size = 0;
    const vtkIdType* corners = nullptr;
    polys->GetCellAtId(cell, size, corners);
    for (vtkIdType c = 0; c < size; ++c) {
      if (corners[c] < 0 || corners[c] >= points) {
        throw FileError(name,
                        "polygon " + std::to_string(cell) + ": expected a point index from 0 to " +
                            std::to_string(points - 1) + ", found " + std::to_string(corners[c]));
      }
    }
    collector.add(corners, static_cast<std::size_t>(size));
  }
  collector.report(file);
  file.mesh.F = Eigen::Map<const Mesh::Triangles>(indices.data(),
                                                  static_cast<Eigen::Index>(indices.size() / 3), 3);
  // A polygon that became several triangles, or none, would shift the cell arrays.
  if (file.mesh.F.rows() == cells && file.polygons == 0 && data->GetNumberOfCells() == cells) {
    file.mesh.triangle_arrays = read_arrays(data->GetCellData(), cells);
  }
}

}  // namespace

MeshFile parse_vtp(std::string_view bytes, const std::string& name) {
  const std::string_view head = bytes.substr(0, std::min<std::size_t>(bytes.size(), 4096));
  if (head.find("<VTKFile") == std::string_view::npos ||
      head.find("PolyData") == std::string_view::npos) {
    throw FileError(name,
                    "expected a VTK XML file of type PolyData (<VTKFile type=\"PolyData\" …>)");
  }
  check_counts(bytes, name);
  const VtkMessages messages;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(std::string(bytes));
  reader->Update();
  if (const std::string error = messages.first_error();
      !error.empty() || reader->GetErrorCode() != 0) {
    throw FileError(
        name, "is not a whole VTK PolyData file: " + (error.empty() ? "unknown error" : error));
  }
  vtkPolyData* data = reader->GetOutput();
  MeshFile file;
  file.format = MeshFormat::vtp;
  file.encoding = "VTK XML";
  read_points(data, name, file.mesh);
  read_faces(data, name, file);
  file.mesh.vertex_arrays = read_arrays(data->GetPointData(), data->GetNumberOfPoints());
  if (auto* space = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray("SPACE"));
      space != nullptr && space->GetNumberOfValues() > 0) {
    file.mesh.comments.push_back("SPACE=" + std::string(space->GetValue(0)));
    find_space(file.mesh);
  }
  if (const vtkIdType strips = data->GetNumberOfStrips(); strips > 0) {
    throw FileError(name,
                    "holds " + std::to_string(strips) + " triangle strips, expected polygons");
  }
  if (const vtkIdType others = data->GetNumberOfLines() + data->GetNumberOfVerts(); others > 0) {
    file.warnings.push_back(std::to_string(others) + " lines and points were not read");
  }
  return file;
}

void write_vtp(OutputFile& file, const MeshView& mesh) {
  const vtkSmartPointer<vtkPolyData> data = borrow_polydata(mesh);
  if (!mesh.space.empty()) {
    vtkNew<vtkStringArray> space;
    space->SetName("SPACE");
    space->InsertNextValue(mesh.space);
    data->GetFieldData()->AddArray(space);
  }
  write_polydata(file, data);
}

}  // namespace shape3d::apps::formats
