// Meshes in the format that the first byte names: o(ff), w(avefront OBJ), p(ly), s(tl), v(tp, VTK's
// reader in a child process). What is read is whole, and is read again from what is written of it.

#include <cmath>
#include <string>
#include <string_view>

#include "check.hpp"
#include "common/error.hpp"
#include "common/mesh_check.hpp"
#include "common/mesh_io.hpp"
#include "scratch_folder.hpp"

namespace {

using namespace shape3d::apps;
using namespace shape3d::fuzz;

void check_mesh_file(const MeshFile& file) {
  const Mesh& mesh = file.mesh;
  check(mesh.V.allFinite(), "coordinates are finite");
  check(mesh.F.size() == 0 || (mesh.F.minCoeff() >= 0 && mesh.F.maxCoeff() < mesh.V.rows()),
        "triangles name vertices");
  const auto size_of = [](const MeshArray& array) {
    return std::visit([](const auto& values) { return values.size(); }, array.values);
  };
  for (const MeshArray& array : mesh.vertex_arrays) {
    check(size_of(array) == static_cast<std::size_t>(mesh.V.rows()), "each vertex has its number");
  }
  for (const MeshArray& array : mesh.triangle_arrays) {
    check(size_of(array) == static_cast<std::size_t>(mesh.F.rows()),
          "each triangle has its number");
  }
  const MeshCheck facts = check_mesh(view_of(mesh));
  check(facts.vertices == mesh.V.rows() && facts.triangles == mesh.F.rows(),
        "the check counts what there is");
}

/// STL rounds binary coordinates to float and numbers vertices anew; its text keeps doubles, but
/// not vertices that no triangle uses.
void check_again(const MeshFile& file, MeshFormat format, MeshEncoding encoding) {
  const std::string path = scratch_folder() / ("again." + std::string(to_string(format)));
  write_mesh(path, view_of(file.mesh), encoding);
  const MeshFile again = read_mesh(path);
  check(again.mesh.F.rows() == file.mesh.F.rows(), "what is written has as many triangles");
  if (format == MeshFormat::stl) return;
  check(again.mesh.V == file.mesh.V, "what is written has the same vertices");
  check(again.mesh.F == file.mesh.F, "what is written has the same triangles");
}

void run(MeshFormat format, std::string_view bytes) {
  MeshFile file;
  try {
    file = parse_mesh(bytes, format, "input");
  } catch (const FileError& error) {
    const std::string text = error.what();
    check(text.rfind("input: ", 0) == 0, "an error names its file: " + text);
    for (const char c : text) {
      check(static_cast<unsigned char>(c) >= 32, "an error is printable: " + text);
    }
    return;
  }
  check_mesh_file(file);
  constexpr Eigen::Index kMost = 1000;
  if (file.mesh.V.rows() > kMost || file.mesh.F.rows() > kMost) return;
  // Text of STL may hold numbers that binary STL has not.
  const bool text = format == MeshFormat::stl || (bytes.size() % 2) == 0;
  check_again(file, format, text ? MeshEncoding::ascii : MeshEncoding::binary);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  MeshFormat format = MeshFormat::off;
  switch (data[0]) {
    case 'w':
      format = MeshFormat::obj;
      break;
    case 'p':
      format = MeshFormat::ply;
      break;
    case 's':
      format = MeshFormat::stl;
      break;
    case 'v':
      format = MeshFormat::vtp;
      break;
    default:
      break;
  }
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  expect_no_exception([&] { run(format, bytes); }, std::string(to_string(format)));
  return 0;
}
