#include "volume_view.hpp"

#include <cmath>

#include <QVTKOpenGLNativeWidget.h>
#include <vtkRenderer.h>
#include <QApplication>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QtTest/QTest>
#include <catch2/catch.hpp>

#include "four_up.hpp"
#include "scene_widget.hpp"
#include "slice_widget.hpp"
#include "window_fixture.hpp"

namespace {
using namespace shape3d::apps::viewer;
using namespace shape3d::test;

// 40 × 60 × 30 samples, value i + 100 j, 0.5 × 1 × 2 mm apart: each value says where it is.
std::shared_ptr<const OpenVolume> ramp() {
  return made_volume(
      {40, 60, 30},
      [](std::int64_t i, std::int64_t j, std::int64_t) { return static_cast<double>(i + 100 * j); },
      {0.5, 1.0, 2.0});
}

TEST_CASE("volume view says what to open, and shows it then", "[viewer][volume]") {
  WindowFixture fixture;
  auto& view = fixture.view<VolumeView>("volume");
  CHECK(view.missing().startsWith("Open a volume"));
  CHECK_FALSE(view.content()->isVisible());
  fixture.document().set_volume(ramp());
  REQUIRE(fixture.settle());
  CHECK(view.missing().isEmpty());
  CHECK(view.content()->isVisible());
  for (int axis = 0; axis < 3; ++axis) {
    const QImage picture = WindowFixture::grab(view.four_up()->slice(axis));
    INFO("axis " << axis);
    CHECK(edge_count(picture) > 100);
  }
}

TEST_CASE("a click in a slice moves the crosshair of all, and the line says where it is",
          "[viewer][volume]") {
  WindowFixture fixture;
  fixture.document().set_volume(ramp());
  REQUIRE(fixture.settle());
  FourUp* four = fixture.view<VolumeView>("volume").four_up();
  SliceWidget* axial = four->slice(2);
  const QImage sagittal = WindowFixture::grab(four->slice(0));
  const QPoint at = axial->pixel_of({10.0, 50.0, 15.0}).toPoint();
  QTest::mouseClick(axial, Qt::LeftButton, Qt::NoModifier, at);
  const Eigen::Vector3d cursor = fixture.document().cursor();
  CHECK(cursor.isApprox(Eigen::Vector3d(10.0, 50.0, 15.0)));
  CHECK(four->slice(0)->slice() == 10);
  CHECK(four->slice(1)->slice() == 50);
  // Value i + 100 j, millimetres by the spacing.
  hover(axial, at);
  CHECK(four->readout().contains("voxel 10 50 15"));
  CHECK(four->readout().contains("value 5010"));
  QEvent leave(QEvent::Leave);
  QApplication::sendEvent(axial, &leave);
  CHECK(four->readout().startsWith("Crosshair"));
  CHECK(four->readout().contains("L 5.0  P 50.0  S 30.0 mm"));
  CHECK(changed_pixels(sagittal, WindowFixture::grab(four->slice(0))) > 50);
  hover(axial, {2, 2});
  CHECK(four->readout().contains("outside the volume"));
}

TEST_CASE("the slices show the samples where they are", "[viewer][volume]") {
  WindowFixture fixture;
  // A bright block: left half in i, first third in j.
  fixture.document().set_volume(
      made_volume({30, 30, 30}, [](std::int64_t i, std::int64_t j, std::int64_t) {
        return i < 15 && j < 10 ? 1000.0 : 0.0;
      }));
  fixture.document().set_window({500.0, 1000.0});
  REQUIRE(fixture.settle());
  SliceWidget* axial = fixture.view<VolumeView>("volume").four_up()->slice(2);
  const QImage picture = WindowFixture::grab(axial);
  for (const auto& [i, j] : {std::pair{4.0, 4.0}, {11.0, 6.0}, {20.0, 4.0}, {4.0, 20.0}}) {
    INFO("sample " << i << " " << j);
    const QPoint at = axial->pixel_of({i, j, 15.0}).toPoint();
    CHECK(qGray(picture.pixel(at)) == (i < 15 && j < 10 ? 255 : 0));
  }
}

TEST_CASE("right drag changes window and level, and one step of undo takes it back",
          "[viewer][volume]") {
  WindowFixture fixture;
  fixture.document().set_volume(ramp());
  REQUIRE(fixture.settle());
  auto& view = fixture.view<VolumeView>("volume");
  SliceWidget* axial = view.four_up()->slice(2);
  const Window before = fixture.document().window();
  const double grey = mean_grey(WindowFixture::grab(axial));
  // Up by half a side: the level falls by 1/2 · 1/4 of the range of 0 … 5939.
  const QPoint middle(axial->width() / 2, axial->height() / 2);
  drag(axial, middle, middle - QPoint(0, axial->height() / 2), Qt::RightButton);
  const Window after = fixture.document().window();
  const double share = (axial->height() / 2) / static_cast<double>(axial->height());
  CHECK(after.width == Approx(before.width));
  CHECK(after.level == Approx(before.level - share * 0.25 * 5939.0));
  CHECK(mean_grey(WindowFixture::grab(axial)) > grey + 5.0);
  CHECK(view.panel()->findChild<QDoubleSpinBox*>("level")->value() ==
        Approx(after.level).margin(0.06));
  QTest::keyClick(&fixture.window(), Qt::Key_Z, Qt::ControlModifier);
  CHECK(fixture.document().window().level == Approx(before.level));
  QTest::keyClick(&fixture.window(), Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
  CHECK(fixture.document().window().level == Approx(after.level));
}

TEST_CASE("presets set the windows that radiologists use", "[viewer][volume]") {
  WindowFixture fixture;
  fixture.document().set_volume(ramp());
  REQUIRE(fixture.settle());
  auto& view = fixture.view<VolumeView>("volume");
  auto* preset = view.panel()->findChild<QComboBox*>("preset");
  REQUIRE(preset != nullptr);
  const std::array<std::pair<const char*, Window>, 4> expected{{{"Lung", {-600, 1500}},
                                                                {"Bone", {500, 2000}},
                                                                {"Soft tissue", {40, 400}},
                                                                {"Abdomen", {60, 350}}}};
  for (const auto& [title, window] : expected) {
    INFO(title);
    preset->setFocus();
    const int row = preset->findText(title);
    REQUIRE(row >= 0);
    // As the user does: the list is open, a row is chosen.
    preset->setCurrentIndex(row);
    emit preset->activated(row);
    CHECK(fixture.document().window() == window);
    // The grey at a place, whose value is i + 100 j, is how far that is between the window's ends.
    SliceWidget* axial = view.four_up()->slice(2);
    const QPoint at = axial->pixel_of({10.0, 1.0, 15.0}).toPoint();
    const Eigen::Vector3d place = axial->lattice_at(QPointF(at) + QPointF(0.5, 0.5));
    const double value = place[0] + 100.0 * place[1];
    CHECK(qGray(WindowFixture::grab(axial).pixel(at)) ==
          Approx(255.0 * (value - window.black()) / window.width).margin(4.0));
  }
}

// How far the corners of the volume reach towards the sides of a scene: 1 is the side.
double reach(const FourUp& four, const Document& document) {
  SceneWidget* scene = four.scene();
  vtkRenderer* renderer = scene->renderer();
  const auto& view = document.volume()->volume.view;
  double most = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = (corner >> axis & 1) != 0
                    ? static_cast<double>(view.dims[static_cast<std::size_t>(axis)]) - 0.5
                    : -0.5;
    p = view.world(p);
    renderer->WorldToView(p[0], p[1], p[2]);
    most = std::max({most, std::abs(p[0]), std::abs(p[1])});
  }
  return most;
}

TEST_CASE("the volume fills the scene, also after its size has changed", "[viewer][volume]") {
  WindowFixture fixture;
  fixture.document().set_volume(ramp());
  REQUIRE(fixture.settle());
  const FourUp& four = *fixture.view<VolumeView>("volume").four_up();
  CHECK(reach(four, fixture.document()) == Approx(0.92).margin(0.01));
  fixture.window().resize(900, 720);
  REQUIRE(fixture.settle());
  CHECK(reach(four, fixture.document()) == Approx(0.92).margin(0.01));
  // A camera that the user has moved stays.
  drag(four.scene()->gl_widget(), {60, 60}, {90, 70}, Qt::LeftButton);
  REQUIRE(fixture.settle());
  const std::vector<double> camera = camera_numbers(four.scene()->camera());
  fixture.window().resize(1280, 720);
  REQUIRE(fixture.settle());
  CHECK(camera_numbers(four.scene()->camera()) == camera);
}

TEST_CASE("what is black in the slices is left out of the scene", "[viewer][volume]") {
  WindowFixture fixture;
  // A white ball in the middle of the air.
  fixture.document().set_volume(
      made_volume({40, 40, 40}, [](std::int64_t i, std::int64_t j, std::int64_t k) {
        return Eigen::Vector3d(double(i) - 19.5, double(j) - 19.5, double(k) - 19.5).norm() < 9.0
                   ? 1000.0
                   : -1000.0;
      }));
  fixture.document().set_window({0.0, 1000.0});
  REQUIRE(fixture.settle());
  SceneWidget* scene = fixture.view<VolumeView>("volume").four_up()->scene();
  const QImage picture = WindowFixture::grab(scene);
  CHECK(count_color(picture, Qt::white, 10) > 500);
  CHECK(count_color(picture, Qt::black, 8) < 50);
  fixture.document().set_window({-1500.0, 1000.0});  // the air is white, too
  REQUIRE(fixture.settle());
  CHECK(count_color(WindowFixture::grab(scene), Qt::white, 10) >
        4 * count_color(picture, Qt::white, 10));
}

TEST_CASE("the wheel goes through slices, Ctrl and the wheel zoom round the mouse",
          "[viewer][volume]") {
  WindowFixture fixture;
  fixture.document().set_volume(ramp());
  REQUIRE(fixture.settle());
  SliceWidget* axial = fixture.view<VolumeView>("volume").four_up()->slice(2);
  CHECK(axial->slice() == 15);
  wheel(axial, {50, 50}, 1);
  wheel(axial, {50, 50}, 1);
  CHECK(axial->slice() == 17);
  for (int n = 0; n < 40; ++n) wheel(axial, {50, 50}, -1);
  CHECK(axial->slice() == 0);  // and no further
  const QPoint at(axial->width() / 2 + 20, axial->height() / 2 + 10);
  const Eigen::Vector3d place = axial->lattice_at(at);
  wheel(axial, at, 3, Qt::ControlModifier);
  CHECK(axial->zoom() == Approx(1.2 * 1.2 * 1.2));
  CHECK(axial->lattice_at(at).isApprox(place, 1e-9));
}

TEST_CASE("Shift and the mouse move the crosshair, the middle button the slice, keys the rest",
          "[viewer][volume]") {
  WindowFixture fixture;
  fixture.document().set_volume(ramp());
  REQUIRE(fixture.settle());
  auto& view = fixture.view<VolumeView>("volume");
  SliceWidget* axial = view.four_up()->slice(2);
  const QPoint at = axial->pixel_of({12.0, 40.0, 15.0}).toPoint();
  hover(axial, at);
  CHECK(fixture.document().cursor().isApprox(Eigen::Vector3d(20.0, 30.0, 15.0)));
  hover(axial, at, Qt::ShiftModifier);
  CHECK(fixture.document().cursor().isApprox(Eigen::Vector3d(12.0, 40.0, 15.0)));

  const QImage before = WindowFixture::grab(axial);
  drag(axial, {100, 100}, {125, 90}, Qt::MiddleButton);
  const QPointF moved = axial->pixel_of({12.0, 40.0, 15.0}) - QPointF(at);
  CHECK(moved.x() == Approx(25.0).margin(1.0));
  CHECK(moved.y() == Approx(-10.0).margin(1.0));
  CHECK(changed_pixels(before, WindowFixture::grab(axial)) > 1000);

  QTest::keyClick(view.content(), Qt::Key_PageUp);
  QTest::keyClick(view.content(), Qt::Key_PageUp);
  CHECK(axial->slice() == 17);
  QTest::keyClick(view.content(), Qt::Key_PageDown);
  CHECK(axial->slice() == 16);

  SceneWidget* scene = view.four_up()->scene();
  REQUIRE(fixture.settle());
  const QImage planes = WindowFixture::grab(scene);
  QTest::keyClick(view.content(), Qt::Key_P);
  REQUIRE(fixture.settle());
  CHECK_FALSE(view.four_up()->planes_visible());
  CHECK(changed_pixels(planes, WindowFixture::grab(scene)) > 2000);
}

TEST_CASE("turning the scene moves the camera and changes the picture", "[viewer][volume]") {
  WindowFixture fixture;
  fixture.document().set_volume(ramp());
  REQUIRE(fixture.settle());
  SceneWidget* scene = fixture.view<VolumeView>("volume").four_up()->scene();
  const std::vector<double> camera = camera_numbers(scene->camera());
  const QImage before = WindowFixture::grab(scene);
  CHECK(edge_count(before, 15) > 300);  // planes, box, axes: not an empty picture
  bool coarse = false;
  QWidget* gl = scene->gl_widget();
  drag(gl, {100, 100}, {180, 120}, Qt::LeftButton, 6, [&] { coarse = scene->interacting(); });
  CHECK(coarse);
  CHECK_FALSE(scene->interacting());
  REQUIRE(fixture.settle());
  CHECK(camera_numbers(scene->camera()) != camera);
  CHECK(changed_pixels(before, WindowFixture::grab(scene)) > 2000);
}

TEST_CASE("a double click shows one of the four alone, and all again", "[viewer][volume]") {
  WindowFixture fixture;
  fixture.document().set_volume(ramp());
  REQUIRE(fixture.settle());
  FourUp* four = fixture.view<VolumeView>("volume").four_up();
  SliceWidget* axial = four->slice(2);
  const int width = axial->width();
  QTest::mouseDClick(axial, Qt::LeftButton);
  REQUIRE(fixture.settle());
  CHECK(axial->width() > 1.8 * width);
  CHECK_FALSE(four->slice(0)->isVisible());
  CHECK_FALSE(four->scene()->isVisible());
  QTest::mouseDClick(axial, Qt::LeftButton);
  REQUIRE(fixture.settle());
  CHECK(axial->width() == width);
  CHECK(four->scene()->isVisible());
}

}  // namespace
