#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh.hpp"
#include "output_file.hpp"

namespace shape3d::apps {

enum class MeshFormat { off, obj, ply, stl, vtp };

/// "OFF", "OBJ" …
[[nodiscard]] std::string_view to_string(MeshFormat format);

/// By the extension, in any case of letters; empty for another one.
[[nodiscard]] std::optional<MeshFormat> mesh_format(const std::string& path);

/// A mesh as a file holds it.
struct MeshFile {
  Mesh mesh;
  MeshFormat format = MeshFormat::off;
  std::string encoding;       ///< "ascii", "binary little endian" …
  std::int64_t polygons = 0;  ///< Faces of more than three vertices, made into fans of triangles.
  std::vector<std::string>
      warnings;  ///< Sentences: polygons made into triangles, elements left out.
};

/// Reads OFF, OBJ, PLY (ascii, binary of either byte order), STL (ascii, binary; vertices of equal
/// coordinates become one) or VTP, chosen by extension.
///
/// Faces of fewer than three vertices are left out with a warning; normals, colours and texture
/// coordinates are ignored. Vertices that no face uses are kept.
/// @throws FileError  the extension is none of these; the file cannot be read, is empty, is not of
/// its format,
///         ends early, has counts that do not fit it, an index out of range or a coordinate that is
///         not finite; more than 2³¹ − 1 vertices or triangles. The sentence names the line or
///         byte.
/// Memory: the file, the mesh, and for STL a hash table. Counts in a header are compared with the
/// size of the file before anything of their size is allocated.
[[nodiscard]] MeshFile read_mesh(const std::string& path);

/// The same from bytes in memory; `name` stands in error sentences.
[[nodiscard]] MeshFile parse_mesh(std::string_view bytes, MeshFormat format,
                                  const std::string& name);

/// How PLY and STL are written (OFF and OBJ are text; VTP is appended binary in native order).
enum class MeshEncoding { binary, binary_big_endian, ascii };

/// Writes a mesh; does not commit the file.
///
/// Coordinates are exact in PLY and VTP (double) and in text (shortest decimals that read back the
/// same); binary STL has floats. The space stands as "SPACE=LPS" in a comment (PLY, OBJ, OFF), the
/// header (STL) or the field data (VTP), where 3D Slicer looks for it. Arrays are written to VTP
/// only.
/// @throws FileError  writing failed; the format cannot number the vertices or triangles (PLY 2³²
/// ids, STL 2³²
///         triangles); a coordinate is beyond the range of float in STL.
void write_mesh(OutputFile& file, MeshFormat format, const MeshView& mesh,
                MeshEncoding encoding = MeshEncoding::binary);

/// The same, by extension and committed.
/// @throws FileError  also for an unknown extension.
void write_mesh(const std::string& path, const MeshView& mesh,
                MeshEncoding encoding = MeshEncoding::binary);

/// "unknown extension '.xyz', expected .ply, .obj, .off, .stl or .vtp".
[[nodiscard]] std::string unknown_mesh_extension(const std::string& path);

}  // namespace shape3d::apps
