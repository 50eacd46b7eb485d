#include "segmentation_view.hpp"

#include <cmath>
#include <cstdint>

#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QtTest/QTest>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "chart_widget.hpp"
#include "common/output_file.hpp"
#include "common/volume_write.hpp"
#include "four_up.hpp"
#include "slice_widget.hpp"
#include "window_fixture.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::apps::viewer;
using namespace shape3d::test;

// A bright ball with a smooth border in a dark surrounding, with noise.
std::shared_ptr<const OpenVolume> noisy_ball(int n, double radius) {
  std::uint32_t state = 7;
  const double middle = (n - 1) / 2.0;
  return made_volume({n, n, n}, [=](std::int64_t i, std::int64_t j, std::int64_t k) mutable {
    state = state * 1664525U + 1013904223U;
    const double noise = static_cast<double>(state >> 8) / (1 << 24) - 0.5;
    const double distance =
        Eigen::Vector3d(static_cast<double>(i) - middle, static_cast<double>(j) - middle,
                        static_cast<double>(k) - middle)
            .norm();
    return 500.0 / (1.0 + std::exp(2.0 * (distance - radius))) + 60.0 * noise;
  });
}

struct Shown : WindowFixture {
  SegmentationView& view_ = view<SegmentationView>("segmentation");
  FourUp* four = view_.four_up();

  explicit Shown(std::shared_ptr<const OpenVolume> volume) {
    document().set_volume(std::move(volume));
    show("segmentation");
  }
  template <class Widget>
  Widget* control(const char* name) {
    auto* widget = view_.panel()->findChild<Widget*>(name);
    REQUIRE(widget != nullptr);
    return widget;
  }
};

TEST_CASE("a region is drawn in a slice, its sides are moved, and typed",
          "[viewer][segmentation]") {
  Shown shown(noisy_ball(48, 12.0));
  QTest::keyClick(shown.view_.content(), Qt::Key_D);
  CHECK(shown.control<QPushButton>("draw")->isChecked());
  SliceWidget* axial = shown.four->slice(2);
  const auto at = [axial](double i, double j) { return axial->pixel_of({i, j, 24.0}).toPoint(); };
  // From a place away from the box that is there at first (12 … 36).
  drag(axial, at(4.0, 5.0), at(40.0, 42.0), Qt::LeftButton);
  const VoxelBox drawn = shown.view_.region();
  CHECK(drawn.lower == std::array<std::int64_t, 3>{4, 5, 12});
  CHECK(drawn.upper == std::array<std::int64_t, 3>{41, 43, 36});
  CHECK(shown.control<QSpinBox>("region-0")->value() == 4);
  CHECK(shown.control<QSpinBox>("region-3")->value() == 43);
  // The right side, nearer to the middle.
  drag(axial, at(40.5, 20.0), at(30.5, 20.0), Qt::LeftButton);
  CHECK(shown.view_.region().upper[0] == 31);
  CHECK(shown.view_.region().lower[0] == 4);
  shown.control<QSpinBox>("region-4")->setValue(2);
  CHECK(shown.view_.region().lower[2] == 2);
  // Undo: typing, moving, drawing.
  for (int n = 0; n < 3; ++n) QTest::keyClick(&shown.window(), Qt::Key_Z, Qt::ControlModifier);
  CHECK(shown.view_.region() == VoxelBox{{12, 12, 12}, {36, 36, 36}});
}

TEST_CASE("segmenting finds the ball while the front is seen moving", "[viewer][segmentation]") {
  Shown shown(noisy_ball(96, 20.0));
  QTest::mouseClick(shown.control<QPushButton>("whole"), Qt::LeftButton);
  const QImage before = WindowFixture::grab(shown.four->slice(2));
  QTest::mouseClick(shown.control<QPushButton>("run"), Qt::LeftButton);
  CHECK(shown.view_.busy());
  CHECK(shown.control<QPushButton>("cancel")->isEnabled());
  REQUIRE(shown.wait_until([&] { return shown.view_.frames() > 0 || !shown.view_.busy(); }));
  CHECK(shown.view_.frames() > 0);
  CHECK(shown.control<QLabel>("stage")->text().startsWith("evolution, iteration"));
  const QImage moving = WindowFixture::grab(shown.four->slice(2));
  REQUIRE(shown.settle());
  CHECK(changed_pixels(before, moving) > 100);
  const SegmentOutcome& found = shown.view_.outcome();
  REQUIRE(found.segmentation);
  CHECK(found.error.empty());
  CHECK(found.segmentation->status == levelset::Status::converged);
  // The volume of a ball of radius 20; a tenth of a voxel of the radius is 1.5 %.
  CHECK(found.segmentation->volume == Approx(4.0 / 3.0 * 3.14159265 * 8000.0).epsilon(0.03));
  CHECK(shown.control<QLabel>("facts")->text().contains("the front came to rest"));
  // The outline is in the slice, the surface in the scene, the curves in the charts.
  CHECK(count_color(WindowFixture::grab(shown.four->slice(2)), QColor(80, 160, 255), 50) >
        count_color(before, QColor(80, 160, 255), 50) + 100);
  CHECK(shown.view_.histogram()->isVisible());
  CHECK(shown.view_.histogram()->chart().series.size() == 4);
  CHECK(edge_count(WindowFixture::grab(shown.view_.histogram())) > 500);
  CHECK(shown.view_.overlap()->chart().series.front().points.size() >= 7);
  CHECK(edge_count(WindowFixture::grab(shown.view_.overlap())) > 300);
  QTest::keyClick(shown.view_.content(), Qt::Key_G);
  CHECK_FALSE(shown.view_.histogram()->isVisible());
  // The slice is as large as before now: the front has moved on since.
  REQUIRE(shown.settle());
  CHECK(changed_pixels(moving, WindowFixture::grab(shown.four->slice(2))) > 100);
}

