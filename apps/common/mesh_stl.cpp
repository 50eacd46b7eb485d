#include <cctype>

#include <Eigen/Geometry>

#include "mesh_formats.hpp"
#include "position_table.hpp"
#include "text_scanner.hpp"

namespace shape3d::apps::formats {
namespace {

constexpr std::size_t kHeaderSize = 80, kTriangleSize = 50;

bool same_word(std::string_view word, std::string_view lower_case) {
  return word.size() == lower_case.size() &&
         std::equal(word.begin(), word.end(), lower_case.begin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == b;
         });
}

std::uint32_t load_count(std::string_view bytes) {
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data()) + kHeaderSize;
  return at[0] | std::uint32_t{at[1]} << 8 | std::uint32_t{at[2]} << 16 |
         std::uint32_t{at[3]} << 24;
}

float load_float(const char* at) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(at);
  const std::uint32_t bits = bytes[0] | std::uint32_t{bytes[1]} << 8 |
                             std::uint32_t{bytes[2]} << 16 | std::uint32_t{bytes[3]} << 24;
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

MeshFile parse_binary(std::string_view bytes, const std::string& name) {
  MeshFile file;
  file.format = MeshFormat::stl;
  file.encoding = "binary little endian";
  std::string_view header = bytes.substr(0, kHeaderSize);
  header = header.substr(0, header.find('\0'));
  while (!header.empty() && header.back() == ' ') header.remove_suffix(1);
  if (!header.empty()) file.mesh.comments.emplace_back(header);
  find_space(file.mesh);
  const std::int64_t triangles = load_count(bytes);
  if (triangles > kMaxCount)
    throw FileError(name,
                    "has " + std::to_string(triangles) + " triangles, expected at most 2147483647");
  const std::size_t needed = kHeaderSize + 4 + static_cast<std::size_t>(triangles) * kTriangleSize;
  if (bytes.size() < needed) {
    throw FileError(name, "byte 80: the header announces " + std::to_string(triangles) +
                              " triangles (" + std::to_string(needed) +
                              " bytes), but the file has " + std::to_string(bytes.size()) +
                              " bytes");
  }
  if (bytes.size() > needed) {
    file.warnings.push_back(std::to_string(bytes.size() - needed) +
                            " bytes after the last triangle were not read");
  }
  std::vector<double> positions;
  std::vector<std::int32_t> indices(static_cast<std::size_t>(3 * triangles));
  PositionTable<double> table(positions);
  for (std::int64_t t = 0; t < triangles; ++t) {
    const std::size_t start =
        kHeaderSize + 4 + static_cast<std::size_t>(t) * kTriangleSize + 12;  // past the normal
    for (std::size_t corner = 0; corner < 3; ++corner) {
      std::array<double, 3> p;
      for (std::size_t c = 0; c < 3; ++c) {
        p[c] = load_float(bytes.data() + start + 12 * corner + 4 * c);
        if (!std::isfinite(p[c])) {
          throw FileError(name, "byte " + std::to_string(start + 12 * corner + 4 * c) +
                                    ": expected a finite coordinate of triangle " +
                                    std::to_string(t));
        }
      }
      indices[static_cast<std::size_t>(3 * t) + corner] = static_cast<std::int32_t>(table.id_of(p));
    }
    if (table.size() > kMaxCount)
      throw FileError(name, "has more than 2147483647 different vertices");
  }
  store(file.mesh, positions, indices, name);
  return file;
}

MeshFile parse_ascii(std::string_view bytes, const std::string& name) {
  MeshFile file;
  file.format = MeshFormat::stl;
  file.encoding = "ascii";
  std::vector<double> positions;
  std::vector<std::int32_t> indices;
  FaceCollector collector(indices);
  PositionTable<double> table(positions);
  TextScanner scanner(bytes, name, '\0');
  const auto expect = [&scanner](std::string_view keyword) {
    const std::string_view word = scanner.word(keyword);
    if (!same_word(word, keyword)) scanner.fail(keyword, word);
  };
  while (scanner.skip_space()) {
    expect("solid");
    if (const std::string_view title = scanner.rest_of_line(); !title.empty())
      file.mesh.comments.emplace_back(title);
    while (true) {
      const std::string_view word = scanner.word("facet or endsolid");
      if (same_word(word, "endsolid")) {
        scanner.rest_of_line();
        break;
      }
      if (!same_word(word, "facet")) scanner.fail("facet or endsolid", word);
      expect("normal");
      for (int c = 0; c < 3; ++c) scanner.word("a component of a normal");
      expect("outer");
      expect("loop");
      std::vector<std::int64_t> polygon;
      while (true) {
        const std::string_view next = scanner.word("vertex or endloop");
        if (same_word(next, "endloop")) break;
        if (!same_word(next, "vertex")) scanner.fail("vertex or endloop", next);
        std::array<double, 3> p;
        for (double& c : p) c = scanner.number("a coordinate");
        polygon.push_back(table.id_of(p));
      }
      expect("endfacet");
      collector.add(polygon.data(), polygon.size());
    }
  }
  collector.report(file);
  find_space(file.mesh);
  store(file.mesh, positions, indices, name);
  return file;
}

