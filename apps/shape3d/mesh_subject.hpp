#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/mesh.hpp"
#include "common/mesh_io.hpp"
#include "common/output_file.hpp"
#include "common/picture.hpp"
#include "progress.hpp"
#include "report.hpp"

namespace CLI {
class App;
}

namespace shape3d::apps {

/// Reads a mesh, warns of what its file holds, and notes its name, format and size in the report.
/// @throws FileError
[[nodiscard]] Mesh read_subject(const std::string& path, const Settings& settings,
                                Progress& progress, Json& report);

/// A mesh file to be written: its name is checked and its temporary file made at once, before long
/// work begins.
class MeshOutput {
 public:
  /// @param option  How the command line names it: "-o".
  /// @throws UsageError  the extension is none of a mesh. @throws FileError  as OutputFile.
  MeshOutput(const std::string& option, const std::string& path);
  void write(const Mesh& mesh);
  void commit() { file_.commit(); }

 private:
  MeshFormat format_;
  OutputFile file_;
};

/// What commands that draw have in common.
struct PictureArguments {
  std::string path;  ///< Empty: no picture.
  std::string view = "upright";
};
/// Adds --picture and --view.
void add_picture_options(CLI::App& command, PictureArguments& arguments, const std::string& what);

/// The file of a picture, made at once; nothing when there is to be none.
class PictureOutput {
 public:
  /// @throws UsageError  the name does not end in .png; the view is unknown. @throws FileError
  explicit PictureOutput(const PictureArguments& arguments);
  [[nodiscard]] bool wanted() const { return file_.has_value(); }
  /// @param columns  Panels in a row.
  void draw(const std::vector<Panel>& panels, int columns, int width, int height);
  void commit();

 private:
  std::optional<OutputFile> file_;
  PictureOptions options_;
};

/// A mesh in one color, with the edges of its triangles when they are few enough to be seen.
[[nodiscard]] Panel plain_panel(const Mesh& mesh, const std::string& caption);
/// A mesh in the colors of its vertices or triangles, lightly shaded.
[[nodiscard]] Panel vertex_colors_panel(const Mesh& mesh, std::vector<std::uint8_t> colors,
                                        const std::string& caption);
[[nodiscard]] Panel triangle_colors_panel(const Mesh& mesh, std::vector<std::uint8_t> colors,
                                          const ColorScale& scale, const std::string& caption);

}  // namespace shape3d::apps
