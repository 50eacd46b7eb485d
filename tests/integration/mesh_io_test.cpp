#include "common/mesh_io.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <sstream>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "common/interrupt.hpp"
#include "common/mesh_check.hpp"
#include "mesh_families.hpp"
#include "support/test_data.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::test;
namespace fs = std::filesystem;

using Catch::Matchers::Contains;

std::string slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void spill(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// A mesh whose coordinates need all 17 digits.
Mesh irrational_torus() {
  Mesh mesh = torus(9, 7);
  mesh.V *= 1.0 / 3.0;
  mesh.V.rowwise() += Eigen::RowVector3d(1e3 / 7, -1e-9 / 3, 1e8 / 9);
  mesh.space = "LPS";
  mesh.comments = {"made for a test"};
  return mesh;
}

std::string bytes_of(const Mesh& mesh, MeshFormat format,
                     MeshEncoding encoding = MeshEncoding::binary) {
  const TemporaryFolder folder;
  const std::string path = (folder / "mesh").string();
  OutputFile file(path);
  write_mesh(file, format, view_of(mesh), encoding);
  file.commit();
  return slurp(path);
}

MeshFile parse(const std::string& text, MeshFormat format) {
  return parse_mesh(text, format, "mesh");
}

// The message of the FileError, which has to name the file.
std::string error_of(const std::string& bytes, MeshFormat format) {
  try {
    (void)parse_mesh(bytes, format, "some/mesh");
  } catch (const FileError& error) {
    const std::string what = error.what();
    CHECK(what.rfind("some/mesh: ", 0) == 0);
    return what;
  }
  FAIL("no error for: " << bytes.substr(0, 400));
  return {};
}

constexpr MeshFormat kFormats[] = {MeshFormat::off, MeshFormat::obj, MeshFormat::ply,
                                   MeshFormat::stl, MeshFormat::vtp};

TEST_CASE("double coordinates survive every format that has them", "[mesh_io][round trip]") {
  const Mesh mesh = irrational_torus();
  struct Case {
    MeshFormat format;
    MeshEncoding encoding;
    std::string name;
  };
  for (const Case& c : {Case{MeshFormat::off, MeshEncoding::ascii, "ascii"},
                        Case{MeshFormat::obj, MeshEncoding::ascii, "ascii"},
                        Case{MeshFormat::ply, MeshEncoding::binary, "binary little endian"},
                        Case{MeshFormat::ply, MeshEncoding::binary_big_endian, "binary big endian"},
                        Case{MeshFormat::ply, MeshEncoding::ascii, "ascii"},
                        Case{MeshFormat::vtp, MeshEncoding::binary, "VTK XML"}}) {
    INFO(to_string(c.format) << " " << c.name);
    const MeshFile file = parse(bytes_of(mesh, c.format, c.encoding), c.format);
    CHECK(file.encoding == c.name);
    CHECK(file.mesh.V == mesh.V);
    CHECK(file.mesh.F == mesh.F);
    CHECK(file.mesh.space == "LPS");
    CHECK(file.polygons == 0);
    CHECK(file.warnings.empty());
  }
}

TEST_CASE("STL keeps the shape, in floats when binary, and merges the vertices again",
          "[mesh_io][round trip]") {
  Mesh mesh = torus(9, 7);
  mesh.space = "LPS";
  for (const MeshEncoding encoding : {MeshEncoding::binary, MeshEncoding::ascii}) {
    const MeshFile file = parse(bytes_of(mesh, MeshFormat::stl, encoding), MeshFormat::stl);
    CHECK(file.mesh.space == "LPS");
    REQUIRE(file.mesh.V.rows() == mesh.V.rows());
    REQUIRE(file.mesh.F.rows() == mesh.F.rows());
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
      for (int c = 0; c < 3; ++c) {
        const Eigen::RowVector3d p = mesh.V.row(mesh.F(t, c));
        Eigen::RowVector3d rounded;
        for (int i = 0; i < 3; ++i) {
          const volatile float narrow =
              static_cast<float>(p[i]);  // GCC 12 elides the pair of casts
          rounded[i] = narrow;
        }
        const Eigen::RowVector3d q = file.mesh.V.row(file.mesh.F(t, c));
        REQUIRE(q == (encoding == MeshEncoding::ascii ? p : rounded));
      }
    }
    const MeshCheck check = check_mesh(view_of(file.mesh));
    CHECK(check.closed);
    CHECK(check.genus == 1);
  }
}

