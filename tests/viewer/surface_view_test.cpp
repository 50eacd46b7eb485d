#include "surface_view.hpp"

#include <cmath>

#include <QVTKOpenGLNativeWidget.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkMapper.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <QApplication>
#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSlider>
#include <QTimer>
#include <QtTest/QTest>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "four_up.hpp"
#include "scene_widget.hpp"
#include "slice_widget.hpp"
#include "window_fixture.hpp"

namespace {
using namespace shape3d::apps::viewer;
using namespace shape3d::test;

struct Shown : WindowFixture {
  SurfaceView& surface = view<SurfaceView>("surface");
  FourUp* four = surface.four_up();

  explicit Shown(std::shared_ptr<const OpenVolume> volume) {
    document().set_volume(std::move(volume));
    document().set_window({1e6, 1.0});  // black slices: the lines stand out
    show("surface");
  }
  template <class Widget>
  Widget* control(const char* name) {
    auto* widget = surface.panel()->findChild<Widget*>(name);
    REQUIRE(widget != nullptr);
    return widget;
  }
  /// Distance in samples from the middle to the outline along +i in the axial slice.
  double radius_in_slice() {
    SliceWidget* axial = four->slice(2);
    const QImage picture = grab(axial);
    const QColor color = surface_color(0);
    const Eigen::Vector3d middle = document().cursor();
    // Off the crosshair, which is drawn over the line.
    const double j = middle[1] + 4.0;
    const QPoint from = axial->pixel_of({middle[0], j, middle[2]}).toPoint();
    for (int x = picture.width() - 1; x > from.x(); --x) {
      if (count_color(picture.copy(x, from.y(), 1, 1), color, 60) == 0) continue;
      const double i = axial->lattice_at(QPointF(x + 0.5, from.y() + 0.5))[0];
      return std::hypot(i - 31.5, j - 31.5);
    }
    return -1.0;
  }
};

TEST_CASE("dragging the slider gives coarse surfaces at once and the full one on release",
          "[viewer][surface]") {
  Shown shown(ball_volume(64));
  auto* slider = shown.control<QSlider>("isovalue-slider");
  shown.control<QDoubleSpinBox>("isovalue")->setValue(800.0);  // radius 10
  REQUIRE(shown.settle());
  const std::int64_t triangles = shown.surface.triangles();
  const int pixels = edge_count(WindowFixture::grab(shown.four->scene()), 10);
  CHECK(shown.radius_in_slice() == Approx(10.0).margin(0.35));

  const std::int64_t coarse = shown.surface.coarse_updates(), full = shown.surface.full_updates();
  const QPoint from = handle_of(slider, slider->value());
  const QPoint to = handle_of(slider, slider->minimum() + 500);
  std::int64_t coarse_while_dragging = 0, full_while_dragging = 0;
  drag(slider, from, to, Qt::LeftButton, 10, [&] {
    REQUIRE(shown.wait_until([&] { return shown.surface.coarse_updates() > coarse; }));
    coarse_while_dragging = shown.surface.coarse_updates() - coarse;
    full_while_dragging = shown.surface.full_updates() - full;
  });
  REQUIRE(shown.settle());
  CHECK(coarse_while_dragging >= 1);
  CHECK(full_while_dragging == 0);
  CHECK(shown.surface.full_updates() == full + 1);

  // The surface is the sphere of that isovalue: its outline has its radius, its triangles grow with
  // its area, r² (about 2 for a unit of area and a half each).
  const double radius = (1000.0 - shown.surface.isovalue()) / 20.0;
  INFO("isovalue " << shown.surface.isovalue() << ", radius " << radius);
  CHECK(radius > 15.0);
  CHECK(shown.radius_in_slice() == Approx(radius).margin(0.35));
  CHECK(static_cast<double>(shown.surface.triangles()) / static_cast<double>(triangles) ==
        Approx(radius * radius / 100.0).epsilon(0.1));
  CHECK(edge_count(WindowFixture::grab(shown.four->scene()), 10) != pixels);

  // One step back is the whole drag.
  QTest::keyClick(&shown.window(), Qt::Key_Z, Qt::ControlModifier);
  REQUIRE(shown.settle());
  CHECK(shown.surface.isovalue() == Approx(800.0));
  CHECK(shown.surface.triangles() == triangles);
}

TEST_CASE("keys move the isovalue, show and hide contours", "[viewer][surface]") {
  Shown shown(ball_volume(64));
  shown.control<QDoubleSpinBox>("isovalue")->setValue(700.0);
  REQUIRE(shown.settle());
  SliceWidget* axial = shown.four->slice(2);
  const QColor color = surface_color(0);
  // A circle of radius 15 samples: 2π·15 samples of line, at least one pixel wide.
  const double scale = (axial->pixel_of({1.0, 0.0, 0.0}) - axial->pixel_of({0.0, 0.0, 0.0})).x();
  const int with = count_color(WindowFixture::grab(axial), color, 60);
  CHECK(with > 0.8 * 2.0 * 3.14159 * 15.0 * std::abs(scale));
  QTest::keyClick(shown.surface.content(), Qt::Key_C);
  CHECK(count_color(WindowFixture::grab(axial), color, 60) < with / 4);
  QTest::keyClick(shown.surface.content(), Qt::Key_C);
  CHECK(count_color(WindowFixture::grab(axial), color, 60) == with);

  const double before = shown.surface.isovalue();
  for (int n = 0; n < 5; ++n) QTest::keyClick(shown.surface.content(), Qt::Key_BracketRight);
  REQUIRE(shown.settle());
  CHECK(shown.surface.isovalue() > before);
  CHECK(shown.radius_in_slice() == Approx((1000.0 - shown.surface.isovalue()) / 20.0).margin(0.35));
}

TEST_CASE("zero faces and non-manifold edges are counted and marked on demand",
          "[viewer][surface]") {
  // Two blocks of positive samples that touch along an edge of zeros, and a plane of zeros between
  // a positive and a negative half.
  Shown shown(made_volume({24, 24, 24}, [](std::int64_t i, std::int64_t j, std::int64_t) {
    if (j > 12) return j > 18 ? -10.0 : (j == 18 ? 0.0 : 10.0);
    if (i == 12 && j == 8) return 0.0;
    return (i < 12) == (j < 8) && i != 12 && j != 8 ? 10.0 : -10.0;
  }));
  shown.control<QDoubleSpinBox>("isovalue")->setValue(0.0);
  REQUIRE(shown.settle());
  SceneWidget* scene = shown.four->scene();
  const QColor red = QColor::fromRgbF(0.95, 0.15, 0.15);
  CHECK(count_color(WindowFixture::grab(scene), red, 30) == 0);
  QTest::keyClick(shown.surface.content(), Qt::Key_H);
  REQUIRE(shown.settle());
  CHECK(shown.control<QCheckBox>("marks")->isChecked());
  // The plane j = 18 has 23 × 23 cell faces of four zeros.
  CHECK(shown.control<QLabel>("facts")->text().contains("529 zero faces"));
  scene->look(LookFrom::back);
  REQUIRE(shown.settle());
  CHECK(count_color(WindowFixture::grab(scene), red, 30) > 2000);
  QTest::keyClick(shown.surface.content(), Qt::Key_H);
  REQUIRE(shown.settle());
  CHECK(count_color(WindowFixture::grab(scene), red, 30) == 0);
}

TEST_CASE("vtkFlyingEdges3D's surface takes the place of ZMC's and back", "[viewer][surface]") {
  Shown shown(ball_volume(64));
  shown.control<QDoubleSpinBox>("isovalue")->setValue(700.5);  // no sample has it
  REQUIRE(shown.settle());
  const QImage zmc = WindowFixture::grab(shown.four->scene());
  const std::int64_t triangles = shown.surface.triangles();
  QTest::keyClick(shown.surface.content(), Qt::Key_F);
  REQUIRE(shown.settle());
  CHECK(shown.control<QComboBox>("method")->currentIndex() == 1);
  CHECK(shown.control<QLabel>("facts")->text().contains("vtkFlyingEdges3D"));
  const QImage flying = WindowFixture::grab(shown.four->scene());
  // The same sphere in the same place and shade, for its cells have no ambiguous faces.
  CHECK(changed_pixels(zmc, flying, 40) < zmc.width() * zmc.height() / 200);
  CHECK(static_cast<double>(shown.surface.triangles()) ==
        Approx(static_cast<double>(triangles)).epsilon(0.02));
}

TEST_CASE("surfaces are added, made transparent and removed", "[viewer][surface]") {
  Shown shown(ball_volume(64));
  REQUIRE(shown.surface.surface_count() == 1);
  shown.control<QDoubleSpinBox>("isovalue")->setValue(850.0);
  REQUIRE(shown.settle());
  auto* add = shown.surface.panel()->findChildren<QPushButton*>().at(0);
  QTest::mouseClick(add, Qt::LeftButton);
  REQUIRE(shown.surface.surface_count() == 2);
  shown.control<QDoubleSpinBox>("isovalue")->setValue(500.0);  // radius 25 round radius 7.5
  auto* opacity = shown.control<QSlider>("opacity");
  opacity->setValue(100);
  REQUIRE(shown.settle());
  const QImage opaque = WindowFixture::grab(shown.four->scene());
  opacity->setValue(30);
  REQUIRE(shown.settle());
  const QImage clear = WindowFixture::grab(shown.four->scene());
  // The inner sphere is seen through the outer one now.
  CHECK(changed_pixels(opaque, clear) > 3000);
  const QPoint middle(clear.width() / 2, clear.height() / 2);
  const QColor through = clear.pixelColor(middle), before = opaque.pixelColor(middle);
  CHECK(through.blueF() - through.redF() > before.blueF() - before.redF());
  QTest::keyClick(&shown.window(), Qt::Key_R);
  REQUIRE(shown.settle());
  CHECK(shown.surface.surface_count() == 1);
  QTest::keyClick(&shown.window(), Qt::Key_Z, Qt::ControlModifier);
  REQUIRE(shown.settle());
  CHECK(shown.surface.surface_count() == 2);
}

TEST_CASE("a colour that is chosen is that of the surface and its contours", "[viewer][surface]") {
  Shown shown(ball_volume(64));
  shown.control<QDoubleSpinBox>("isovalue")->setValue(600.0);
  REQUIRE(shown.settle());
  const QColor green(20, 220, 30);
  SliceWidget* axial = shown.four->slice(2);
  CHECK(count_color(WindowFixture::grab(axial), green, 30) == 0);
  QTimer::singleShot(300, [green] {
    auto* dialog = qobject_cast<QColorDialog*>(QApplication::activeModalWidget());
    if (dialog == nullptr) return;
    dialog->setCurrentColor(green);
    QTest::keyClick(dialog, Qt::Key_Return);
  });
  QTest::mouseClick(shown.control<QPushButton>("color"), Qt::LeftButton);
  REQUIRE(shown.settle());
  CHECK(shown.surface.state()["surfaces"][0]["color"] == green.name().toStdString());
  CHECK(count_color(WindowFixture::grab(axial), green, 30) > 200);
  const QImage scene = WindowFixture::grab(shown.four->scene());
  const QColor middle = scene.pixelColor(scene.width() / 2, scene.height() / 2);
  CHECK(middle.green() > middle.red() + 60);
  CHECK(middle.green() > middle.blue() + 60);
  shown.window().activateWindow();  // without a window manager the dialog leaves no window active
  REQUIRE(QTest::qWaitForWindowActive(&shown.window()));
  QTest::keyClick(&shown.window(), Qt::Key_Z, Qt::ControlModifier);
  REQUIRE(shown.settle());
  CHECK(count_color(WindowFixture::grab(axial), green, 30) == 0);
}

// The most triangles that one actor of a scene draws now.
vtkIdType drawn_triangles(SceneWidget* scene) {
  vtkIdType most = 0;
  vtkActorCollection* actors = scene->renderer()->GetActors();
  actors->InitTraversal();
  while (vtkActor* actor = actors->GetNextActor()) {
    auto* data = vtkPolyData::SafeDownCast(actor->GetMapper()->GetInputAsDataSet());
    if (actor->GetVisibility() != 0 && data != nullptr)
      most = std::max(most, data->GetNumberOfPolys());
  }
  return most;
}

TEST_CASE("a large surface is turned as a coarse one and whole again after it",
          "[viewer][surface]") {
  Shown shown(ball_volume(176));
  shown.control<QDoubleSpinBox>("isovalue")->setValue(-600.0);  // radius 80
  REQUIRE(shown.settle());
  SceneWidget* scene = shown.four->scene();
  const vtkIdType whole = shown.surface.triangles();
  REQUIRE(whole > 100'000);
  CHECK(drawn_triangles(scene) == whole);
  const QImage before = WindowFixture::grab(scene);
  QImage turning;
  vtkIdType coarse = 0;
  drag(scene->gl_widget(), {120, 120}, {122, 120}, Qt::LeftButton, 2, [&] {
    coarse = drawn_triangles(scene);
    turning = WindowFixture::grab(scene);
  });
  CHECK(coarse > 15'000);
  CHECK(coarse < 70'000);
  // Nearly the same picture.
  CHECK(changed_pixels(before, turning, 40) < before.width() * before.height() / 20);
  REQUIRE(shown.settle());
  CHECK(drawn_triangles(scene) == whole);
}

TEST_CASE("an empty surface is a sentence, not a crash", "[viewer][surface]") {
  Shown shown(made_volume({8, 8, 8}, [](std::int64_t, std::int64_t, std::int64_t) { return 7.0; }));
  CHECK(shown.control<QLabel>("facts")->text().startsWith("The surface is empty"));
  CHECK(shown.surface.triangles() == 0);
  CHECK(shown.window().message().isEmpty());
}

}  // namespace
