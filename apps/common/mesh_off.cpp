#include "mesh_formats.hpp"
#include "text_scanner.hpp"

namespace shape3d::apps::formats {
namespace {

// The header key: [ST][C][N][4][n]OFF. Vertices of the plain kind are three numbers in free format;
// with a prefix the rest of a vertex's line holds what is ignored here.
struct OffHeader {
  bool extra_on_vertex_lines = false;
  std::string_view counts_on_key;  // "8" of "OFF8 6 0", which some programs write
};

OffHeader read_key(TextScanner& scanner) {
  const std::string_view key = scanner.word("the key OFF");
  const std::size_t off = key.find("OFF");
  if (off == std::string_view::npos) scanner.fail("the key OFF", key);
  const std::string_view prefix = key.substr(0, off);
  for (const char c : prefix) {
    if (c == '4' || c == 'n') scanner.fail("vertices of three coordinates (OFF)", key);
    if (std::string_view("STCN").find(c) == std::string_view::npos)
      scanner.fail("the key OFF", key);
  }
  OffHeader header;
  header.extra_on_vertex_lines = !prefix.empty();
  header.counts_on_key = key.substr(off + 3);
  return header;
}

std::int64_t read_count(TextScanner& scanner, std::string_view what, std::size_t bytes_each) {
  const std::int64_t count = scanner.integer(what);
  const auto most = static_cast<std::int64_t>(scanner.remaining() / bytes_each) + 1;
  if (count < 0 || count > most) {
    scanner.fail(std::string(what) + " is " + std::to_string(count) + ", but the " +
                 std::to_string(scanner.remaining()) + " bytes that follow hold at most " +
                 std::to_string(most));
  }
  if (count > kMaxCount) scanner.fail(std::string(what) + " is over 2147483647");
  return count;
}

}  // namespace

MeshFile parse_off(std::string_view bytes, const std::string& name) {
  MeshFile file;
  file.format = MeshFormat::off;
  file.encoding = "ascii";
  for (std::size_t at = 0; at < bytes.size() && at < 65536;) {  // comments at the top
    const std::size_t stop = std::min(bytes.find('\n', at), bytes.size());
    const std::string_view line = bytes.substr(at, stop - at);
    if (!line.empty() && line[0] == '#') {
      std::string text(line.substr(line.size() > 1 && line[1] == ' ' ? 2 : 1));
      if (!text.empty() && text.back() == '\r') text.pop_back();
      file.mesh.comments.push_back(std::move(text));
    } else if (at > 0) {
      break;
    }
    at = stop + 1;
  }
  find_space(file.mesh);

  TextScanner scanner(bytes, name);
  const OffHeader header = read_key(scanner);
  std::int64_t vertices = 0;
  if (header.counts_on_key.empty()) {
    if (scanner.skip_blanks() && scanner.remaining() >= 6 &&
        bytes.substr(scanner.offset(), 6) == "BINARY") {
      scanner.fail("binary OFF is not supported, expected text");
    }
    vertices = read_count(scanner, "the number of vertices", 6);  // "0 0 0\n"
  } else if (!TextScanner::parse(header.counts_on_key, vertices) || vertices < 0 ||
             vertices > static_cast<std::int64_t>(scanner.remaining() / 6) + 1) {
    scanner.fail("the key OFF and the number of vertices", header.counts_on_key);
  }
  const std::int64_t faces = read_count(scanner, "the number of faces", 2);  // "0\n"
  scanner.integer("the number of edges");

  std::vector<double> positions(static_cast<std::size_t>(3 * vertices));
  for (std::int64_t v = 0; v < vertices; ++v) {
    for (int c = 0; c < 3; ++c)
      positions[static_cast<std::size_t>(3 * v + c)] = scanner.number("a coordinate");
    if (header.extra_on_vertex_lines) scanner.rest_of_line();
  }
  std::vector<std::int32_t> indices;
  indices.reserve(static_cast<std::size_t>(3 * faces));
  FaceCollector collector(indices);
  std::vector<std::int64_t> polygon;
  for (std::int64_t f = 0; f < faces; ++f) {
    const std::int64_t corners = scanner.integer("the number of vertices of a face");
    if (corners < 0 || corners > static_cast<std::int64_t>(scanner.remaining())) {
      scanner.fail("a face of " + std::to_string(corners) + " vertices does not fit the file");
    }
    polygon.clear();
    for (std::int64_t i = 0; i < corners; ++i) {
      const std::int64_t id = scanner.integer("a vertex index");
      if (id < 0 || id >= vertices) {
        scanner.fail("expected a vertex index from 0 to " + std::to_string(vertices - 1) +
                     ", found " + std::to_string(id));
      }
      polygon.push_back(id);
    }
    scanner.rest_of_line();  // the colour of the face
    collector.add(polygon.data(), polygon.size());
  }
  collector.report(file);
  if (scanner.skip_space()) {
    file.warnings.push_back("text after the last face, from line " +
                            std::to_string(scanner.line()) + " on, was not read");
  }
  store(file.mesh, positions, indices, name);
  return file;
}

void write_off(OutputFile& file, const MeshView& mesh) {
  file.write("OFF\n");
  for (const std::string& line : comment_lines(mesh)) file.write("# " + line + "\n");
  file.write_number(mesh.vertex_count);
  file.write_char(' ');
  file.write_number(mesh.triangle_count);
  file.write(" 0\n");
  for (std::int64_t v = 0; v < mesh.vertex_count; ++v) {
    for (int c = 0; c < 3; ++c) {
      file.write_number(mesh.positions[3 * v + c]);
      file.write_char(c < 2 ? ' ' : '\n');
    }
  }
  for_each_triangle(mesh, [&](const std::array<std::int64_t, 3>& ids) {
    file.write_char('3');
    for (const std::int64_t id : ids) {
      file.write_char(' ');
      file.write_number(id);
    }
    file.write_char('\n');
  });
}

}  // namespace shape3d::apps::formats
