#include "library_pictures.hpp"

#include <exception>

#include "common/shape_library.hpp"

namespace shape3d::apps::viewer {

LibraryPictures::LibraryPictures() {
  connect(&maker_, &ThumbnailMaker::made, this, [this](qint64 key, const QImage& image) {
    QImage& picture = pictures_[key] = image;
    if (picture.isNull()) {
      picture = QImage(1, 1, QImage::Format_RGB888);
      picture.fill(Qt::white);
    }
    emit changed();
    emit busy_changed();
  });
}

QImage LibraryPictures::of(const ShapeLibrary& library, std::int64_t id, const std::string& path) {
  const auto known = pictures_.find(id);
  if (known != pictures_.end()) return known->second;
  QImage& image = pictures_[id];
  try {
    image = image_of_png(library.thumbnail(id));
  } catch (const std::exception& error) {
    emit failed(QString::fromStdString(error.what()));
  }
  if (image.isNull()) {
    maker_.request(id, path);
    emit busy_changed();
  }
  return image;
}

QImage LibraryPictures::known(std::int64_t key) const {
  const auto known = pictures_.find(key);
  return known == pictures_.end() ? QImage() : known->second;
}

void LibraryPictures::draw(std::int64_t key, const Mesh& mesh) {
  pictures_[key] = maker_.draw(mesh);
}

void LibraryPictures::clear() {
  maker_.clear();
  pictures_.clear();
}

}  // namespace shape3d::apps::viewer