TEST_CASE("a run is cancelled", "[viewer][segmentation]") {
  Shown shown(noisy_ball(128, 40.0));
  shown.view_.set_state({{"roi", {0, 128, 0, 128, 0, 128}}});
  shown.view_.run();
  QTest::mouseClick(shown.control<QPushButton>("cancel"), Qt::LeftButton);
  REQUIRE(shown.settle());
  CHECK(shown.view_.outcome().cancelled);
  CHECK(shown.control<QPushButton>("run")->isEnabled());
  CHECK(shown.window().failures().empty());
}

TEST_CASE("Enter segments, Esc cancels when the front is on its way", "[viewer][segmentation]") {
  Shown shown(noisy_ball(128, 40.0));
  shown.view_.set_state({{"roi", {0, 128, 0, 128, 0, 128}}});
  QTest::keyClick(shown.view_.content(), Qt::Key_Return);
  CHECK(shown.view_.busy());
  REQUIRE(shown.wait_until([&] { return shown.view_.frames() > 0 || !shown.view_.busy(); }));
  CHECK(shown.view_.frames() > 0);
  QTest::keyClick(shown.view_.content(), Qt::Key_Escape);
  REQUIRE(shown.settle());
  CHECK(shown.view_.outcome().cancelled);
  CHECK_FALSE(shown.control<QPushButton>("cancel")->isEnabled());
}

TEST_CASE("the result is compared with a mask, drawn in red", "[viewer][segmentation]") {
  const auto volume = noisy_ball(64, 15.0);
  Shown shown(volume);
  const QTemporaryDir folder;
  const std::string path = folder.filePath("mask.nrrd").toStdString();
  std::vector<std::uint8_t> mask;
  for (int k = 0; k < 64; ++k) {
    for (int j = 0; j < 64; ++j) {
      for (int i = 0; i < 64; ++i)
        mask.push_back(Eigen::Vector3d(i - 31.5, j - 31.5, k - 31.5).norm() <= 15.0 ? 1 : 0);
    }
  }
  {
    OutputFile file(path);
    zmc::VolumeView view = volume->volume.view;
    view.data = mask.data();
    view.type = zmc::SampleType::uint8;
    write_volume(file, VolumeFormat::nrrd, view);
    file.commit();
  }
  shown.view_.set_state({{"roi", {0, 64, 0, 64, 0, 64}}, {"truth", path}, {"run", true}});
  REQUIRE(shown.settle());
  REQUIRE(shown.view_.outcome().agreement);
  CHECK(shown.view_.outcome().agreement->dice > 0.97);
  CHECK(shown.control<QLabel>("facts")->text().contains("Dice 0.9"));
  CHECK(count_color(WindowFixture::grab(shown.four->slice(2)), QColor(255, 90, 80), 45) > 30);
}

TEST_CASE("what cannot be segmented is a sentence", "[viewer][segmentation]") {
  Shown shown(
      made_volume({16, 16, 16}, [](std::int64_t, std::int64_t, std::int64_t) { return 3.0; }));
  shown.view_.run();
  REQUIRE(shown.settle());
  CHECK(shown.window().message().contains("cannot be segmented"));
  // The ball starts at the crosshair, which is outside the region.
  Shown other(noisy_ball(32, 8.0));
  other.document().set_cursor({1.0, 1.0, 1.0});
  other.view_.set_state({{"start", "ball"}, {"run", true}});
  CHECK(other.window().message().contains("crosshair is outside the region"));
  other.view_.set_state({{"start", "box"}, {"truth", "/none.nrrd"}, {"run", true}});
  REQUIRE(other.settle());
  CHECK(other.window().message().contains("no such file"));
  CHECK_THROWS_AS(other.view_.set_state({{"roi", {0, 33, 0, 32, 0, 32}}}), std::invalid_argument);
  CHECK_THROWS_AS(other.view_.set_state({{"classes", "many"}}), std::invalid_argument);
}

}  // namespace
