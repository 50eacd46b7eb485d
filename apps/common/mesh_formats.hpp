#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "error.hpp"
#include "mesh.hpp"
#include "mesh_io.hpp"
#include "output_file.hpp"

// What the readers and writers of the single formats share; of use to mesh_io.cpp only.
namespace shape3d::apps::formats {

MeshFile parse_off(std::string_view bytes, const std::string& name);
MeshFile parse_obj(std::string_view bytes, const std::string& name);
MeshFile parse_ply(std::string_view bytes, const std::string& name);
MeshFile parse_stl(std::string_view bytes, const std::string& name);
MeshFile parse_vtp(std::string_view bytes, const std::string& name);

void write_off(OutputFile& file, const MeshView& mesh);
void write_obj(OutputFile& file, const MeshView& mesh);
void write_ply(OutputFile& file, const MeshView& mesh, MeshEncoding encoding);
void write_stl(OutputFile& file, const MeshView& mesh, MeshEncoding encoding);
void write_vtp(OutputFile& file, const MeshView& mesh);

inline constexpr std::int64_t kMaxCount = std::numeric_limits<std::int32_t>::max();

/// Collects faces as triangles while a file is parsed.
class FaceCollector {
 public:
  explicit FaceCollector(std::vector<std::int32_t>& indices) : indices_(indices) {}

  /// Adds a polygon as a fan round its first vertex; a face of fewer than three vertices is only
  /// counted.
  template <class Id>
  void add(const Id* ids, std::size_t count) {
    if (count < 3) {
      ++short_faces_;
      return;
    }
    if (count > 3) ++polygons_;
    for (std::size_t i = 2; i < count; ++i) {
      indices_.push_back(static_cast<std::int32_t>(ids[0]));
      indices_.push_back(static_cast<std::int32_t>(ids[i - 1]));
      indices_.push_back(static_cast<std::int32_t>(ids[i]));
    }
  }

  /// Puts the counts and warnings into the result.
  void report(MeshFile& file) const {
    file.polygons = polygons_;
    if (polygons_ > 0) {
      file.warnings.push_back(
          std::to_string(polygons_) +
          " faces of more than three vertices were made into fans of triangles");
    }
    if (short_faces_ > 0) {
      file.warnings.push_back(std::to_string(short_faces_) +
                              " faces of fewer than three vertices were left out");
    }
  }

 private:
  std::vector<std::int32_t>& indices_;
  std::int64_t polygons_ = 0, short_faces_ = 0;
};

/// Copies parsed numbers into the mesh.
inline void store(Mesh& mesh, const std::vector<double>& positions,
                  const std::vector<std::int32_t>& indices, const std::string& name) {
  const auto vertices = static_cast<std::int64_t>(positions.size() / 3);
  const auto triangles = static_cast<std::int64_t>(indices.size() / 3);
  if (vertices > kMaxCount || triangles > kMaxCount) {
    throw FileError(name, "has " + std::to_string(std::max(vertices, triangles)) +
                              " vertices or triangles, expected at most 2147483647");
  }
  mesh.V = Eigen::Map<const Mesh::Points>(positions.data(), vertices, 3);
  mesh.F = Eigen::Map<const Mesh::Triangles>(indices.data(), triangles, 3);
}

/// Sets `space` from "SPACE=LPS" or "SPACE=RAS" in a comment.
inline void find_space(Mesh& mesh) {
  for (const std::string& comment : mesh.comments) {
    for (const char* space : {"LPS", "RAS"}) {
      if (comment.find(std::string("SPACE=") + space) != std::string::npos) mesh.space = space;
    }
  }
}

/// The lines of comment to write: the mesh's own, then its space unless they already say so.
inline std::vector<std::string> comment_lines(const MeshView& mesh) {
  std::vector<std::string> lines = mesh.comments;
  for (std::string& line : lines) {
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::replace(line.begin(), line.end(), '\r', ' ');
  }
  const auto states_space = [](const std::string& line) {
    return line.find("SPACE=") != std::string::npos;
  };
  lines.erase(std::remove_if(lines.begin(), lines.end(), states_space), lines.end());
  if (!mesh.space.empty()) lines.push_back("SPACE=" + mesh.space);
  return lines;
}

/// Calls visit(ids) with the three ids of each triangle, as std::array<std::int64_t, 3>.
template <class Visitor>
void for_each_triangle(const MeshView& mesh, Visitor&& visit) {
  std::visit(
      [&](const auto* ids) {
        for (std::int64_t t = 0; t < mesh.triangle_count; ++t, ids += 3) {
          visit(std::array<std::int64_t, 3>{ids[0], ids[1], ids[2]});
        }
      },
      mesh.indices);
}

}  // namespace shape3d::apps::formats
