#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <shape3d/descriptors/descriptor.hpp>

#include "common/byte_source.hpp"
#include "common/describe_mesh.hpp"
#include "common/mesh_io.hpp"
#include "common/shape_library.hpp"
#include "support/test_data.hpp"

namespace shape3d::test {

/// A box of given sides, its corner at the origin.
inline apps::Mesh brick(double a, double b, double c) {
  apps::Mesh mesh;
  mesh.V.resize(8, 3);
  for (int v = 0; v < 8; ++v)
    mesh.V.row(v) << ((v & 1) != 0 ? a : 0.0), ((v & 2) != 0 ? b : 0.0), ((v & 4) != 0 ? c : 0.0);
  mesh.F.resize(12, 3);
  mesh.F << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4,
      6, 1, 3, 5, 3, 7, 5;
  return mesh;
}

/// Boxes on disk: `plates` and `rods` of `count` each, and a library of them without pictures.
class SmallLibrary {
 public:
  explicit SmallLibrary(int count = 4) : path((folder / "boxes.db").string()) {
    apps::ShapeLibrary library(path, apps::ShapeLibrary::Access::create);
    for (int n = 0; n < count; ++n) {
      add(library, "plate" + std::to_string(n), "plate", brick(10.0, 9.0 + 0.7 * n, 1.0));
      add(library, "rod" + std::to_string(n), "rod", brick(10.0, 1.0, 1.0 + 0.4 * n));
    }
  }

  static std::string spec() { return descriptors::Descriptor::parse("d2").to_string(); }

  /// Writes a mesh. @return its path.
  std::string write(const std::string& name, const apps::Mesh& mesh) const {
    const std::string file = (folder / (name + ".off")).string();
    apps::write_mesh(file, apps::view_of(mesh));
    return file;
  }

  TemporaryFolder folder;
  std::string path;

 private:
  void add(apps::ShapeLibrary& library, const std::string& name, const std::string& class_name,
           const apps::Mesh& mesh) const {
    apps::LibraryModel model;
    model.file.path = write(name, mesh);
    model.digest = apps::digest_of(apps::MappedFile(model.file.path).bytes());
    model.vertices = mesh.V.rows();
    model.triangles = mesh.F.rows();
    model.class_name = class_name;
    const auto descriptor = descriptors::Descriptor::parse(spec());
    library.put(model, {{spec(), apps::describe_mesh(mesh, {descriptor}, 1).front()}});
  }
};

}  // namespace shape3d::test
