#pragma once

#include <map>
#include <string>
#include <vector>

#include <QMainWindow>

#include "document.hpp"
#include "model/session.hpp"
#include "model/undo_stack.hpp"
#include "theme.hpp"
#include "view.hpp"

class QAction;
class QLabel;
class QMenu;
class QProgressBar;
class QStackedWidget;
class QTabBar;

namespace shape3d::apps::viewer {

/// The window: tabs of views, the content of one with its controls beside it, menus, keys, undo,
/// sessions, recent files, and messages above the content.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  /// @param remember  Keep recent files and the place of the window in the user's settings.
  explicit MainWindow(bool remember);
  ~MainWindow() override;

  [[nodiscard]] Document& document() { return document_; }
  [[nodiscard]] const std::vector<View*>& views() const { return views_; }
  [[nodiscard]] View* current() const;
  /// By its name; null for another word.
  [[nodiscard]] View* view_named(const QString& name) const;
  /// @pre  view_named(name) is one.
  void show_view(const QString& name);

  /// Opens a volume, a mesh, a session or what a view takes. Failures are shown in the window, and
  /// kept for failures().
  void open(const QString& path);
  void apply(const Session& session);
  [[nodiscard]] Session session() const;

  /// Whether files are being read, or a view is at work.
  [[nodiscard]] bool busy() const;
  /// All errors shown so far.
  [[nodiscard]] const std::vector<std::string>& failures() const { return failures_; }
  /// What the window shows now. @param whole  Else the content of the view alone.
  [[nodiscard]] QImage picture(bool whole);

  void set_dark(bool dark);
  [[nodiscard]] bool dark() const { return theme_.dark; }
  [[nodiscard]] QString message() const;  ///< The error that is shown; empty: none.

 public slots:
  void undo();
  void redo();
  void reset();
  void show_help();
  void save_screenshot();

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void closeEvent(QCloseEvent* event) override;

 private:
  void make_frame();
  void make_menus();
  void adopt(View* view);
  void update_front();
  void update_busy();
  void fail(const QString& sentence);
  void note_recent(const QString& path);
  void update_recent();
  void step(const std::optional<UndoStack::Step>& step);
  void apply_waiting_states();
  QAction* add_action(QMenu* menu, const QString& title, const QKeySequence& key,
                      std::function<void()> what);

  Document document_;
  std::vector<View*> views_;
  Theme theme_;
  UndoStack undo_;
  bool remember_;
  std::vector<std::string> failures_;
  std::map<std::string, nlohmann::json> waiting_states_;  // of a session, until its files are read
  QString waiting_view_;

  QTabBar* tabs_ = nullptr;
  QStackedWidget *contents_ = nullptr, *panels_ = nullptr;
  QLabel *missing_ = nullptr, *message_ = nullptr;
  QWidget *message_bar_ = nullptr, *front_ = nullptr;
  QProgressBar* working_ = nullptr;
  QMenu* recent_ = nullptr;
  QAction *undo_action_ = nullptr, *redo_action_ = nullptr, *dark_action_ = nullptr;
  View* active_ = nullptr;
};

}  // namespace shape3d::apps::viewer
