#include <filesystem>
#include <fstream>

#include <QAction>
#include <QApplication>
#include <QDialog>
#include <QDir>
#include <QDragEnterEvent>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QMimeData>
#include <QSettings>
#include <QTemporaryDir>
#include <QTimer>
#include <QUrl>
#include <QtTest/QTest>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "four_up.hpp"
#include "slice_widget.hpp"
#include "surface_view.hpp"
#include "volume_view.hpp"
#include "window_fixture.hpp"

namespace {
using namespace shape3d::apps::viewer;
using namespace shape3d::test;

std::string write_tetrahedron(const QString& path) {
  std::ofstream(path.toStdString()) << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                                       "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  return path.toStdString();
}

TEST_CASE("? lists the keys of the window and of the view in front", "[viewer][keys]") {
  WindowFixture fixture;
  QString text;
  QTimer::singleShot(300, [&text] {
    auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
    if (dialog == nullptr) return;
    for (const QLabel* label : dialog->findChildren<QLabel*>()) text += label->text() + "\n";
    dialog->reject();
  });
  QTest::keyClick(&fixture.window(), Qt::Key_Question, Qt::ShiftModifier);
  CHECK(text.contains("reset the view"));
  CHECK(text.contains("save a picture"));
  CHECK(text.contains("window (across) and level (up and down)"));
}

TEST_CASE("S saves a picture of the view in the current folder", "[viewer][keys]") {
  WindowFixture fixture;
  fixture.document().set_volume(ball_volume(32));
  REQUIRE(fixture.settle());
  const QTemporaryDir folder;
  const QString before = QDir::currentPath();
  QDir::setCurrent(folder.path());
  QTest::keyClick(&fixture.window(), Qt::Key_S);
  QDir::setCurrent(before);
  const QStringList files = QDir(folder.path()).entryList({"*.png"});
  REQUIRE(files.size() == 1);
  CHECK(files[0].startsWith("shape3d-volume-"));
  const QImage image(folder.filePath(files[0]));
  CHECK(image.size() == fixture.view<VolumeView>("volume").content()->size());
  CHECK(edge_count(image, 20) > 500);
}

TEST_CASE("a picture that cannot be written is said", "[viewer][keys]") {
  WindowFixture fixture;
  fixture.document().set_volume(ball_volume(16));
  REQUIRE(fixture.settle());
  const QString before = QDir::currentPath();
  {
    const QTemporaryDir folder;
    QDir::setCurrent(folder.path());
  }  // it is gone
  QTest::keyClick(&fixture.window(), Qt::Key_S);
  QDir::setCurrent(before);
  CHECK(fixture.window().message().contains("shape3d-volume-"));
  CHECK(fixture.window().failures().size() == 1);
}

TEST_CASE("a window that is dragged in another view is taken back there", "[viewer][keys]") {
  WindowFixture fixture;
  fixture.document().set_volume(ball_volume(32));
  fixture.show("surface");
  const Window before = fixture.document().window();
  SliceWidget* axial = fixture.view<SurfaceView>("surface").four_up()->slice(2);
  const QImage slice = WindowFixture::grab(axial);
  drag(axial, {60, 60}, {60, 120}, Qt::RightButton);
  CHECK(fixture.document().window().level > before.level);
  CHECK(changed_pixels(slice, WindowFixture::grab(axial)) > 1000);
  QTest::keyClick(&fixture.window(), Qt::Key_Z, Qt::ControlModifier);
  REQUIRE(fixture.settle());
  CHECK(fixture.document().window().level == Approx(before.level));
  CHECK(fixture.window().current()->name() == "surface");
  hover(axial, {2, 2});
  CHECK(changed_pixels(slice, WindowFixture::grab(axial)) < 50);
}

TEST_CASE("numbers change the view, B the background", "[viewer][keys]") {
  WindowFixture fixture;
  fixture.document().set_volume(ball_volume(32));
  REQUIRE(fixture.settle());
  CHECK(fixture.window().current()->name() == "volume");
  QTest::keyClick(&fixture.window(), Qt::Key_2);
  REQUIRE(fixture.settle());
  CHECK(fixture.window().current()->name() == "surface");
  const double dark = mean_grey(WindowFixture::grab(&fixture.window()));
  QTest::keyClick(&fixture.window(), Qt::Key_B);
  REQUIRE(fixture.settle());
  CHECK_FALSE(fixture.window().dark());
  CHECK(mean_grey(WindowFixture::grab(&fixture.window())) > dark + 60.0);
}

TEST_CASE("R resets the crosshair and the window", "[viewer][keys]") {
  WindowFixture fixture;
  fixture.document().set_volume(ball_volume(32));
  REQUIRE(fixture.settle());
  const Window automatic = fixture.document().window();
  fixture.document().set_cursor({1.0, 2.0, 3.0});
  fixture.document().set_window({5.0, 6.0});
  QTest::keyClick(&fixture.window(), Qt::Key_R);
  CHECK(fixture.document().window() == automatic);
  CHECK(fixture.document().cursor().isApprox(Eigen::Vector3d(16.0, 16.0, 16.0)));
}

TEST_CASE("files are dropped on the window", "[viewer][keys]") {
  WindowFixture fixture;
  const QTemporaryDir folder;
  const std::string path = write_tetrahedron(folder.filePath("t.off"));
  QMimeData data;
  data.setUrls({QUrl::fromLocalFile(QString::fromStdString(path))});
  QDragEnterEvent enter(QPoint(50, 50), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&fixture.window(), &enter);
  CHECK(enter.isAccepted());
  QDropEvent event(QPointF(50, 50), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&fixture.window(), &event);
  REQUIRE(fixture.wait_until([&] { return fixture.document().meshes().size() == 1; }));
  fixture.show("surface");
  CHECK(fixture.view<SurfaceView>("surface").triangles() == 4);
  CHECK(fixture.document().files() == std::vector<std::string>{path});
}

TEST_CASE("recent files are remembered, the newest first", "[viewer][keys]") {
  WindowFixture fixture;
  const QTemporaryDir folder;
  QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope, folder.path());
  const auto recent = [](MainWindow& window) {
    QStringList paths;
    for (QMenu* menu : window.menuBar()->findChildren<QMenu*>()) {
      if (menu->title() != "Open &recent") continue;
      for (const QAction* action : menu->actions()) paths.append(action->text());
    }
    return paths;
  };
  const QString a = folder.filePath("a.off"), b = folder.filePath("b.off");
  write_tetrahedron(a);
  write_tetrahedron(b);
  {
    MainWindow window(true);
    CHECK(recent(window).isEmpty());
    for (const QString& path : {a, b, a}) window.open(path);
    window.open(folder.filePath("none.off"));  // what cannot be opened is not remembered
    CHECK(recent(window) == QStringList({a, b}));
    CHECK(fixture.wait_until([&] { return !window.busy(); }));
  }
  MainWindow window(true);
  CHECK(recent(window) == QStringList({a, b}));
  for (QMenu* menu : window.menuBar()->findChildren<QMenu*>()) {
    if (menu->title() == "Open &recent") menu->actions().at(1)->trigger();
  }
  REQUIRE(fixture.wait_until([&] { return window.document().meshes().size() == 1; }));
  CHECK(window.document().files().front() == b.toStdString());
  CHECK(recent(window) == QStringList({b, a}));
}

