#include "search_view.hpp"

#include <fstream>

#include <QComboBox>
#include <QDropEvent>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMimeData>
#include <QPushButton>
#include <QSpinBox>
#include <QUrl>
#include <QtTest/QTest>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "four_up.hpp"
#include "scene_widget.hpp"
#include "small_library.hpp"
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
  SearchView& search = view<SearchView>("search");
  ThumbnailGrid* grid = search.grid();

  Shown() {
    window().open(QString::fromStdString(small.path));
    REQUIRE(settle());
  }
  template <class Widget>
  Widget* control(const char* name) {
    auto* widget = search.panel()->findChild<Widget*>(name);
    REQUIRE(widget != nullptr);
    return widget;
  }
  void click(std::size_t cell, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QWidget* sheet = grid->widget();
    const QPoint at = grid->picture_area(cell).center() - sheet->pos();
    QTest::mouseClick(sheet, Qt::LeftButton, modifiers, at);
    REQUIRE(settle());
  }
  void choose(std::int64_t id) {
    search.set_state({{"query", id}});
    REQUIRE(settle());
  }
  std::string shown_error() { return window().message().toStdString(); }
  // Of the frame, in the picture of the window.
  QColor frame_in_picture(std::size_t cell) {
    const QImage picture = grab(grid->viewport());
    const QRect inner = grid->picture_area(cell);
    return picture.pixelColor(inner.left() - 3, inner.center().y());
  }
};

QColor to_qt(const Color& color) { return QColor::fromRgbF(color[0], color[1], color[2]); }

bool near(const QColor& a, const QColor& b) {
  return std::abs(a.red() - b.red()) < 4 && std::abs(a.green() - b.green()) < 4 &&
         std::abs(a.blue() - b.blue()) < 4;
}

TEST_CASE("a library shows its shapes, drawn where it has no pictures", "[viewer][search]") {
  Shown shown;
  CHECK(shown.window().current()->name() == "search");
  CHECK(shown.search.missing().isEmpty());
  REQUIRE(shown.grid->cells().size() == 8);
  CHECK(shown.grid->cells()[0].first == "plate0");
  CHECK(shown.grid->cells()[1].second == "rod");
  const QImage picture = WindowFixture::grab(shown.grid->viewport());
  for (const std::size_t cell : {0U, 1U}) {
    // A grey shape on white paper; a rod covers about a tenth of it.
    const QImage inside = picture.copy(shown.grid->picture_area(cell).adjusted(2, 2, -2, -2));
    const int paper = count_color(inside, Qt::white, 2);
    const int all = inside.width() * inside.height();
    INFO(cell << ": " << paper << " of " << all);
    CHECK(paper > all / 10);
    CHECK(paper < 97 * all / 100);
  }
}

TEST_CASE("a click on a shape finds those like it, in frames of their class", "[viewer][search]") {
  Shown shown;
  shown.click(0);
  const SearchResult& result = shown.search.result();
  CHECK(result.wish.id == 1);
  REQUIRE(result.found.size() == 7);
  const auto& cells = shown.grid->cells();
  REQUIRE(cells.size() == 8);
  CHECK(cells[0].third == "query");
  CHECK(near(shown.frame_in_picture(0), to_qt(kQueryFrame)));
  double before = 0.0;
  for (std::size_t n = 1; n < 8; ++n) {
    const Found& found = result.found[n - 1];
    INFO(n << " " << found.model.file.path);
    CHECK(found.match.distance >= before);
    before = found.match.distance;
    const bool plate = found.model.class_name == "plate";
    CHECK(plate == (n <= 3));
    CHECK(cells[n].second == (plate ? "plate" : "rod"));
    CHECK(cells[n].third.toStdString() ==
          "distance " + QString::number(found.match.distance, 'g', 4).toStdString());
    if (shown.grid->viewport()->rect().contains(shown.grid->picture_area(n)))
      CHECK(near(shown.frame_in_picture(n), to_qt(plate ? kSameClassFrame : kOtherClassFrame)));
  }
  CHECK_THAT(shown.control<QLabel>("facts")->text().toStdString(),
             Contains("3 of 7 matches are of the query's class"));
}

