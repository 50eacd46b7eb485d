#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <QImage>
#include <QObject>

#include "common/mesh.hpp"

namespace shape3d::apps::viewer {

/// Draws small pictures of mesh files that a library has none of. A thread reads the meshes; the
/// pictures are drawn in the thread of the window, one in each turn of its loop.
class ThumbnailMaker : public QObject {
  Q_OBJECT

 public:
  ThumbnailMaker();
  ~ThumbnailMaker() override;

  /// made() tells of it later.
  void request(std::int64_t key, const std::string& path);
  /// Drops what waits.
  void clear();
  [[nodiscard]] bool busy() const { return waiting_ > 0; }

  /// At once; null when there is no triangle.
  [[nodiscard]] QImage draw(const Mesh& mesh);

 signals:
  /// @param picture  Null: the file cannot be read, or has no triangle.
  void made(qint64 key, const QImage& picture);

 private:
  struct Reader;
  struct Painter;

  std::unique_ptr<Painter> painter_;
  std::unique_ptr<Reader> reader_;
  int waiting_ = 0;
  int round_ = 0;  // what was asked for before clear() is of another one
};

/// An image of the bytes of a PNG; null when they are none.
[[nodiscard]] QImage image_of_png(const std::string& png);

}  // namespace shape3d::apps::viewer