TEST_CASE("what cannot be read is said in the window", "[viewer][keys]") {
  WindowFixture fixture;
  const QTemporaryDir folder;
  const auto opened = [&](const char* name, const std::string& bytes) {
    const QString path = folder.filePath(name);
    std::ofstream(path.toStdString(), std::ios::binary) << bytes;
    fixture.window().open(path);
    REQUIRE(fixture.settle());
    const QString message = fixture.window().message();
    CHECK(message.startsWith(path));
    return message;
  };
  CHECK(opened("a.txt", "words").contains("is no file of a known kind"));
  CHECK(opened("b.off", "OFF\n3 1 0\n0 0 0\n").contains("line"));
  CHECK(opened("c.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n").contains("has no triangle"));
  CHECK(opened("d.nrrd", "NRRD0004\ntype: short\n").size() > 10);
  CHECK(opened("e.json", "{").contains("not JSON at byte"));
  fixture.window().open(folder.filePath("none.mha"));
  CHECK(fixture.window().message().contains("no such file"));
  CHECK(fixture.window().failures().size() == 6);
  // The next file that can be read takes the message away.
  fixture.window().open(QString::fromStdString(write_tetrahedron(folder.filePath("t.off"))));
  REQUIRE(fixture.settle());
  CHECK(fixture.window().message().isEmpty());
}

TEST_CASE("a session brings back files, view and parameters", "[viewer][keys]") {
  const QTemporaryDir folder;
  const std::string path = folder.filePath("session.json").toStdString();
  const std::string mesh = write_tetrahedron(folder.filePath("t.off"));
  {
    WindowFixture fixture;
    fixture.window().open(QString::fromStdString(mesh));
    REQUIRE(fixture.settle());
    fixture.show("surface");
    nlohmann::json state = fixture.window().current()->state();
    state["surfaces"][0]["opacity"] = 0.25;
    state["surfaces"][0]["color"] = "#102030";
    fixture.window().current()->set_state(state);
    fixture.window().set_dark(false);
    write_session(path, fixture.window().session());
  }
  WindowFixture fixture;
  fixture.window().open(QString::fromStdString(path));
  REQUIRE(fixture.wait_until([&] { return fixture.document().meshes().size() == 1; }));
  REQUIRE(fixture.settle());
  CHECK(fixture.window().current()->name() == "surface");
  CHECK_FALSE(fixture.window().dark());
  const nlohmann::json state = fixture.window().current()->state();
  CHECK(state["surfaces"][0]["opacity"] == Approx(0.25));
  CHECK(state["surfaces"][0]["color"] == "#102030");
  CHECK(fixture.window().failures().empty());
}

}  // namespace
