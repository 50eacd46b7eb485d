#include <charconv>

#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>

#include "mesh_formats.hpp"
#include "vtk_mesh.hpp"
#include "vtp_polydata.hpp"

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

// The arrays of one number for each of `count` elements.
std::vector<MeshArray> arrays_of(std::vector<MeshArray> arrays, std::size_t count) {
  arrays.erase(std::remove_if(arrays.begin(), arrays.end(),
                              [&](const MeshArray& array) {
                                return std::get<std::vector<double>>(array.values).size() != count;
                              }),
               arrays.end());
  return arrays;
}

void read_points(const VtpPolyData& data, const std::string& name, Mesh& mesh) {
  const std::size_t count = data.points.size() / 3;
  if (count > static_cast<std::size_t>(kMaxCount)) {
    throw FileError(name,
                    "has " + std::to_string(count) + " vertices, expected at most 2147483647");
  }
  mesh.V = Eigen::Map<const Mesh::Points>(data.points.data(), static_cast<Eigen::Index>(count), 3);
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    if (!mesh.V.row(i).allFinite()) {
      throw FileError(name, "expected finite coordinates of point " + std::to_string(i));
    }
  }
}

void read_faces(VtpPolyData& data, const std::string& name, MeshFile& file) {
  const std::int64_t points = file.mesh.V.rows();
  const std::size_t cells = data.offsets.empty() ? 0 : data.offsets.size() - 1;
  const auto ids = static_cast<std::int64_t>(data.ids.size());
  std::vector<std::int32_t> indices;
  FaceCollector collector(indices);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::int64_t begin = data.offsets[cell], end = data.offsets[cell + 1];
    if (begin < 0 || end < begin || end > ids) {
      throw FileError(name, "the offsets of polygon " + std::to_string(cell) + " are " +
                                std::to_string(begin) + " and " + std::to_string(end) +
                                ", expected to rise and to stay within " + std::to_string(ids));
    }
    for (std::int64_t c = begin; c < end; ++c) {
      const std::int64_t id = data.ids[static_cast<std::size_t>(c)];
      if (id < 0 || id >= points) {
        throw FileError(name, "polygon " + std::to_string(cell) +
                                  ": expected a point index from 0 to " +
                                  std::to_string(points - 1) + ", found " + std::to_string(id));
      }
    }
    collector.add(data.ids.data() + begin, static_cast<std::size_t>(end - begin));
  }
  if (indices.size() / 3 > static_cast<std::size_t>(kMaxCount)) {
    throw FileError(name, "has " + std::to_string(indices.size() / 3) +
                              " triangles, expected at most 2147483647");
  }
  collector.report(file);
  file.mesh.F = Eigen::Map<const Mesh::Triangles>(indices.data(),
                                                  static_cast<Eigen::Index>(indices.size() / 3), 3);
  // A polygon that became several triangles, or none, would shift the cell arrays.
  if (static_cast<std::size_t>(file.mesh.F.rows()) == cells && file.polygons == 0 &&
      data.strips + data.lines_and_points == 0) {
    file.mesh.triangle_arrays = arrays_of(std::move(data.cell_arrays), cells);
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
  VtpPolyData data = read_vtp(bytes, name);
  MeshFile file;
  file.format = MeshFormat::vtp;
  file.encoding = "VTK XML";
  read_points(data, name, file.mesh);
  read_faces(data, name, file);
  file.mesh.vertex_arrays =
      arrays_of(std::move(data.point_arrays), static_cast<std::size_t>(file.mesh.V.rows()));
  if (!data.space.empty()) {
    file.mesh.comments.push_back("SPACE=" + data.space);
    find_space(file.mesh);
  }
  if (data.strips > 0) {
    throw FileError(name,
                    "holds " + std::to_string(data.strips) + " triangle strips, expected polygons");
  }
  if (data.lines_and_points > 0) {
    file.warnings.push_back(std::to_string(data.lines_and_points) +
                            " lines and points were not read");
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