TEST_CASE("a click on a match opens it, and it is seen", "[viewer][search]") {
  Shown shown;
  shown.choose(1);
  const std::string first = shown.search.result().found[0].model.file.path;
  const std::string second = shown.search.result().found[5].model.file.path;
  shown.click(1);
  REQUIRE(shown.wait_until([&] { return !shown.document().meshes().empty(); }));
  REQUIRE(shown.settle());
  CHECK(shown.window().current()->name() == "surface");
  REQUIRE(shown.document().meshes().size() == 1);
  CHECK(shown.document().meshes()[0]->path == first);
  CHECK(shown.search.result().wish.id == 1);  // and is not taken for a query
  SceneWidget* scene = shown.view<SurfaceView>("surface").four_up()->scene();
  const QImage plate = WindowFixture::grab(scene);
  CHECK(edge_count(plate, 10) > 100);

  // The next one takes its place.
  shown.show("search");
  shown.click(6);
  REQUIRE(shown.wait_until([&] {
    return shown.document().meshes().size() == 1 && shown.document().meshes()[0]->path == second;
  }));
  REQUIRE(shown.settle());
  CHECK(shown.window().current()->name() == "surface");
  CHECK(changed_pixels(plate, WindowFixture::grab(scene)) > 1000);
}

TEST_CASE("Ctrl and click looks for shapes like a match; undo goes back", "[viewer][search]") {
  Shown shown;
  shown.click(0);
  const std::int64_t match = shown.search.result().found[0].model.id;
  shown.click(1, Qt::ControlModifier);
  CHECK(shown.search.result().wish.id == match);
  CHECK(shown.document().meshes().empty());
  shown.window().undo();
  REQUIRE(shown.settle());
  CHECK(shown.search.result().wish.id == 1);
  CHECK(shown.grid->cells()[0].key == 1);
  shown.window().undo();
  REQUIRE(shown.settle());
  CHECK_FALSE(shown.search.result().wish.has_query());
  CHECK_FALSE(shown.grid->heading().isEmpty());
  shown.window().redo();
  REQUIRE(shown.settle());
  CHECK(shown.search.result().wish.id == 1);
}

