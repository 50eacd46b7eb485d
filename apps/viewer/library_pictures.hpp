#pragma once

#include <cstdint>
#include <map>
#include <string>

#include <QImage>
#include <QObject>

#include "thumbnail_maker.hpp"

namespace shape3d::apps {
class ShapeLibrary;
}

namespace shape3d::apps::viewer {

/// Small pictures of the models of a library, each fetched once: those that the library holds, and
/// drawn ones for the rest.
class LibraryPictures : public QObject {
  Q_OBJECT

 public:
  LibraryPictures();

  /// Null while the picture is being drawn: changed() tells when it is there. White when the mesh
  /// cannot be drawn.
  [[nodiscard]] QImage of(const ShapeLibrary& library, std::int64_t id, const std::string& path);
  /// Null when there is none yet.
  [[nodiscard]] QImage known(std::int64_t key) const;
  /// Draws a mesh that the library does not hold, at once.
  void draw(std::int64_t key, const Mesh& mesh);
  void clear();
  [[nodiscard]] bool busy() const { return maker_.busy(); }

 signals:
  void changed();
  void busy_changed();
  void failed(const QString& sentence);

 private:
  std::map<std::int64_t, QImage> pictures_;
  ThumbnailMaker maker_;
};

}  // namespace shape3d::apps::viewer
