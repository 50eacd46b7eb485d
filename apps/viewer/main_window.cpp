#include "main_window.hpp"

#include <algorithm>
#include <iostream>
#include <new>

#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QDateTime>
#include <QDir>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QMimeData>
#include <QProgressBar>
#include <QScrollArea>
#include <QSettings>
#include <QStackedWidget>
#include <QStatusBar>
#include <QTabBar>
#include <QToolButton>
#include <QVBoxLayout>
#include <nlohmann/json.hpp>

#include "common/error.hpp"
#include "help_dialog.hpp"
#include "output_image.hpp"
#include "slice_widget.hpp"

namespace shape3d::apps::viewer {
namespace {

constexpr int kRecentFiles = 10;
constexpr int kPanelWidth = 300;

QSettings settings() { return QSettings("Shape3D", "viewer"); }

// What undo takes back: not where the crosshair and the cameras are, which move all the time.
nlohmann::json parameters_of(const View* view) {
  nlohmann::json state = view->state();
  state.erase("cursor");
  state.erase("layout");
  return state;
}

}  // namespace

MainWindow::MainWindow(bool remember) : theme_(make_theme(true)), remember_(remember) {
  setWindowTitle("Shape3D");
  setAcceptDrops(true);
  resize(1280, 720);
  make_frame();
  make_menus();
  connect(&document_, &Document::failed, this, &MainWindow::fail);
  connect(&document_, &Document::said, this,
          [this](const QString& sentence) { statusBar()->showMessage(sentence, 15'000); });
  connect(&document_, &Document::loading_changed, this, [this] {
    if (document_.loading() == 0) {
      statusBar()->clearMessage();
      apply_waiting_states();
    }
    update_busy();
  });
  for (View* view : make_views(document_)) adopt(view);
  // After the views, which have connected themselves when they were made.
  const auto begin_anew = [this] {
    undo_.clear();
    for (const View* view : views_) undo_.start(view->name().toStdString(), parameters_of(view));
    undo_action_->setEnabled(false);
    redo_action_->setEnabled(false);
    update_front();
  };
  connect(&document_, &Document::volume_changed, this, begin_anew);
  connect(&document_, &Document::meshes_changed, this, begin_anew);
  connect(&document_, &Document::collection_changed, this, begin_anew);
  set_dark(!remember_ || settings().value("dark", true).toBool());
  if (remember_) restoreGeometry(settings().value("geometry").toByteArray());
  update_recent();
  update_front();
}

MainWindow::~MainWindow() {
  for (View* view : views_) view->disconnect(this);
  document_.disconnect(this);
  for (View* view : views_) delete view;
}

void MainWindow::make_frame() {
  auto* middle = new QWidget;
  auto* column = new QVBoxLayout(middle);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);

  tabs_ = new QTabBar;
  tabs_->setDrawBase(false);
  tabs_->setExpanding(false);
  tabs_->setFocusPolicy(Qt::NoFocus);
  column->addWidget(tabs_);
  connect(tabs_, &QTabBar::currentChanged, this, &MainWindow::update_front);

  message_bar_ = new QWidget;
  message_bar_->setAutoFillBackground(true);
  auto* row = new QHBoxLayout(message_bar_);
  row->setContentsMargins(10, 6, 6, 6);
  message_ = new QLabel;
  message_->setWordWrap(true);
  message_->setTextFormat(Qt::PlainText);
  message_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  row->addWidget(message_, 1);
  auto* close = new QToolButton;
  close->setText("Close");
  connect(close, &QToolButton::clicked, message_bar_, &QWidget::hide);
  row->addWidget(close);
  message_bar_->hide();
  column->addWidget(message_bar_);

  contents_ = new QStackedWidget;
  missing_ = new QLabel;
  missing_->setAlignment(Qt::AlignCenter);
  missing_->setWordWrap(true);
  missing_->setTextFormat(Qt::PlainText);
  contents_->addWidget(missing_);
  column->addWidget(contents_, 1);
  setCentralWidget(middle);

  panels_ = new QStackedWidget;
  auto* dock = new QDockWidget("Controls");
  dock->setObjectName("controls");
  dock->setFeatures(QDockWidget::DockWidgetMovable);
  dock->setTitleBarWidget(new QWidget);  // none
  dock->setWidget(panels_);
  addDockWidget(Qt::RightDockWidgetArea, dock);

  working_ = new QProgressBar;
  working_->setRange(0, 0);
  working_->setMaximumWidth(140);
  working_->setTextVisible(false);
  working_->hide();
  statusBar()->addPermanentWidget(working_);
}

QAction* MainWindow::add_action(QMenu* menu, const QString& title, const QKeySequence& key,
                                std::function<void()> what) {
  QAction* action = menu->addAction(title);
  action->setShortcut(key);
  connect(action, &QAction::triggered, this, std::move(what));
  return action;
}

void MainWindow::make_menus() {
  QMenu* file = menuBar()->addMenu("&File");
  add_action(file, "&Open …", QKeySequence::Open, [this] {
    for (const QString& path : QFileDialog::getOpenFileNames(this, "Open")) open(path);
  });
  add_action(file, "Open a &DICOM folder …", {}, [this] {
    const QString path = QFileDialog::getExistingDirectory(this, "Open a DICOM folder");
    if (!path.isEmpty()) open(path);
  });
  recent_ = file->addMenu("Open &recent");
  file->addSeparator();
  add_action(file, "&Save session …", QKeySequence::Save, [this] {
    const QString path =
        QFileDialog::getSaveFileName(this, "Save session", "session.json", "Sessions (*.json)");
    if (path.isEmpty()) return;
    try {
      write_session(path.toStdString(), session());
      statusBar()->showMessage("Saved " + path, 8000);
    } catch (const FileError& error) {
      fail(QString::fromStdString(error.what()));
    }
  });
  add_action(file, "Save &picture", QKeySequence("S"), [this] { save_screenshot(); });
  add_action(file, "&Close all", QKeySequence("Ctrl+W"), [this] { document_.close_all(); });
  file->addSeparator();
  add_action(file, "&Quit", QKeySequence::Quit, [this] { close(); });

  QMenu* edit = menuBar()->addMenu("&Edit");
  undo_action_ = add_action(edit, "&Undo", QKeySequence::Undo, [this] { undo(); });
  redo_action_ = add_action(edit, "&Redo", QKeySequence("Ctrl+Shift+Z"), [this] { redo(); });
  add_action(edit, "Re&set view", QKeySequence("R"), [this] { reset(); });

  QMenu* look = menuBar()->addMenu("&View");
  dark_action_ =
      add_action(look, "&Dark", QKeySequence("B"), [this] { set_dark(dark_action_->isChecked()); });
  dark_action_->setCheckable(true);
  look->addSeparator();

  QMenu* help = menuBar()->addMenu("&Help");
  // On some keyboards ? comes with Shift, on others without.
  add_action(help, "&Keys", {}, [this] {
    show_help();
  })->setShortcuts({QKeySequence("?"), QKeySequence("Shift+?"), QKeySequence("F1")});
  for (QMenu* menu : {file, edit, look, help}) menu->setObjectName(menu->title());
}

void MainWindow::adopt(View* view) {
  views_.push_back(view);
  tabs_->addTab(view->title());
  contents_->addWidget(view->content());
  auto* scroll = new QScrollArea;
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setFixedWidth(kPanelWidth);
  scroll->setWidget(view->panel());
  panels_->addWidget(scroll);
  const std::string name = view->name().toStdString();
  undo_.start(name, parameters_of(view));
  connect(view, &View::edited, this, [this, view, name] {
    undo_.record(name, parameters_of(view));
    undo_action_->setEnabled(undo_.can_undo());
    redo_action_->setEnabled(undo_.can_redo());
  });
  connect(view, &View::busy_changed, this, &MainWindow::update_busy);
  connect(view, &View::ready_changed, this, &MainWindow::update_front);
  connect(view, &View::failed, this, &MainWindow::fail);
  connect(view, &View::said, this,
          [this](const QString& sentence) { statusBar()->showMessage(sentence, 15'000); });
  connect(view, &View::wants_file, this, &MainWindow::open);
  connect(view, &View::wants_view, this, &MainWindow::show_view);
  const auto number = static_cast<int>(views_.size());
  if (number <= 9) {
    for (QMenu* menu : menuBar()->findChildren<QMenu*>()) {
      if (menu->title() == "&View")
        add_action(menu, view->title(), QKeySequence(QString::number(number)),
                   [this, view] { show_view(view->name()); });
    }
  }
}

View* MainWindow::current() const {
  const int at = tabs_->currentIndex();
  return at >= 0 && at < static_cast<int>(views_.size()) ? views_[static_cast<std::size_t>(at)]
                                                         : nullptr;
}

View* MainWindow::view_named(const QString& name) const {
  const auto found = std::find_if(views_.begin(), views_.end(),
                                  [&name](const View* view) { return view->name() == name; });
  return found == views_.end() ? nullptr : *found;
}

void MainWindow::show_view(const QString& name) {
  const auto found = std::find_if(views_.begin(), views_.end(),
                                  [&name](const View* view) { return view->name() == name; });
  if (found != views_.end()) tabs_->setCurrentIndex(static_cast<int>(found - views_.begin()));
}

void MainWindow::update_front() {
  View* view = current();
  if (view == nullptr || view->content() == nullptr) return;
  const QString missing = view->missing();
  missing_->setText(missing);
  QWidget* front = missing.isEmpty() ? view->content() : missing_;
  contents_->setCurrentWidget(front);
  panels_->setCurrentIndex(tabs_->currentIndex());
  View* shown = missing.isEmpty() ? view : nullptr;
  if (shown == active_) return;
  if (active_ != nullptr) active_->set_active(false);
  active_ = shown;
  if (active_ != nullptr) active_->set_active(true);
}

bool MainWindow::busy() const {
  return document_.loading() > 0 ||
         std::any_of(views_.begin(), views_.end(), [](const View* view) { return view->busy(); });
}

void MainWindow::update_busy() { working_->setVisible(busy()); }

void MainWindow::fail(const QString& sentence) {
  failures_.push_back(sentence.toStdString());
  std::cerr << "shape3d-viewer: " << failures_.back() << '\n';
  message_->setText(sentence);
  message_bar_->show();
}

QString MainWindow::message() const {
  return message_bar_->isVisibleTo(message_bar_->parentWidget()) ? message_->text() : QString();
}

void MainWindow::open(const QString& path) {
  const std::string name = path.toStdString();
  message_bar_->hide();
  try {
    for (View* view : views_) {
      if (!view->takes(name)) continue;
      view->open(name);
      note_recent(path);
      show_view(view->name());
      update_front();
      return;
    }
    switch (kind_of(name)) {
      case FileKind::session:
        apply(read_session(name));
        break;
      case FileKind::volume:
      case FileKind::mesh:
        statusBar()->showMessage("Reading " + path + " …");
        document_.open(name);
        break;
      case FileKind::other:
        throw FileError(name,
                        "is no file of a known kind; expected a volume (DICOM, NIfTI, NRRD, "
                        "MetaImage, VTI), a mesh (.ply, .obj, .off, .stl, .vtp), a shape library "
                        "(.db), the map of a collection (.model) or a session (.json)");
    }
    note_recent(path);
  } catch (const std::bad_alloc&) {
    fail(path + ": there is not enough memory");
  } catch (const std::exception& error) {
    fail(QString::fromStdString(error.what()));
  }
}

Session MainWindow::session() const {
  Session session;
  session.files = document_.files();
  session.view = current()->name().toStdString();
  session.dark = theme_.dark;
  for (const View* view : views_) session.views[view->name().toStdString()] = view->state();
  return session;
}

void MainWindow::apply(const Session& session) {
  document_.close_all();
  set_dark(session.dark);
  waiting_states_.clear();
  for (const auto& [name, state] : session.views.items()) waiting_states_[name] = state;
  waiting_view_ = QString::fromStdString(session.view);
  bool reading = false;
  for (const std::string& file : session.files) {
    try {
      // A file that has gone since is an error, and the rest is shown.
      const auto taker = std::find_if(views_.begin(), views_.end(),
                                      [&file](const View* view) { return view->takes(file); });
      if (taker != views_.end()) {
        (*taker)->open(file);
        continue;
      }
      static_cast<void>(kind_of(file));
      document_.open(file);
      reading = true;
    } catch (const std::exception& error) {
      fail(QString::fromStdString(error.what()));
    }
  }
  if (!reading) apply_waiting_states();
}

void MainWindow::apply_waiting_states() {
  if (waiting_view_.isEmpty()) return;
  for (const auto& [name, state] : waiting_states_) {
    View* view = view_named(QString::fromStdString(name));
    if (view == nullptr) continue;
    try {
      view->set_state(state);
    } catch (const std::exception& error) {
      fail("The session's state of view \"" + view->name() + "\" does not fit: " + error.what());
    }
    undo_.start(name, parameters_of(view));
  }
  if (view_named(waiting_view_) != nullptr) {
    show_view(waiting_view_);
  } else {
    fail("The session's view is \"" + waiting_view_ + "\", which this program does not have");
  }
  waiting_states_.clear();
  waiting_view_.clear();
  undo_.clear();
  update_front();
}

void MainWindow::step(const std::optional<UndoStack::Step>& step) {
  if (!step) return;
  View* view = view_named(QString::fromStdString(step->owner));
  view->set_state(step->state);
  undo_.start(step->owner, parameters_of(view));
  // The window is seen in the slices of any view.
  const bool seen =
      step->owner == "volume" && !current()->content()->findChildren<SliceWidget*>().empty();
  if (!seen) show_view(view->name());
  undo_action_->setEnabled(undo_.can_undo());
  redo_action_->setEnabled(undo_.can_redo());
}

void MainWindow::undo() {
  step(undo_.undo([this](const std::string& name) {
    return parameters_of(view_named(QString::fromStdString(name)));
  }));
}

void MainWindow::redo() {
  step(undo_.redo([this](const std::string& name) {
    return parameters_of(view_named(QString::fromStdString(name)));
  }));
}

void MainWindow::reset() {
  View* view = current();
  if (view == nullptr || !view->missing().isEmpty()) return;
  view->reset();
  undo_.record(view->name().toStdString(), parameters_of(view));
  undo_action_->setEnabled(undo_.can_undo());
}

void MainWindow::show_help() {
  HelpDialog dialog(this, *current());
  dialog.exec();
}

QImage MainWindow::picture(bool whole) {
  QWidget* widget = whole ? static_cast<QWidget*>(this) : contents_->currentWidget();
  return widget->grab().toImage();
}

void MainWindow::save_screenshot() {
  const QImage image = picture(false);
  const QString name = "shape3d-" + current()->name() +
                       QDateTime::currentDateTime().toString("-yyyyMMdd-HHmmss-zzz") + ".png";
  try {
    write_png(QDir::current().filePath(name).toStdString(), image);
    statusBar()->showMessage("Saved " + QDir::current().filePath(name), 15'000);
  } catch (const FileError& error) {
    fail(QString::fromStdString(error.what()));
  }
}

void MainWindow::set_dark(bool dark) {
  theme_ = make_theme(dark);
  dark_action_->setChecked(dark);
  if (auto* application = qobject_cast<QApplication*>(QApplication::instance()))
    apply_theme(*application, theme_);
  QPalette colors = message_bar_->palette();
  colors.setColor(QPalette::Window, theme_.error_background);
  colors.setColor(QPalette::WindowText, theme_.error_text);
  message_bar_->setPalette(colors);
  for (View* view : views_) view->set_theme(theme_);
  if (remember_) settings().setValue("dark", dark);
}

void MainWindow::note_recent(const QString& path) {
  if (!remember_) return;
  const QString whole = QFileInfo(path).absoluteFilePath();
  QStringList recent = settings().value("recent").toStringList();
  recent.removeAll(whole);
  recent.prepend(whole);
  while (recent.size() > kRecentFiles) recent.removeLast();
  settings().setValue("recent", recent);
  update_recent();
}

void MainWindow::update_recent() {
  recent_->clear();
  const QStringList recent = remember_ ? settings().value("recent").toStringList() : QStringList();
  recent_->setEnabled(!recent.isEmpty());
  for (const QString& path : recent)
    connect(recent_->addAction(path), &QAction::triggered, this, [this, path] { open(path); });
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  for (const QUrl& url : event->mimeData()->urls()) {
    if (url.isLocalFile()) open(url.toLocalFile());
  }
  event->acceptProposedAction();
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (remember_) settings().setValue("geometry", saveGeometry());
  event->accept();
}

}  // namespace shape3d::apps::viewer