TEST_CASE("meshes of extreme coordinates", "[mesh_io][round trip]") {
  Mesh mesh = tetrahedron();
  mesh.V.row(1) << std::numeric_limits<double>::max(), std::numeric_limits<double>::denorm_min(),
      -0.0;
  mesh.V.row(2) << 1e-300, -1.7976931348623157e308, 0.1;
  for (const MeshFormat format :
       {MeshFormat::off, MeshFormat::obj, MeshFormat::ply, MeshFormat::vtp}) {
    INFO(to_string(format));
    const MeshFile file = parse(bytes_of(mesh, format), format);
    CHECK(file.mesh.V == mesh.V);
    CHECK(std::signbit(file.mesh.V(1, 2)));
  }
  CHECK_THROWS_WITH(bytes_of(mesh, MeshFormat::stl),
                    Contains("STL holds coordinates up to 3.4e38"));
}

TEST_CASE("an empty mesh is a valid file of every format", "[mesh_io][round trip]") {
  Mesh mesh;
  mesh.space = "LPS";
  for (const MeshFormat format : kFormats) {
    for (const MeshEncoding encoding : {MeshEncoding::binary, MeshEncoding::ascii}) {
      INFO(to_string(format));
      const MeshFile file = parse(bytes_of(mesh, format, encoding), format);
      CHECK(file.mesh.V.rows() == 0);
      CHECK(file.mesh.F.rows() == 0);
      CHECK(file.mesh.space == "LPS");
    }
  }
}

TEST_CASE("64-bit ids are written as 32-bit ones are", "[mesh_io]") {
  const Mesh mesh = irrational_torus();
  const std::vector<std::int64_t> ids(mesh.F.data(), mesh.F.data() + mesh.F.size());
  MeshView wide = view_of(mesh);
  wide.indices = ids.data();
  const TemporaryFolder folder;
  for (const MeshFormat format : kFormats) {
    INFO(to_string(format));
    const std::string path = (folder / "wide").string();
    OutputFile file(path);
    write_mesh(file, format, wide);
    file.commit();
    const MeshFile again = parse(slurp(path), format);
    if (format != MeshFormat::stl) CHECK(again.mesh.F == mesh.F);
    if (format != MeshFormat::vtp) CHECK(slurp(path) == bytes_of(mesh, format));
  }
}

