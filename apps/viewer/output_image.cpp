#include "output_image.hpp"

#include <QBuffer>
#include <QImage>

#include "common/output_file.hpp"

namespace shape3d::apps::viewer {

void write_png(const std::string& path, const QImage& image) {
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  image.convertToFormat(QImage::Format_RGB888).save(&buffer, "PNG");
  OutputFile file(path);
  file.write(bytes.constData(), static_cast<std::size_t>(bytes.size()));
  file.commit();
}

}  // namespace shape3d::apps::viewer