std::array<float, 3> to_float(const OutputFile& file, const double* p) {
  std::array<float, 3> rounded;
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::abs(p[c]) > static_cast<double>(std::numeric_limits<float>::max())) {
      throw FileError(file.path(),
                      "STL holds coordinates up to 3.4e38, the mesh has " + std::to_string(p[c]));
    }
    rounded[c] = static_cast<float>(p[c]);
  }
  return rounded;
}

std::array<float, 3> normal_of(const double* a, const double* b, const double* c) {
  const Eigen::Vector3d pa(a[0], a[1], a[2]), pb(b[0], b[1], b[2]), pc(c[0], c[1], c[2]);
  const Eigen::Vector3d normal = (pb - pa).cross(pc - pa).stableNormalized();
  if (!normal.allFinite()) return {0.0F, 0.0F, 0.0F};
  return {static_cast<float>(normal[0]), static_cast<float>(normal[1]),
          static_cast<float>(normal[2])};
}

std::string title_of(const MeshView& mesh) {
  std::string title = "Shape3D";
  for (const std::string& line : comment_lines(mesh)) {
    if (line.find("SPACE=") == 0) title += " " + line;
  }
  return title;
}

void store_little(char* at, std::uint32_t bits) {
  for (int i = 0; i < 4; ++i) at[i] = static_cast<char>(bits >> (8 * i) & 255);
}

}  // namespace

MeshFile parse_stl(std::string_view bytes, const std::string& name) {
  const bool has_header = bytes.size() >= kHeaderSize + 4;
  if (has_header &&
      bytes.size() == kHeaderSize + 4 + std::size_t{load_count(bytes)} * kTriangleSize) {
    return parse_binary(bytes, name);
  }
  // Binary headers may begin with "solid" too; a zero byte tells them from text.
  TextScanner scanner(bytes.substr(0, std::min<std::size_t>(bytes.size(), 4096)), name, '\0');
  const bool says_solid = scanner.skip_space() && same_word(scanner.word("").substr(0, 5), "solid");
  const bool has_zero = bytes.substr(0, 512).find('\0') != std::string_view::npos;
  if (says_solid && !has_zero) return parse_ascii(bytes, name);
  if (has_header) return parse_binary(bytes, name);
  throw FileError(
      name, "expected an STL file: text that begins with 'solid', or 84 bytes or more; found " +
                std::to_string(bytes.size()) + " bytes");
}

void write_stl(OutputFile& file, const MeshView& mesh, MeshEncoding encoding) {
  if (mesh.triangle_count > std::int64_t{std::numeric_limits<std::uint32_t>::max()}) {
    throw FileError(file.path(), "STL holds at most 4294967295 triangles, the mesh has " +
                                     std::to_string(mesh.triangle_count) +
                                     "; PLY, OBJ, OFF and VTP hold more");
  }
  const std::string title = title_of(mesh);
  if (encoding == MeshEncoding::ascii) {
    file.write("solid " + title + "\n");
    for_each_triangle(mesh, [&](const std::array<std::int64_t, 3>& ids) {
      const auto write_vector = [&file](const auto* v) {
        for (int c = 0; c < 3; ++c) {
          file.write_char(' ');
          file.write_number(v[c]);
        }
        file.write_char('\n');
      };
      file.write("facet normal");
      write_vector(normal_of(mesh.positions + 3 * ids[0], mesh.positions + 3 * ids[1],
                             mesh.positions + 3 * ids[2])
                       .data());
      file.write(" outer loop\n");
      for (const std::int64_t id : ids) {
        file.write("  vertex");
        write_vector(mesh.positions + 3 * id);
      }
      file.write(" endloop\nendfacet\n");
    });
    file.write("endsolid " + title + "\n");
    return;
  }
  std::string header = title;
  header.resize(kHeaderSize, ' ');
  file.write(header);
  std::array<char, kTriangleSize> record{};
  store_little(record.data(), static_cast<std::uint32_t>(mesh.triangle_count));
  file.write(record.data(), 4);
  for_each_triangle(mesh, [&](const std::array<std::int64_t, 3>& ids) {
    char* at = record.data();
    const auto put = [&at](const std::array<float, 3>& v) {
      for (const float c : v) {
        std::uint32_t bits;
        std::memcpy(&bits, &c, sizeof bits);
        store_little(at, bits);
        at += 4;
      }
    };
    put(normal_of(mesh.positions + 3 * ids[0], mesh.positions + 3 * ids[1],
                  mesh.positions + 3 * ids[2]));
    for (const std::int64_t id : ids) put(to_float(file, mesh.positions + 3 * id));
    at[0] = at[1] = 0;
    file.write(record.data(), record.size());
  });
}

}  // namespace shape3d::apps::formats
