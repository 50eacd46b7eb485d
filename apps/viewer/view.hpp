#pragma once

#include <string>
#include <vector>

#include <QObject>
#include <QString>
#include <nlohmann/json_fwd.hpp>

class QWidget;

namespace shape3d::apps::viewer {

class Document;
struct Theme;

/// A line of the keyboard help.
struct KeyHelp {
  QString keys, what;
};

/// One way of looking at what is open: a page of the window. Each is a class in files of its own,
/// named in make_views().
///
/// All calls come from the thread of the window. Long work goes to a thread of the view's own;
/// while it runs, busy() is true, and busy_changed() tells when that changes: pictures without a
/// display wait for it.
class View : public QObject {
  Q_OBJECT

 public:
  /// @param name   For --view and sessions: one word in small letters.
  /// @param title  For people.
  View(QString name, QString title) : name_(std::move(name)), title_(std::move(title)) {}

  [[nodiscard]] const QString& name() const { return name_; }
  [[nodiscard]] const QString& title() const { return title_; }

  /// The large area and the controls beside it; made in the constructor, owned by the window, the
  /// same in each call.
  [[nodiscard]] virtual QWidget* content() = 0;
  [[nodiscard]] virtual QWidget* panel() = 0;

  /// A sentence on what to open, when there is nothing to show yet; it stands in the place of the
  /// content. Empty otherwise. Asked after each change of the document and after ready_changed().
  [[nodiscard]] virtual QString missing() const { return {}; }

  /// All parameters, for sessions and undo: JSON values that set_state() understands.
  [[nodiscard]] virtual nlohmann::json state() const = 0;
  /// Members that are missing stay as they are; unknown ones are ignored. Does not emit edited().
  /// @throws nlohmann::json::exception, std::invalid_argument  a member does not fit.
  virtual void set_state(const nlohmann::json& state) = 0;
  /// What `r` does: camera, zoom and parameters as at the start. The window records it for undo.
  virtual void reset() = 0;

  /// Whether open() is for this file, which no reader of volumes and meshes takes.
  [[nodiscard]] virtual bool takes(const std::string& /*path*/) const { return false; }
  /// @throws FileError  it cannot be read.
  virtual void open(const std::string& /*path*/) {}

  /// Whether work is under way that will change what is seen.
  [[nodiscard]] virtual bool busy() const { return false; }
  [[nodiscard]] virtual std::vector<KeyHelp> keys() const { return {}; }
  virtual void set_theme(const Theme& /*theme*/) {}
  /// The view has come to the front, or gone from it; what is hidden need not be drawn.
  virtual void set_active(bool /*active*/) {}

 protected:
  /// Opens a shape of a collection in the view of surfaces, in the place of the one before.
  void look_at(Document& document, const std::string& path);

 signals:
  void edited();                         ///< The user changed a parameter: undo can take it back.
  void busy_changed();                   ///< busy() may have changed.
  void ready_changed();                  ///< missing() may have changed.
  void said(const QString& sentence);    ///< For the status line.
  void failed(const QString& sentence);  ///< An error: shown above the content, and on stderr.
  void wants_file(const QString& path);  ///< The user chose a file in the view: open it.
  void wants_view(const QString& name);  ///< Bring that view to the front.

 private:
  QString name_, title_;
};

/// All views of the program, in the order of their tabs.
[[nodiscard]] std::vector<View*> make_views(Document& document);

}  // namespace shape3d::apps::viewer
