#include "map_view.hpp"

#include <algorithm>
#include <fstream>

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QListWidget>
#include <QtTest/QTest>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "common/color_map.hpp"
#include "four_up.hpp"
#include "scene_widget.hpp"
#include "small_map.hpp"
#include "som_widget.hpp"
#include "surface_view.hpp"
#include "thumbnail_grid.hpp"
#include "window_fixture.hpp"

namespace {
using namespace shape3d::apps;
using namespace shape3d::apps::viewer;
using namespace shape3d::test;
using Catch::Matchers::Contains;

struct Shown : WindowFixture {
  SmallLibrary small;
  MapView& view_ = view<MapView>("map");
  SomWidget* som = view_.som();
  ThumbnailGrid* grid = view_.grid();

  explicit Shown(bool with_library = true) {
    window().open(QString::fromStdString(write_map(small)));
    if (with_library) window().open(QString::fromStdString(small.path));
    show("map");
  }
  template <class Widget>
  Widget* control(const char* name) {
    auto* widget = view_.panel()->findChild<Widget*>(name);
    REQUIRE(widget != nullptr);
    return widget;
  }
  // The unit with the most shapes.
  int fullest() {
    const auto& hits = view_.map()->model.hits;
    return static_cast<int>(std::max_element(hits.begin(), hits.end()) - hits.begin());
  }
  void click_unit(int unit) {
    QTest::mouseClick(som, Qt::LeftButton, Qt::NoModifier, som->place_of(unit).toPoint());
    REQUIRE(settle());
  }
};

bool near(const QColor& a, const Color& b) {
  return std::abs(a.redF() - b[0]) < 0.02 && std::abs(a.greenF() - b[1]) < 0.02 &&
         std::abs(a.blueF() - b[2]) < 0.02;
}

TEST_CASE("units have the colours of their classes, and the U-matrix those of its numbers",
          "[viewer][map]") {
  Shown shown;
  const CollectionMap& map = *shown.view_.map();
  const QImage picture = WindowFixture::grab(shown.som);
  const QPointF step = shown.som->place_of(1) - shown.som->place_of(0);
  int plates = 0, rods = 0;
  for (int unit = 0; unit < map.units(); ++unit) {
    CHECK(shown.som->unit_at(shown.som->place_of(unit)) == unit);
    // Off the text in the middle.
    const QPoint at = (shown.som->place_of(unit) - 0.45 * QPointF(0, step.x())).toPoint();
    const std::string name = map.class_of(unit);
    INFO(unit << " " << name);
    if (name.empty()) continue;
    CHECK(near(picture.pixelColor(at), light_color(name == "plate" ? 0 : 1)));
    (name == "plate" ? plates : rods) += 1;
  }
  CHECK(plates > 0);
  CHECK(rods > 0);
  // The element between two units, in the left part: as far to the left as the parts are apart.
  ColorScale scale;
  scale.lower = map.u_matrix.values.minCoeff();
  scale.upper = map.u_matrix.values.maxCoeff();
  const QPointF apart = shown.som->place_in_matrix(0) - shown.som->place_of(0);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column + 1 < 3; ++column) {
      const int unit = 3 * row + column;
      const QPointF between =
          (shown.som->place_of(unit) + shown.som->place_of(unit + 1)) / 2 + apart;
      const double value = map.u_matrix.values(2 * row, 2 * column + 1);
      INFO(row << " " << column << " " << value);
      CHECK(
          near(picture.pixelColor(between.toPoint()), color_at(scale.map, scale.share_of(value))));
    }
  }
}

TEST_CASE("a click on a unit lists its shapes with pictures", "[viewer][map]") {
  Shown shown;
  auto* list = shown.control<QListWidget>("shapes");
  CHECK(list->count() == 0);
  CHECK(shown.grid->cells().empty());
  const QImage before = WindowFixture::grab(shown.som);
  std::size_t seen = 0;
  for (int unit = 0; unit < 12; ++unit) {
    shown.click_unit(unit);
    CHECK(shown.som->chosen() == unit);
    const auto hits =
        static_cast<std::size_t>(shown.view_.map()->model.hits[static_cast<std::size_t>(unit)]);
    INFO(unit << ": " << hits);
    REQUIRE(shown.view_.shapes().size() == hits);
    REQUIRE(shown.grid->cells().size() == hits);
    REQUIRE(list->count() == static_cast<int>(hits));
    for (std::size_t n = 0; n < hits; ++n) {
      const UnitShape& shape = shown.view_.shapes()[n];
      const std::string stem = std::filesystem::path(shape.path).stem().string();
      CHECK(shown.grid->cells()[n].first.toStdString() == stem);
      CHECK(shown.grid->cells()[n].second.toStdString() == *shape.class_name);
      CHECK_THAT(list->item(static_cast<int>(n))->text().toStdString(),
                 Contains(stem) && Contains(*shape.class_name));
    }
    seen += hits;
  }
  CHECK(seen == 8);
  shown.click_unit(shown.fullest());
  CHECK(changed_pixels(before, WindowFixture::grab(shown.som)) > 100);  // it is marked
  const QImage inside = WindowFixture::grab(shown.grid->viewport())
                            .copy(shown.grid->picture_area(0).adjusted(2, 2, -2, -2));
  const int all = inside.width() * inside.height();
  CHECK(count_color(inside, Qt::white, 2) < 97 * all / 100);
  CHECK(count_color(inside, Qt::white, 2) > all / 10);
  CHECK_THAT(shown.control<QLabel>("unit")->text().toStdString(), Contains("Row "));

  // The left part is for clicks as well; beside the map nothing is chosen.
  QTest::mouseClick(shown.som, Qt::LeftButton, Qt::NoModifier,
                    shown.som->place_in_matrix(5).toPoint());
  CHECK(shown.som->chosen() == 5);
  QTest::mouseClick(shown.som, Qt::LeftButton, Qt::NoModifier, QPoint(2, 2));
  CHECK(shown.som->chosen() == -1);
  CHECK(list->count() == 0);
  shown.window().undo();
  CHECK(shown.som->chosen() == 5);
}

