#pragma once

#include <QDialog>

namespace shape3d::apps::viewer {

class View;

/// The keys of the window and of a view.
class HelpDialog : public QDialog {
 public:
  HelpDialog(QWidget* parent, const View& view);
};

}  // namespace shape3d::apps::viewer
