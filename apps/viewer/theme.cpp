#include "theme.hpp"

#include <array>

#include <QApplication>
#include <QPalette>
#include <QStyleFactory>

namespace shape3d::apps::viewer {

Theme make_theme(bool dark) {
  Theme theme;
  theme.dark = dark;
  if (dark) {
    theme.window = {43, 46, 51};
    theme.panel = {52, 56, 62};
    theme.field = {33, 35, 39};
    theme.text = {232, 234, 237};
    theme.faint_text = {154, 160, 168};
    theme.accent = {82, 148, 226};
    theme.slice_background = {12, 13, 15};
    theme.scene_low = {25, 28, 34};
    theme.scene_high = {62, 70, 84};
    theme.error_background = {110, 42, 42};
    theme.error_text = {255, 236, 236};
  } else {
    theme.window = {240, 241, 243};
    theme.panel = {250, 250, 251};
    theme.field = {255, 255, 255};
    theme.text = {28, 30, 33};
    theme.faint_text = {105, 111, 119};
    theme.accent = {36, 104, 190};
    theme.slice_background = {225, 228, 232};
    theme.scene_low = {255, 255, 255};
    theme.scene_high = {214, 222, 232};
    theme.error_background = {252, 220, 218};
    theme.error_text = {110, 20, 16};
  }
  return theme;
}

void apply_theme(QApplication& application, const Theme& theme) {
  QApplication::setStyle(QStyleFactory::create("Fusion"));
  QPalette palette;
  palette.setColor(QPalette::Window, theme.window);
  palette.setColor(QPalette::WindowText, theme.text);
  palette.setColor(QPalette::Base, theme.field);
  palette.setColor(QPalette::AlternateBase, theme.panel);
  palette.setColor(QPalette::Text, theme.text);
  palette.setColor(QPalette::Button, theme.panel);
  palette.setColor(QPalette::ButtonText, theme.text);
  palette.setColor(QPalette::ToolTipBase, theme.panel);
  palette.setColor(QPalette::ToolTipText, theme.text);
  palette.setColor(QPalette::PlaceholderText, theme.faint_text);
  palette.setColor(QPalette::Highlight, theme.accent);
  palette.setColor(QPalette::HighlightedText, Qt::white);
  palette.setColor(QPalette::Link, theme.accent);
  for (const QPalette::ColorRole role :
       {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    palette.setColor(QPalette::Disabled, role, theme.faint_text);
  application.setPalette(palette);
}

QColor axis_color(int world_axis) {
  static const std::array<QColor, 3> kColors{QColor(237, 213, 76), QColor(110, 176, 75),
                                             QColor(245, 90, 70)};
  return kColors[static_cast<std::size_t>(world_axis)];
}

QColor surface_color(int number) {
  static const std::array<QColor, 8> kColors{
      QColor(241, 230, 207), QColor(219, 132, 104), QColor(96, 165, 226), QColor(130, 190, 110),
      QColor(190, 150, 220), QColor(240, 200, 90),  QColor(90, 200, 200), QColor(200, 200, 205)};
  return kColors[static_cast<std::size_t>(number) % kColors.size()];
}

}  // namespace shape3d::apps::viewer
