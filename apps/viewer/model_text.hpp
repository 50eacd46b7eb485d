#pragma once

#include <optional>
#include <string>

#include <QColor>
#include <QString>

#include "common/color_map.hpp"
#include "common/text.hpp"

namespace shape3d::apps::viewer {

/// What files and libraries say, without control characters.
[[nodiscard]] inline QString text_of(const std::string& words) {
  return QString::fromStdString(printable(words));
}

[[nodiscard]] inline QString class_text(const std::optional<std::string>& name) {
  return name ? text_of(*name) : QString("class not known");
}

[[nodiscard]] inline QColor to_qt(const Color& color) {
  return QColor::fromRgbF(color[0], color[1], color[2]);
}

}  // namespace shape3d::apps::viewer
