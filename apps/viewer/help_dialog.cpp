#include "help_dialog.hpp"

#include <QDialogButtonBox>
#include <QGridLayout>
#include <QLabel>
#include <QVBoxLayout>

#include "view.hpp"

namespace shape3d::apps::viewer {
namespace {

const std::vector<KeyHelp> kWindowKeys{{"?", "this help"},
                                       {"1 … 9", "the views, in the order of the tabs"},
                                       {"R", "reset the view"},
                                       {"S", "save a picture in the current folder"},
                                       {"B", "dark or light"},
                                       {"Ctrl+O", "open files; they can also be dropped here"},
                                       {"Ctrl+S", "save the session"},
                                       {"Ctrl+Z, Ctrl+Shift+Z", "undo, redo"},
                                       {"Ctrl+W, Ctrl+Q", "close all files, quit"}};

void add_keys(QGridLayout* grid, const QString& title, const std::vector<KeyHelp>& keys) {
  auto* heading = new QLabel("<b>" + title + "</b>");
  grid->addWidget(heading, grid->rowCount(), 0, 1, 2);
  for (const KeyHelp& key : keys) {
    const int row = grid->rowCount();
    auto* name = new QLabel(key.keys);
    QFont font = name->font();
    font.setFamily("monospace");
    name->setFont(font);
    grid->addWidget(name, row, 0);
    grid->addWidget(new QLabel(key.what), row, 1);
  }
}

}  // namespace

HelpDialog::HelpDialog(QWidget* parent, const View& view) : QDialog(parent) {
  setObjectName("help");
  setWindowTitle("Keys");
  auto* column = new QVBoxLayout(this);
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(24);
  column->addLayout(grid);
  add_keys(grid, "Everywhere", kWindowKeys);
  if (!view.keys().empty()) add_keys(grid, view.title(), view.keys());
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  column->addWidget(buttons);
}

}  // namespace shape3d::apps::viewer