TEST_CASE("a click on a shape of a unit opens it", "[viewer][map]") {
  Shown shown;
  shown.click_unit(shown.fullest());
  const std::string path = shown.view_.shapes()[0].path;
  QWidget* sheet = shown.grid->widget();
  QTest::mouseClick(sheet, Qt::LeftButton, Qt::NoModifier,
                    shown.grid->picture_area(0).center() - sheet->pos());
  REQUIRE(shown.wait_until([&] { return !shown.document().meshes().empty(); }));
  REQUIRE(shown.settle());
  CHECK(shown.window().current()->name() == "surface");
  CHECK(shown.document().meshes()[0]->path == path);
  CHECK(edge_count(WindowFixture::grab(shown.view<SurfaceView>("surface").four_up()->scene()), 10) >
        100);
}

TEST_CASE("without the library the map says what it knows of a unit", "[viewer][map]") {
  Shown shown(false);
  const int unit = shown.fullest();
  shown.click_unit(unit);
  CHECK(shown.grid->cells().empty());
  CHECK_THAT(shown.grid->heading().toStdString(),
             Contains(shown.view_.map()->model.names[static_cast<std::size_t>(unit)]) &&
                 Contains("Open the collection's shape library"));
  // The library comes later: the unit stays chosen.
  shown.window().open(QString::fromStdString(shown.small.path));
  shown.show("map");
  CHECK(shown.som->chosen() == unit);
  CHECK_FALSE(shown.grid->cells().empty());
}

TEST_CASE("labels and borders can be changed, and go into the session", "[viewer][map]") {
  Shown shown;
  const QImage classes = WindowFixture::grab(shown.som);
  auto* labels = shown.control<QComboBox>("labels");
  labels->setFocus();
  QTest::keyClick(labels, Qt::Key_Down);
  REQUIRE(shown.settle());
  const QImage names = WindowFixture::grab(shown.som);
  CHECK(changed_pixels(classes, names) > 50);
  QTest::mouseClick(shown.control<QCheckBox>("borders"), Qt::LeftButton, Qt::NoModifier,
                    QPoint(8, 8));
  REQUIRE(shown.settle());
  CHECK(changed_pixels(names, WindowFixture::grab(shown.som)) > 100);
  shown.click_unit(4);
  const Session session = shown.window().session();
  CHECK(session.views["map"] ==
        nlohmann::json({{"unit", {2, 2}}, {"labels", "shape"}, {"borders", false}}));
  CHECK(session.files.size() == 2);
  shown.window().reset();
  CHECK(shown.som->chosen() == -1);
  shown.document().close_all();
  CHECK_FALSE(shown.view_.missing().isEmpty());
  shown.window().apply(session);
  REQUIRE(shown.settle());
  CHECK(shown.window().current()->name() == "map");
  CHECK(shown.view_.state() == session.views["map"]);
  CHECK(shown.view_.shapes().size() == static_cast<std::size_t>(shown.view_.map()->model.hits[4]));

  CHECK_THROWS_WITH(shown.view_.set_state({{"unit", {0, 1}}}), Contains("from [1, 1] to [4, 3]"));
  CHECK_THROWS_WITH(shown.view_.set_state({{"unit", {5, 1}}}), Contains("from [1, 1] to [4, 3]"));
  CHECK_THROWS_WITH(shown.view_.set_state({{"labels", "colour"}}),
                    Contains("expected class or shape"));
}

TEST_CASE("a file that is no map, and another collection's library, are said", "[viewer][map]") {
  Shown shown;
  const std::string fake = (shown.small.folder / "fake.model").string();
  std::ofstream(fake) << "no model";
  shown.window().open(QString::fromStdString(fake));
  CHECK_THAT(shown.window().message().toStdString(), Contains("fake.model: "));
  CHECK(shown.view_.missing().isEmpty());  // the one before stays
  shown.window().open(QString::fromStdString(write_map(shown.small, "egi:K=4,align=none")));
  REQUIRE(shown.settle());
  shown.click_unit(0);
  CHECK_THAT(shown.grid->heading().toStdString(), Contains("boxes.db: "));
}

}  // namespace