TEST_CASE("a mesh that is dropped is looked for", "[viewer][search]") {
  Shown shown;
  const std::string path = shown.small.write("new", brick(10.0, 1.1, 1.2));
  QMimeData data;
  data.setUrls({QUrl::fromLocalFile(QString::fromStdString(path))});
  QDragEnterEvent enter(QPoint(50, 50), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(shown.search.content(), &enter);
  CHECK(enter.isAccepted());
  QDropEvent drop(QPointF(50, 50), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(shown.search.content(), &drop);
  REQUIRE(shown.settle());
  const SearchResult& result = shown.search.result();
  CHECK(result.wish.path == path);
  REQUIRE(result.found.size() == 8);
  for (std::size_t n = 0; n < 4; ++n) CHECK(result.found[n].model.class_name == "rod");
  CHECK(shown.grid->cells()[0].second == "class not known");
  CHECK(near(shown.frame_in_picture(0), to_qt(kQueryFrame)));
  CHECK(near(shown.frame_in_picture(1), to_qt(kUnknownFrame)));
  // It has a picture though the library does not hold it.
  const QImage picture = WindowFixture::grab(shown.grid->viewport());
  const QImage inside = picture.copy(shown.grid->picture_area(0).adjusted(2, 2, -2, -2));
  CHECK(count_color(inside, Qt::white, 2) < 97 * inside.width() * inside.height() / 100);
}

TEST_CASE("a mesh that is opened while the search is in front is looked for", "[viewer][search]") {
  Shown shown;
  const std::string path = shown.small.write("new", brick(10.0, 9.1, 1.2));
  shown.window().open(QString::fromStdString(path));
  REQUIRE(shown.wait_until([&] { return shown.search.result().wish.path == path; }));
  CHECK(shown.search.result().found[0].model.class_name == "plate");
}

TEST_CASE("the list chooses a query, and the controls how it is ranked", "[viewer][search]") {
  Shown shown;
  shown.control<QLineEdit>("filter")->setText("rod");
  auto* list = shown.control<QListWidget>("models");
  REQUIRE(list->count() == 4);
  const QPoint at = list->visualItemRect(list->item(2)).center();
  QTest::mouseClick(list->viewport(), Qt::LeftButton, Qt::NoModifier, at);
  REQUIRE(shown.settle());
  CHECK(shown.search.result().query.model->file.path == (shown.small.folder / "rod2.off").string());
  const double euclidean = shown.search.result().found[6].match.distance;
  auto* ranking = shown.control<QComboBox>("ranking");
  ranking->setFocus();
  QTest::keyClick(ranking, Qt::Key_Down);
  REQUIRE(shown.settle());
  CHECK(shown.search.result().wish.ranking == Ranking::l1);
  CHECK(shown.search.result().found[6].match.distance > 1.1 * euclidean);
  auto* count = shown.control<QSpinBox>("count");
  count->setFocus();
  count->selectAll();
  QTest::keyClicks(count, "3");
  QTest::keyClick(count, Qt::Key_Return);
  REQUIRE(shown.settle());
  CHECK(shown.grid->cells().size() == 4);
  QTest::mouseClick(shown.control<QPushButton>("all"), Qt::LeftButton);
  REQUIRE(shown.settle());
  CHECK(shown.grid->cells().size() == 8);
}

TEST_CASE("the search's state goes into a session and back", "[viewer][search]") {
  Shown shown;
  shown.search.set_state({{"query", 3}, {"distance", "L1"}, {"count", 5}});
  REQUIRE(shown.settle());
  const Session session = shown.window().session();
  CHECK(session.files == std::vector<std::string>{shown.small.path});
  const auto cells = shown.grid->cells().size();
  shown.document().close_all();
  REQUIRE(shown.settle());
  CHECK_FALSE(shown.search.missing().isEmpty());
  CHECK(shown.grid->cells().empty());
  shown.window().apply(session);
  REQUIRE(shown.settle());
  CHECK(shown.search.result().wish.id == 3);
  CHECK(shown.search.result().wish.ranking == Ranking::l1);
  CHECK(shown.grid->cells().size() == cells);
  CHECK(shown.search.state() == session.views["search"]);
}

TEST_CASE("errors of the search are sentences in the window", "[viewer][search]") {
  Shown shown;
  shown.click(0);
  const auto cells = shown.grid->cells().size();
  // A query that is no mesh: what was shown stays.
  const std::string broken = (shown.small.folder / "broken.off").string();
  std::ofstream(broken) << "OFF\n3 1 0\n0 0 0\n";
  shown.search.set_state({{"query", broken}});
  REQUIRE(shown.settle());
  CHECK_THAT(shown.shown_error(), Contains("broken.off: "));
  CHECK(shown.search.result().wish.id == 1);
  CHECK(shown.grid->cells().size() == cells);
  CHECK(shown.search.state()["query"] == 1);

  // A match whose mesh has gone.
  std::filesystem::remove(shown.search.result().found[0].model.file.path);
  shown.click(1);
  CHECK_THAT(shown.shown_error(), Contains("is not there any more"));
  CHECK(shown.window().current()->name() == "search");

  CHECK_THROWS_WITH(shown.search.set_state({{"query", true}}), Contains("expected the id"));
  CHECK_THROWS_WITH(shown.search.set_state({{"distance", "cosine"}}), Contains("expected L2, L1"));
  CHECK_THROWS_WITH(shown.search.set_state({{"count", 0}}), Contains("expected 1 to 1000"));
  CHECK_THROWS_WITH(shown.search.set_state({{"descriptor", "egi"}}), Contains("boxes.db: "));

  const std::string fake = (shown.small.folder / "fake.db").string();
  std::ofstream(fake) << "no library";
  shown.window().open(QString::fromStdString(fake));
  CHECK_THAT(shown.shown_error(), Contains("fake.db: "));
  CHECK(shown.grid->cells().size() == cells);
}

}  // namespace
