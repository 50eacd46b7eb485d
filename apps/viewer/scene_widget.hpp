#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <vtkSmartPointer.h>
#include <QColor>
#include <QPointer>
#include <QWidget>

class QVTKOpenGLNativeWidget;
class vtkActor;
class vtkCamera;
class vtkGenericOpenGLRenderWindow;
class vtkPolyData;
class vtkPolyDataMapper;
class vtkProp;
class vtkProperty;
class vtkRenderer;
class vtkUnsignedCharArray;

namespace shape3d::apps::viewer {

struct Theme;

/// A surface in a scene with a coarser one in its place while the scene is turned.
class SceneSurface {
 public:
  SceneSurface();
  ~SceneSurface();

  /// @param coarse  Null: the surface itself is drawn while turning, too.
  void set_geometry(vtkPolyData* full, vtkPolyData* coarse);
  /// Colours, an array of three bytes, of the vertices or triangles of the full surface.
  void set_colors(vtkUnsignedCharArray* colors, bool of_triangles);
  void set_visible(bool visible);
  [[nodiscard]] vtkActor* actor() const;
  [[nodiscard]] vtkProperty* property() const;
  void set_coarse(bool coarse);

 private:
  vtkSmartPointer<vtkActor> actor_;
  vtkSmartPointer<vtkPolyDataMapper> full_, coarse_;
  bool has_coarse_ = false, is_coarse_ = false;
};

/// Where the camera of a scene stands.
enum class LookFrom { front, back, left, right, top, bottom, oblique, upright };

/// A 3D scene of VTK that is turned with the mouse: left turns, middle or Shift moves, right or the
/// wheel zooms.
class SceneWidget : public QWidget {
  Q_OBJECT

 public:
  explicit SceneWidget(QWidget* parent = nullptr);
  ~SceneWidget() override;

  [[nodiscard]] vtkRenderer* renderer() const;
  [[nodiscard]] vtkGenericOpenGLRenderWindow* window() const;
  [[nodiscard]] QVTKOpenGLNativeWidget* gl_widget() const { return gl_; }
  [[nodiscard]] vtkCamera* camera() const;

  /// Adds a surface of the default material; it goes with remove() or the last holder.
  [[nodiscard]] std::shared_ptr<SceneSurface> add_surface();
  void remove(const std::shared_ptr<SceneSurface>& surface);

  /// Draws once, when the program next waits for events.
  void redraw();
  /// Pictures that redraw() and draw_now() have made.
  [[nodiscard]] std::int64_t frames() const { return frames_; }
  /// Draws now. @return seconds.
  double draw_now();
  /// Fits all that is there into the picture, and again when its size changes, until the camera is
  /// moved.
  /// @param other  Null, or a scene whose camera follows this one's: what is there is fitted, too.
  void look(LookFrom from, SceneWidget* other = nullptr);
  /// A small cross of the patient's axes in the corner: L, P, S.
  void set_axes_visible(bool visible);
  /// Draws transparent surfaces in the right order: slower.
  void set_transparency(bool on);
  void set_theme(const Theme& theme);
  /// As a drag of the mouse begins and ends: coarse surfaces while turning.
  void set_interacting(bool interacting);
  [[nodiscard]] bool interacting() const { return interacting_; }

 signals:
  void turned();  ///< The camera has moved; also while dragging.
  void maximise();

 protected:
  bool eventFilter(QObject* object, QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  void fit();

  vtkSmartPointer<vtkGenericOpenGLRenderWindow> window_;
  vtkSmartPointer<vtkRenderer> renderer_;
  QVTKOpenGLNativeWidget* gl_ = nullptr;
  struct Parts;
  std::unique_ptr<Parts> parts_;
  std::vector<std::weak_ptr<SceneSurface>> surfaces_;
  QPointer<SceneWidget> other_;
  std::vector<double> fitted_;  // camera after fit()
  bool interacting_ = false, waiting_ = false;
  std::int64_t frames_ = 0;
};

/// The camera as numbers: position, focus, view up, angle, and back; for sessions.
[[nodiscard]] std::vector<double> camera_numbers(vtkCamera* camera);
/// @throws std::invalid_argument  there are not 10 finite numbers.
void set_camera(vtkCamera* camera, const std::vector<double>& numbers);

}  // namespace shape3d::apps::viewer