TEST_CASE("formats say when they cannot number the vertices or triangles", "[mesh_io][error]") {
  // The counts alone decide; nothing of this size is read.
  MeshView huge;
  huge.vertex_count = (std::int64_t{1} << 32) + 1;
  huge.triangle_count = std::int64_t{1} << 32;
  huge.indices = static_cast<const std::int64_t*>(nullptr);
  const TemporaryFolder folder;
  {
    OutputFile file((folder / "a.ply").string());
    CHECK_THROWS_WITH(write_mesh(file, MeshFormat::ply, huge),
                      Contains("PLY numbers at most 4294967296 vertices, the mesh has 4294967297"));
  }
  {
    OutputFile file((folder / "a.stl").string());
    CHECK_THROWS_WITH(write_mesh(file, MeshFormat::stl, huge),
                      Contains("STL holds at most 4294967295 triangles, the mesh has 4294967296"));
  }
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("the space stands where 3D Slicer looks for it", "[mesh_io]") {
  Mesh mesh = tetrahedron();
  mesh.space = "LPS";
  CHECK_THAT(bytes_of(mesh, MeshFormat::ply), Contains("\ncomment SPACE=LPS\n"));
  CHECK_THAT(bytes_of(mesh, MeshFormat::obj), Contains("# SPACE=LPS\n"));
  CHECK_THAT(bytes_of(mesh, MeshFormat::stl).substr(0, 80), Contains("SPACE=LPS"));
  CHECK(bytes_of(mesh, MeshFormat::stl).substr(0, 5) != "solid");
  CHECK_THAT(bytes_of(mesh, MeshFormat::stl, MeshEncoding::ascii), Contains("SPACE=LPS\n"));
  CHECK_THAT(bytes_of(mesh, MeshFormat::vtp), Contains("SPACE"));
  mesh.space = "RAS";
  mesh.comments = {"SPACE=LPS"};  // what was once true does not contradict
  CHECK_THAT(bytes_of(mesh, MeshFormat::ply), Contains("SPACE=RAS") && !Contains("SPACE=LPS"));
}

TEST_CASE("arrays go to VTP and come back", "[mesh_io]") {
  Mesh mesh = cube();
  mesh.triangle_arrays.push_back({"kind", std::vector<std::uint8_t>(12, 2)});
  mesh.vertex_arrays.push_back({"isovalue", std::vector<double>(8, 226.5)});
  const MeshFile file = parse(bytes_of(mesh, MeshFormat::vtp), MeshFormat::vtp);
  REQUIRE(file.mesh.triangle_arrays.size() == 1);
  CHECK(file.mesh.triangle_arrays[0].name == "kind");
  CHECK(std::get<std::vector<double>>(file.mesh.triangle_arrays[0].values) ==
        std::vector<double>(12, 2.0));
  REQUIRE(file.mesh.vertex_arrays.size() == 1);
  CHECK(std::get<std::vector<double>>(file.mesh.vertex_arrays[0].values) ==
        std::vector<double>(8, 226.5));
}

TEST_CASE("polygons become fans and are counted", "[mesh_io]") {
  const std::string off = "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 2 2\n5 0 1 4 2 3\n3 0 1 2\n";
  const MeshFile file = parse(off, MeshFormat::off);
  CHECK(file.polygons == 1);
  REQUIRE(file.mesh.F.rows() == 4);
  CHECK(file.mesh.F.row(0) == Eigen::RowVector3i(0, 1, 4));
  CHECK(file.mesh.F.row(1) == Eigen::RowVector3i(0, 4, 2));
  CHECK(file.mesh.F.row(2) == Eigen::RowVector3i(0, 2, 3));
  REQUIRE(file.warnings.size() == 1);
  CHECK(file.warnings[0] == "1 faces of more than three vertices were made into fans of triangles");
  const MeshFile quad =
      parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2\n", MeshFormat::obj);
  CHECK(quad.polygons == 1);
  CHECK(quad.mesh.F.rows() == 2);
  REQUIRE(quad.warnings.size() == 2);
  CHECK(quad.warnings[1] == "1 faces of fewer than three vertices were left out");
}

TEST_CASE("OFF as it is found", "[mesh_io][off]") {
  const auto rows = [](const std::string& text) {
    const MeshFile file = parse(text, MeshFormat::off);
    CHECK(file.mesh.V.rows() == 3);
    CHECK(file.mesh.V(2, 1) == 1.0);
    return file.mesh.F.rows();
  };
  CHECK(rows("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n") == 1);
  CHECK(rows("OFF 3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n") == 1);
  CHECK(rows("OFF3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2") == 1);
  CHECK(
      rows("# a comment\nOFF # another\n\n3 1 0\n# more\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n") ==
      1);
  CHECK(rows("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n0 1 0 .1 .2 .3 1\n3 0 1 2\n") == 1);
  CHECK(rows("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n") == 1);
  CHECK(rows("OFF\n3 1 0\n0 0 0\n1e0 +0 0\n0 1. 0\n3 0 1 2\n") == 1);
  CHECK(rows("OFF\n3 0 0\n0 0 0\n1 0 1e-400\n0 1 0\n") == 0);  // underflow is zero
  const MeshFile file = parse("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\nextra\n", MeshFormat::off);
  REQUIRE(file.warnings.size() == 1);
  CHECK(file.warnings[0] == "text after the last face, from line 7 on, was not read");
}

TEST_CASE("malformed OFF", "[mesh_io][off][error]") {
  const auto error = [](const std::string& text) { return error_of(text, MeshFormat::off); };
  CHECK_THAT(error("PLY\n"), Contains("line 1: expected the key OFF, found 'PLY'"));
  CHECK_THAT(error("# only a comment\n"),
             Contains("expected the key OFF, found the end of the file"));
  CHECK_THAT(error("4OFF\n1 0 0\n0 0 0 0\n"),
             Contains("expected vertices of three coordinates (OFF), found '4OFF'"));
  CHECK_THAT(error("OFF BINARY\n"), Contains("binary OFF is not supported"));
  CHECK_THAT(error("OFF\nthree 1 0\n"),
             Contains("line 2: expected the number of vertices (an integer), found 'three'"));
  CHECK_THAT(error("OFF\n-3 1 0\n"), Contains("the number of vertices is -3"));
  CHECK_THAT(error("OFF\n2000000000 1 0\n0 0 0\n"),
             Contains("the number of vertices is 2000000000, but the"));
  CHECK_THAT(error("OFF\n1 2000000000 0\n0 0 0\n"),
             Contains("the number of faces is 2000000000, but the"));
  CHECK_THAT(error("OFF99999999999\n"),
             Contains("expected the key OFF and the number of vertices"));
  CHECK_THAT(error("OFF\n2 0 0\n0 0 0\n1 0\n"),
             Contains("line 5: expected a coordinate, found the end of the file"));
  CHECK_THAT(error("OFF\n1 0 0\n0 nan 0\n"),
             Contains("line 3: expected a coordinate (a finite number), found 'nan'"));
  CHECK_THAT(error("OFF\n1 0 0\n0 inf 0\n"), Contains("found 'inf'"));
  CHECK_THAT(error("OFF\n1 0 0\n0 1e999 0\n"), Contains("found '1e999'"));
  CHECK_THAT(error("OFF\n1 0 0\n0 0,5 0\n"), Contains("found '0,5'"));
  CHECK_THAT(error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
             Contains("line 6: expected a vertex index from 0 to 2, found 3"));
  CHECK_THAT(error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 -1 2\n"),
             Contains("from 0 to 2, found -1"));
  CHECK_THAT(error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n"),
             Contains("expected a vertex index, found the end of the file"));
  CHECK_THAT(error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n1000000 0 1 2\n"),
             Contains("a face of 1000000 vertices does not fit the file"));
  CHECK_THAT(error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"),
             Contains("a face of -3 vertices"));
}

TEST_CASE("OBJ as it is found", "[mesh_io][obj]") {
  const MeshFile file = parse(
      "# SPACE=RAS\nmtllib a.mtl\no thing\nf 1 2 3\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0 0.5 0.5 0.5\nvn "
      "0 0 1\nvt 0 0\ng part\n"
      "usemtl x\ns off\nf 1/1/1 2/1/1 3/1/1\nf -3//1 -2//1 -1//1\nf 1/1 2/1 \\\n3/1\nl 1 2\n",
      MeshFormat::obj);
  CHECK(file.mesh.space == "RAS");
  REQUIRE(file.mesh.V.rows() == 3);
  REQUIRE(file.mesh.F.rows() == 4);
  for (Eigen::Index t = 0; t < 4; ++t) CHECK(file.mesh.F.row(t) == Eigen::RowVector3i(0, 1, 2));
}

TEST_CASE("malformed OBJ", "[mesh_io][obj][error]") {
  const auto error = [](const std::string& text) { return error_of(text, MeshFormat::obj); };
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  CHECK_THAT(error(vertices + "f 1 2 4\nf 1 2 3\n"),
             Contains("line 4: expected a vertex index from 1 to 3, found 4"));
  CHECK_THAT(error(vertices + "f 0 1 2\n"),
             Contains("line 4: expected a vertex index from 1 on, or from -1 to -3, found 0"));
  CHECK_THAT(error(vertices + "f -4 1 2\n"), Contains("found -4"));
  CHECK_THAT(error(vertices + "f a b c\n"), Contains("line 4: expected a vertex index, found 'a'"));
  CHECK_THAT(error("v 0 nan 0\n"),
             Contains("line 1: expected a coordinate (a finite number), found 'nan'"));
  CHECK_THAT(error("v 0 0\nf 1 1 1\n"),
             Contains("expected a coordinate (a finite number), found 'f'"));
  CHECK_THAT(
      error("solid x\n"),
      Contains("line 1: expected a statement of the OBJ format (v, f, vn …), found 'solid'"));
  CHECK_THAT(error(std::string("\x7f"
                               "ELF\x01\x02\x00\x00",
                               8)),
             Contains("found '?ELF"));
}

const std::string kPlyHead =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_CASE("PLY as it is found", "[mesh_io][ply]") {
  // Properties in another order and type, further elements and lists before, between and after.
  const MeshFile file = parse(
      "ply\r\nformat ascii 1.0\r\nobj_info made by hand\r\nelement camera 1\r\nproperty list uchar "
      "float matrix\r\n"
      "element vertex 3\r\nproperty double z\r\nproperty uchar red\r\nproperty short y\r\nproperty "
      "int8 x\r\n"
      "element face 1\r\nproperty list uchar float texcoord\r\nproperty list uint8 uint32 "
      "vertex_index\r\nproperty float q\r\n"
      "element edge 1\r\nproperty int a\r\nend_header\r\n"
      "2 1 2\r\n0.5 255 0 0\r\n0.5 255 0 1\r\n0.5 255 1 0\r\n6 0 0 1 1 2 2 3 0 1 2 0.5\r\n7\r\n",
      MeshFormat::ply);
  REQUIRE(file.mesh.V.rows() == 3);
  CHECK(file.mesh.V.row(2) == Eigen::RowVector3d(0, 1, 0.5));
  REQUIRE(file.mesh.F.rows() == 1);
  CHECK(file.mesh.F.row(0) == Eigen::RowVector3i(0, 1, 2));
  // A cloud of points is a mesh without triangles.
  CHECK(parse("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
              "y\nproperty float z\nend_header\n1 2 3\n",
              MeshFormat::ply)
            .mesh.V.rows() == 1);
}

TEST_CASE("malformed PLY", "[mesh_io][ply][error]") {
  const auto error = [](const std::string& text) { return error_of(text, MeshFormat::ply); };
  CHECK_THAT(error("plyx\n"), Contains("line 1: expected 'ply'"));
  CHECK_THAT(error("ply\nformat ascii 1.0\n"),
             Contains("expected a header line or end_header, found the end of the file"));
  CHECK_THAT(
      error("ply\nformat utf8 1.0\n"),
      Contains("line 2: expected ascii, binary_little_endian or binary_big_endian, found 'utf8'"));
  CHECK_THAT(error("ply\nelement vertex 0\nproperty float x\nproperty float y\nproperty float "
                   "z\nend_header\n"),
             Contains("no format line"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nproperty float x\n"),
             Contains("a property stands before the first element"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement vertex -1\n"),
             Contains("element vertex has the count -1"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\n"),
             Contains("expected a type (char, uchar, short … double), found 'real'"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int x\n"),
             Contains("the length of a list has to be an integer"));
  CHECK_THAT(
      error("ply\nformat ascii 1.0\nvertices 3\n"),
      Contains("expected format, element, property, comment or end_header, found 'vertices'"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement vertex 5\nend_header\n"),
             Contains("element vertex has no properties"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                   "y\nend_header\n1 2\n"),
             Contains("element vertex has no property z"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty list uchar "
                   "float y\nproperty float z\nend_header\n"),
             Contains("property y of element vertex is a list, expected a number"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float "
                   "y\nproperty float z\nelement face 0\n"
                   "property int a\nend_header\n"),
             Contains("element face has no list property vertex_indices"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement face 0\nproperty list uchar int "
                   "vertex_indices\nend_header\n"),
             Contains("element face stands before element vertex"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement thing 0\nproperty int a\nend_header\n"),
             Contains("the header has no element vertex"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float "
                   "y\nproperty float z\n"
                   "element tristrips 0\nproperty list int int vertex_indices\nend_header\n"),
             Contains("triangle strips are not supported"));
  // Counts that lie, also beyond 32 and 64 bits of bytes.
  CHECK_THAT(error("ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\nproperty "
                   "double x\nproperty double y\n"
                   "property double z\nend_header\n"),
             Contains("the header announces 48000000000 bytes or more of data, but 0 follow it"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement vertex 9000000000000000000\nproperty float "
                   "x\nend_header\n"),
             Contains("expected at most 2147483647"));
  CHECK_THAT(error("ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n"),
             Contains("found '99999999999999999999'"));
  CHECK_THAT(error(kPlyHead + "0 0 0\n1 0 0\n0 x 0\n3 0 1 2\n"),
             Contains("line 12: expected y (a finite number), found 'x'"));
  CHECK_THAT(error(kPlyHead + "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n"), Contains("found 'nan'"));
  CHECK_THAT(error(kPlyHead + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
             Contains("face 0: expected a vertex index from 0 to 2, found 3"));
  CHECK_THAT(error(kPlyHead + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n"), Contains("found -2"));
  CHECK_THAT(error(kPlyHead + "0 0 0\n1 0 0\n0 1 0\n200 0 1 2\n"),
             Contains("a list vertex_indices of 200 values does not fit the file"));
  CHECK_THAT(error(kPlyHead + "0 0 0\n1 0 0\n0 1 0\n-1 0 1 2\n"),
             Contains("a list vertex_indices of -1 values"));
  CHECK_THAT(error(kPlyHead + "0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), Contains("expected vertex_indices"));
  // Binary: the last byte is missing; a NaN; an index out of range.
  std::string binary = bytes_of(tetrahedron(), MeshFormat::ply);
  CHECK_THAT(error(binary.substr(0, binary.size() - 1)),
             Contains("a list vertex_indices of 3 values does not fit the file"));
  CHECK_THAT(error(binary.substr(0, binary.size() - 60)), Contains("bytes or more of data, but"));
  CHECK(parse(binary + "xyz", MeshFormat::ply).warnings.at(0) ==
        "3 bytes after the last element were not read");
  const std::size_t body = binary.find("end_header\n") + 11;
  std::string bad = binary;
  const double nan = std::nan("");
  std::memcpy(&bad[body + 8 * 4], &nan, 8);
  CHECK_THAT(error(bad), Contains("expected a finite coordinate y of vertex 1"));
  bad = binary;
  bad[body + 4 * 24 + 1 + 4] = 77;
  CHECK_THAT(error(bad), Contains("face 0: expected a vertex index from 0 to 3, found 77"));
}

TEST_CASE("malformed STL", "[mesh_io][stl][error]") {
  const auto error = [](const std::string& text) { return error_of(text, MeshFormat::stl); };
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  CHECK(
      parse("solid a b\n" + facet + "endsolid a b\nsolid\n" + facet + "endsolid\n", MeshFormat::stl)
          .mesh.F.rows() == 2);
  CHECK(parse("SOLID\n" + facet + "ENDSOLID", MeshFormat::stl).mesh.V.rows() == 3);
  CHECK_THAT(error("hello"), Contains("expected an STL file: text that begins with 'solid', or 84 "
                                      "bytes or more; found 5 bytes"));
  CHECK_THAT(error("solid a\n" + facet),
             Contains("expected facet or endsolid, found the end of the file"));
  CHECK_THAT(error("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0\nendloop\n"),
             Contains("line 6: expected a coordinate (a finite number), found 'endloop'"));
  CHECK_THAT(error("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 nan 0\n"),
             Contains("found 'nan'"));
  CHECK_THAT(error("solid a\nfacets\n"),
             Contains("line 2: expected facet or endsolid, found 'facets'"));
  CHECK_THAT(error("solid a\n" + facet + "endsolid a\nrubbish\n"),
             Contains("line 10: expected solid, found 'rubbish'"));
  std::string binary = bytes_of(tetrahedron(), MeshFormat::stl);
  CHECK_THAT(
      error(binary.substr(0, binary.size() - 1)),
      Contains(
          "byte 80: the header announces 4 triangles (284 bytes), but the file has 283 bytes"));
  std::string lying = binary;
  lying[83] = '\x40';
  CHECK_THAT(error(lying), Contains("the header announces 1073741828 triangles"));
  lying[83] = '\xff';
  CHECK_THAT(error(lying), Contains("has 4278190084 triangles, expected at most 2147483647"));
  CHECK(parse(binary + "xy", MeshFormat::stl).warnings.at(0) ==
        "2 bytes after the last triangle were not read");
  std::string bad = binary;
  const float infinity = std::numeric_limits<float>::infinity();
  std::memcpy(&bad[84 + 50 + 12 + 16], &infinity, 4);
  CHECK_THAT(error(bad), Contains("byte 162: expected a finite coordinate of triangle 1"));
  std::string solid = binary;
  solid.replace(0, 5, "solid");
  CHECK(parse(solid, MeshFormat::stl).mesh.F.rows() == 4);
}

TEST_CASE("malformed VTP", "[mesh_io][vtp][error]") {
  const auto error = [](const std::string& text) { return error_of(text, MeshFormat::vtp); };
  CHECK_THAT(error("hello"), Contains("expected a VTK XML file of type PolyData"));
  CHECK_THAT(error("<VTKFile type=\"ImageData\"></VTKFile>"),
             Contains("expected a VTK XML file of type PolyData"));
  CHECK_THAT(error("<VTKFile type=\"PolyData\" version=\"0.1\"><PolyData>"),
             Contains("is not a whole VTK PolyData file"));
  const std::string head =
      "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData><Piece "
      "NumberOfPoints=\"";
  const auto ascii = [&head](const std::string& counts, const std::string& points,
                             const std::string& ids, const std::string& offsets) {
    return head + counts +
           "\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" +
           points +
           "</DataArray></Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\" "
           "format=\"ascii\">" +
           ids + "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" +
           offsets + "</DataArray></Polys></Piece></PolyData></VTKFile>";
  };
  const std::string counts = "3\" NumberOfPolys=\"1", points = "0 0 0 1 0 0 0 1 0";
  CHECK(parse(ascii(counts, points, "0 1 2", "3"), MeshFormat::vtp).mesh.F.rows() == 1);
  CHECK_THAT(error(ascii(counts, points, "0 1 3", "3")),
             Contains("polygon 0: expected a point index from 0 to 2, found 3"));
  CHECK_THAT(error(ascii(counts, points, "0 -1 2", "3")), Contains("found -1"));
  CHECK_THAT(error(ascii(counts, "0 0 0 1 nan 0 0 1 0", "0 1 2", "3")),
             Contains("expected finite coordinates of point 1") ||
                 Contains("is not a whole VTK PolyData file"));
  CHECK_THAT(error(ascii("2000000000\" NumberOfPolys=\"1", points, "0 1 2", "3")),
             Contains("NumberOfPoints is 2000000000, more than"));
  CHECK_THAT(error(ascii("3\" NumberOfPolys=\"99999999999", points, "0 1 2", "3")),
             Contains("NumberOfPolys is 99999999999, more than"));
  CHECK_THAT(error(ascii("-3\" NumberOfPolys=\"1", points, "0 1 2", "3")),
             Contains("NumberOfPoints is -3"));
  const std::string whole = bytes_of(torus(9, 7), MeshFormat::vtp);
  for (const std::size_t cut : {whole.size() / 4, whole.size() / 2, whole.size() - 200}) {
    INFO(cut);
    CHECK_THAT(error(whole.substr(0, cut)), Contains("is not a whole VTK PolyData file"));
  }
}

// Whatever the bytes, a reader returns a mesh that holds together or a FileError.
void read_anything(const std::string& bytes, MeshFormat format) {
  try {
    const MeshFile file = parse_mesh(bytes, format, "bytes");
    REQUIRE(file.mesh.V.allFinite());
    if (file.mesh.F.size() > 0) {
      REQUIRE(file.mesh.F.minCoeff() >= 0);
      REQUIRE(file.mesh.F.maxCoeff() < file.mesh.V.rows());
    }
  } catch (const FileError&) {
    SUCCEED();
  }
}

TEST_CASE("files cut at any byte, and damaged ones", "[mesh_io][error][fuzz]") {
  const Mesh mesh = tetrahedron();
  std::mt19937 random(11);
  for (const MeshFormat format : kFormats) {
    for (const MeshEncoding encoding :
         {MeshEncoding::binary, MeshEncoding::ascii, MeshEncoding::binary_big_endian}) {
      const std::string whole = bytes_of(mesh, format, encoding);
      INFO(to_string(format));
      const std::size_t step = format == MeshFormat::vtp ? 37 : 1;
      for (std::size_t size = 1; size < whole.size(); size += step)
        read_anything(whole.substr(0, size), format);
      const int rounds = format == MeshFormat::vtp ? 40 : 2000;
      for (int round = 0; round < rounds; ++round) {
        std::string damaged = whole;
        for (unsigned i = 0; i <= random() % 4; ++i)
          damaged[random() % damaged.size()] = static_cast<char>(random());
        read_anything(damaged, format);
      }
    }
  }
}

TEST_CASE("files that cannot be read", "[mesh_io][error]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_mesh((folder / "none.ply").string()),
                    Contains("none.ply: cannot be opened: No such file or directory"));
  CHECK_THROWS_WITH(read_mesh((folder / "none.xyz").string()),
                    Contains("unknown extension '.xyz', expected .ply, .obj, .off, .stl or .vtp"));
  CHECK_THROWS_WITH(read_mesh((folder / "none").string()),
                    Contains("has no extension, expected .ply"));
  spill(folder / "empty.stl", "");
  CHECK_THROWS_WITH(read_mesh((folder / "empty.stl").string()),
                    Contains("is empty, expected a mesh"));
  fs::create_directory(folder / "dir.off");
  CHECK_THROWS_WITH(read_mesh((folder / "dir.off").string()),
                    Contains("is a directory, expected a mesh file"));
  spill(folder / "Tetra.OFF", bytes_of(tetrahedron(), MeshFormat::off));
  CHECK(read_mesh((folder / "Tetra.OFF").string()).mesh.F.rows() == 4);
}

TEST_CASE("an output file appears whole or not at all", "[output_file]") {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.txt").string();
  {
    OutputFile file(path);
    file.write("half");
  }
  CHECK(fs::is_empty(folder.path()));
  spill(path, "before");
  {
    OutputFile file(path);
    file.write("after");
    file.finish();
    CHECK(slurp(path) == "before");
    file.commit();
  }
  CHECK(slurp(path) == "after");
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 1);
  // A link stays a link, and its target is replaced.
  fs::create_symlink(path, folder / "link.txt");
  {
    OutputFile file((folder / "link.txt").string());
    file.write("through");
    file.commit();
  }
  CHECK(fs::is_symlink(folder / "link.txt"));
  CHECK(slurp(path) == "through");
}

TEST_CASE("output that cannot be written is an error and leaves nothing", "[output_file][error]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(OutputFile((folder / "no/dir/a.ply").string()),
                    Contains("a.ply: the directory") && Contains("does not exist"));
  spill(folder / "file", "x");
  CHECK_THROWS_WITH(OutputFile((folder / "file/a.ply").string()),
                    Contains("is not a directory") || Contains("does not exist"));
  CHECK_THROWS_WITH(OutputFile(folder.path().string()),
                    Contains("is a directory, expected the name of a file to write"));
  CHECK_THROWS_WITH(OutputFile(""), Contains("the name is empty"));
  if (geteuid() != 0) {
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    CHECK_THROWS_WITH(OutputFile((folder / "a.ply").string()),
                      Contains("cannot be written: Permission denied"));
    fs::permissions(folder.path(), fs::perms::owner_all);
  }
  CHECK_THROWS_WITH(OutputFile("/proc/a.ply"),
                    Contains("a.ply: the directory /proc cannot be written"));
}

TEST_CASE("a full disk is an error for every format", "[output_file][error]") {
  const TemporaryFolder folder;
  const Mesh mesh = torus(60, 40);
  for (const MeshFormat format : kFormats) {
    INFO(to_string(format));
    fs::create_symlink("/dev/full", folder / "full");
    CHECK_THROWS_AS(
        [&] {
          OutputFile file((folder / "full").string());
          write_mesh(file, format, view_of(mesh));
          file.commit();
        }(),
        FileError);
    fs::remove(folder / "full");
  }
  // A file size limit stands for a disk that fills while the file is written.
  install_interrupt_handler();  // ignores SIGXFSZ
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  for (const MeshFormat format : kFormats) {
    INFO(to_string(format));
    rlimit small = before;
    small.rlim_cur = 20000;
    setrlimit(RLIMIT_FSIZE, &small);
    std::string message;
    try {
      OutputFile file((folder / "a").string());
      write_mesh(file, format, view_of(mesh));
      file.commit();
    } catch (const FileError& error) {
      message = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    CHECK_THAT(message, Contains("cannot be written"));
    CHECK(fs::is_empty(folder.path()));
  }
}

TEST_CASE("300,000 triangles of OFF are read in well under a second", "[mesh_io][speed]") {
  const std::string text = bytes_of(torus(500, 300), MeshFormat::off);
  const auto start = std::chrono::steady_clock::now();
  const MeshFile file = parse(text, MeshFormat::off);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  CHECK(file.mesh.F.rows() == 300000);
  WARN("300,000 triangles of OFF parsed in " << seconds << " s");
}

TEST_CASE("real OFF files", "[mesh_io][data]") {
  const auto folder = test_data("topology_cases");
  if (!folder) {
    WARN("SHAPE3D_DATA is not set: real files are not read");
    return;
  }
  // stats.tsv holds counts made by another program.
  std::ifstream table(*folder / "stats.tsv");
  std::string line, word;
  std::getline(table, line);
  std::istringstream head(line);
  std::vector<std::string> columns;
  while (head >> word) columns.push_back(word);
  int files = 0;
  while (std::getline(table, line)) {
    std::istringstream cells(line);
    std::map<std::string, std::string> row;
    for (const std::string& column : columns) cells >> row[column];
    INFO(line);
    const auto number = [&row](const char* column) { return std::stoll(row.at(column)); };
    const MeshFile file = read_mesh((*folder / row.at("file")).string());
    const MeshCheck check = check_mesh(view_of(file.mesh));
    CHECK(check.vertices == number("V"));
    CHECK(check.triangles == number("tri"));
    CHECK(check.closed == (number("closed") == 1));
    CHECK(check.components == number("comp"));
    CHECK(check.euler == number("chi"));
    CHECK(check.boundary_edges == number("bndE"));
    CHECK(check.nonmanifold_edges == number("nmE"));
    CHECK(check.nonmanifold_vertices == number("nmV"));
    CHECK(check.degenerate_triangles == number("degen"));
    CHECK(check.unreferenced_vertices == number("unref"));
    CHECK(check.oriented == (number("orient") == 1 && number("closed") == 1));
    if (check.volume) CHECK(*check.volume == Approx(std::stod(row.at("vol"))).epsilon(1e-3));
    if (check.genus) CHECK(static_cast<double>(*check.genus) == std::stod(row.at("genus")));
    ++files;
  }
  CHECK(files >= 14);
}

}  // namespace
