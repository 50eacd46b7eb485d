#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <QObject>

#include "common/mesh.hpp"
#include "common/volume.hpp"
#include "model/window_level.hpp"

namespace shape3d::apps::viewer {

struct OpenVolume {
  std::string path;
  Volume volume;
  double minimum = 0.0, maximum = 1.0;  ///< Of the finite samples.
  Window automatic;                     ///< automatic_window().
};

struct OpenMesh {
  std::string path;
  Mesh mesh;  ///< In LPS: a mesh in RAS is turned.
};

/// What a path is, as far as the first bytes and the extension tell.
enum class FileKind { volume, mesh, session, other };

/// @throws FileError  there is no such file, or it cannot be read.
[[nodiscard]] FileKind kind_of(const std::string& path);

/// What is open, and what the views share: one volume, meshes, the place of the crosshair, the
/// window of intensities. Files are read by a thread of its own, one after another.
class Document : public QObject {
  Q_OBJECT

 public:
  Document();
  ~Document() override;

  [[nodiscard]] std::shared_ptr<const OpenVolume> volume() const { return volume_; }
  [[nodiscard]] const std::vector<std::shared_ptr<const OpenMesh>>& meshes() const {
    return meshes_;
  }
  /// Paths of what is open, in the order of opening.
  [[nodiscard]] std::vector<std::string> files() const;

  /// Reads a volume, which takes the place of the one before, or a mesh, which is added; in the
  /// background.
  /// @pre  kind_of(path) is volume or mesh.
  void open(const std::string& path);
  /// Takes data that is already in memory: what a thread of open() or a view has made.
  void set_volume(std::shared_ptr<const OpenVolume> volume);
  void add_mesh(std::shared_ptr<const OpenMesh> mesh);
  /// Closes one mesh; nothing happens when it is not open.
  void remove_mesh(const std::string& path);
  /// Of the shapes of a collection one after another is looked at: closes the one before, unless
  /// it is this. The caller opens the file.
  void look_at(const std::string& path);
  [[nodiscard]] const std::string& looked_at() const { return looked_at_; }
  void close_all();
  /// A shape library, and the map of a collection: views read them, by their paths. "": none.
  [[nodiscard]] const std::string& library() const { return library_; }
  [[nodiscard]] const std::string& collection_map() const { return collection_map_; }
  void set_library(const std::string& path);
  void set_collection_map(const std::string& path);
  /// Files that are being read or wait for it.
  [[nodiscard]] int loading() const { return loading_; }

  /// Place of the crosshair in lattice coordinates of the volume.
  [[nodiscard]] const Eigen::Vector3d& cursor() const { return cursor_; }
  /// Clamped into the lattice.
  void set_cursor(const Eigen::Vector3d& lattice);
  [[nodiscard]] const Window& window() const { return window_; }
  void set_window(const Window& window);

 signals:
  void volume_changed();
  void meshes_changed();
  void collection_changed();  ///< The library or the map is another one.
  void cursor_changed();
  void window_changed();
  void window_edited();  ///< The user has dragged the window to where it is now.
  void loading_changed();
  void said(const QString& sentence);
  void failed(const QString& sentence);

 private:
  struct Reader;

  std::shared_ptr<const OpenVolume> volume_;
  std::vector<std::shared_ptr<const OpenMesh>> meshes_;
  Eigen::Vector3d cursor_ = Eigen::Vector3d::Zero();
  Window window_;
  int loading_ = 0;
  std::vector<std::string> order_;
  std::string library_, collection_map_, looked_at_;
  std::unique_ptr<Reader> reader_;
};

/// Reads one file, for Document. @throws FileError
[[nodiscard]] std::shared_ptr<const OpenVolume> read_open_volume(const std::string& path);
[[nodiscard]] std::shared_ptr<const OpenMesh> read_open_mesh(const std::string& path);

/// Calls `function` in the thread of `object`, after what it is doing; not at all when the object
/// has gone by then. For threads that work for it.
void call_later(QObject* object, std::function<void()> function);

}  // namespace shape3d::apps::viewer
