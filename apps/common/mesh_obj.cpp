#include "mesh_formats.hpp"
#include "text_scanner.hpp"

namespace shape3d::apps::formats {
namespace {

// Statements that say nothing about vertices and faces.
bool is_ignored(std::string_view keyword) {
  static constexpr std::string_view kIgnored[] = {
      "vt",     "vn",         "vp",        "g",      "o",     "s",    "mg",       "usemtl",
      "mtllib", "maplib",     "l",         "p",      "bevel", "lod",  "c_interp", "d_interp",
      "usemap", "shadow_obj", "trace_obj", "cstype", "deg",   "bmat", "step",     "curv",
      "curv2",  "surf",       "parm",      "trim",   "hole",  "scrv", "sp",       "end",
      "con",    "ctech",      "stech",     "res",    "bzp",   "bsp",  "cdc",      "cdp"};
  return std::find(std::begin(kIgnored), std::end(kIgnored), keyword) != std::end(kIgnored);
}

class ObjParser {
 public:
  ObjParser(std::string_view bytes, const std::string& name)
      : bytes_(bytes), scanner_(bytes, name, '\0'), collector_(indices_) {}

  MeshFile parse() {
    MeshFile file;
    file.format = MeshFormat::obj;
    file.encoding = "ascii";
    while (scanner_.skip_space()) {
      const std::string_view keyword = scanner_.word("a statement");
      if (keyword[0] == '#') {
        comment(keyword, file.mesh);
      } else if (keyword == "v") {
        for (int c = 0; c < 3; ++c) positions_.push_back(scanner_.number("a coordinate"));
        scanner_.rest_of_line();
        ++vertices_;
      } else if (keyword == "f" || keyword == "fo") {
        face();
      } else if (is_ignored(keyword)) {
        skip_statement();
      } else {
        scanner_.fail("a statement of the OBJ format (v, f, vn …)", keyword);
      }
    }
    if (highest_ >= vertices_) {
      const auto line =
          1 + std::count(bytes_.begin(),
                         bytes_.begin() + static_cast<std::ptrdiff_t>(after_highest_), '\n');
      throw FileError(scanner_.name(),
                      "line " + std::to_string(line) + ": expected a vertex index from 1 to " +
                          std::to_string(vertices_) + ", found " + std::to_string(highest_ + 1));
    }
    collector_.report(file);
    find_space(file.mesh);
    store(file.mesh, positions_, indices_, scanner_.name());
    return file;
  }

 private:
  void comment(std::string_view word, Mesh& mesh) {
    std::string text(word.substr(1));
    const std::string_view rest = scanner_.rest_of_line();
    if (!text.empty() && !rest.empty()) text += ' ';
    text += rest;
    if (mesh.comments.size() < 64) mesh.comments.push_back(std::move(text));
  }

  void skip_statement() {
    std::string_view rest = scanner_.rest_of_line();
    while (!rest.empty() && rest.back() == '\\') rest = scanner_.rest_of_line();
  }

  void face() {
    polygon_.clear();
    while (scanner_.skip_blanks()) {
      std::string_view corner = scanner_.word("a vertex index");
      if (corner[0] == '#') break;
      if (corner == "\\") {
        scanner_.rest_of_line();
        continue;
      }
      corner = corner.substr(0, corner.find('/'));
      std::int64_t id = 0;
      if (!TextScanner::parse(corner, id)) scanner_.fail("a vertex index", corner);
      if (id == 0 || id < -vertices_ || id > kMaxCount) {
        scanner_.fail("expected a vertex index from 1 on, or from -1 to " +
                      std::to_string(-vertices_) + ", found " + std::to_string(id));
      }
      id = id > 0 ? id - 1 : vertices_ + id;
      if (id >= vertices_ && id > highest_) {
        highest_ = id;
        after_highest_ = scanner_.offset();
      }
      polygon_.push_back(id);
    }
    scanner_.rest_of_line();
    collector_.add(polygon_.data(), polygon_.size());
  }

  std::string_view bytes_;
  TextScanner scanner_;
  std::vector<double> positions_;
  std::vector<std::int32_t> indices_;
  std::vector<std::int64_t> polygon_;
  FaceCollector collector_;
  std::int64_t vertices_ = 0;
  std::int64_t highest_ = -1;      // of the indices that were ahead of their vertex
  std::size_t after_highest_ = 0;  // the byte after it
};

}  // namespace

MeshFile parse_obj(std::string_view bytes, const std::string& name) {
  return ObjParser(bytes, name).parse();
}

void write_obj(OutputFile& file, const MeshView& mesh) {
  for (const std::string& line : comment_lines(mesh)) file.write("# " + line + "\n");
  file.write("# " + std::to_string(mesh.vertex_count) + " vertices, " +
             std::to_string(mesh.triangle_count) + " triangles\n");
  for (std::int64_t v = 0; v < mesh.vertex_count; ++v) {
    file.write_char('v');
    for (int c = 0; c < 3; ++c) {
      file.write_char(' ');
      file.write_number(mesh.positions[3 * v + c]);
    }
    file.write_char('\n');
  }
  for_each_triangle(mesh, [&](const std::array<std::int64_t, 3>& ids) {
    file.write_char('f');
    for (const std::int64_t id : ids) {
      file.write_char(' ');
      file.write_number(id + 1);
    }
    file.write_char('\n');
  });
}

}  // namespace shape3d::apps::formats
