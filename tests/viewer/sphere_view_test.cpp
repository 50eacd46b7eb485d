#include "sphere_view.hpp"

#include <cmath>
#include <map>
#include <vector>

#include <QVTKOpenGLNativeWidget.h>
#include <QComboBox>
#include <QLabel>
#include <QtTest/QTest>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "image_widget.hpp"
#include "scene_widget.hpp"
#include "window_fixture.hpp"

namespace {
using namespace shape3d::apps;
using namespace shape3d::apps::viewer;
using namespace shape3d::test;

// An octahedron divided n times, its vertices on an ellipsoid of semiaxes 1, 0.8, 0.6.
std::shared_ptr<const OpenMesh> ellipsoid(int levels) {
  auto open = std::make_shared<OpenMesh>();
  open->path = "/ellipsoid.off";
  std::vector<Eigen::Vector3d> V{{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                 {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  std::vector<std::array<int, 3>> F{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, fresh] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(V.size()));
      if (fresh)
        V.push_back((V[static_cast<std::size_t>(a)] + V[static_cast<std::size_t>(b)]).normalized());
      return at->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : F) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    F = finer;
  }
  open->mesh.V.resize(static_cast<Eigen::Index>(V.size()), 3);
  open->mesh.F.resize(static_cast<Eigen::Index>(F.size()), 3);
  for (std::size_t v = 0; v < V.size(); ++v)
    open->mesh.V.row(static_cast<Eigen::Index>(v)) =
        V[v].cwiseProduct(Eigen::Vector3d(1.0, 0.8, 0.6)).transpose();
  for (std::size_t t = 0; t < F.size(); ++t)
    open->mesh.F.row(static_cast<Eigen::Index>(t)) << F[t][0], F[t][1], F[t][2];
  return open;
}

struct Shown : WindowFixture {
  SphereView& sphere = view<SphereView>("sphere");
  explicit Shown(std::shared_ptr<const OpenMesh> mesh) {
    document().add_mesh(std::move(mesh));
    show("sphere");
  }
};

TEST_CASE("a mesh is mapped, coloured, and shown with its image", "[viewer][sphere]") {
  Shown shown(ellipsoid(4));
  REQUIRE(shown.sphere.result());
  const SphereResult& result = *shown.sphere.result();
  CHECK(result.sphere.V.rowwise().norm().isApproxToConstant(1.0, 1e-9));
  CHECK(result.median_angle_change < 1.0);
  CHECK(result.energy_over_area == Approx(1.0).margin(0.01));
  CHECK(shown.sphere.panel()->findChild<QLabel*>("facts")->text().contains("certified"));
  // Normals as colours: all of a ball's directions are there.
  const QImage mesh = WindowFixture::grab(shown.sphere.mesh_scene()),
               sphere = WindowFixture::grab(shown.sphere.sphere_scene());
  CHECK(shown.sphere.image()->image().width() == 2 * shown.sphere.image()->image().height());
  for (const QImage& image : {mesh, sphere}) {
    int saturated = 0;
    for (int y = 0; y < image.height(); y += 2) {
      for (int x = 0; x < image.width(); x += 2)
        saturated +=
            image.pixelColor(x, y).hsvSaturationF() > 0.45 && image.pixelColor(x, y).valueF() > 0.4
                ? 1
                : 0;
    }
    CHECK(saturated > 1500);
  }
}

TEST_CASE("C goes through the colourings, each another picture", "[viewer][sphere]") {
  Shown shown(ellipsoid(4));
  REQUIRE(shown.sphere.result());
  auto* color = shown.sphere.panel()->findChild<QComboBox*>("color");
  std::vector<QImage> scenes, images;
  for (int n = 0; n < 5; ++n) {
    CHECK(color->currentIndex() == n);
    REQUIRE(shown.settle());
    scenes.push_back(WindowFixture::grab(shown.sphere.mesh_scene()));
    images.push_back(shown.sphere.image()->image());
    QTest::keyClick(shown.sphere.content(), Qt::Key_C);
  }
  CHECK(color->currentIndex() == 0);
  for (std::size_t a = 0; a < 5; ++a) {
    for (std::size_t b = a + 1; b < 5; ++b) {
      INFO(a << " and " << b);
      CHECK(changed_pixels(scenes[a], scenes[b]) > 3000);
      CHECK(changed_pixels(images[a], images[b]) > images[a].width() * images[a].height() / 2);
    }
  }
}

TEST_CASE("the image of normals has at each direction the normal there", "[viewer][sphere]") {
  // On a sphere of its own, the normal is the direction: the image is that of the directions.
  auto ball = std::make_shared<OpenMesh>(*ellipsoid(5));
  for (Eigen::Index v = 0; v < ball->mesh.V.rows(); ++v)
    ball->mesh.V.row(v) =
        ball->mesh.V.row(v).cwiseQuotient(Eigen::RowVector3d(1.0, 0.8, 0.6)).normalized();
  Shown shown(ball);
  REQUIRE(shown.sphere.result());
  const QImage& image = shown.sphere.image()->image();
  double worst = 0.0;
  for (int y = 0; y < image.height(); y += 5) {
    for (int x = 0; x < image.width(); x += 5) {
      // The poles are the pose's third axis, which a ball does not fix: compare what does not
      // depend on it, the length of the colour as a vector, and that opposite places are opposite.
      const QColor here = image.pixelColor(x, y),
                   there = image.pixelColor((x + image.width() / 2) % image.width(),
                                            image.height() - 1 - y);
      const Eigen::Vector3d a(here.red() / 127.5 - 1, here.green() / 127.5 - 1,
                              here.blue() / 127.5 - 1),
          b(there.red() / 127.5 - 1, there.green() / 127.5 - 1, there.blue() / 127.5 - 1);
      CHECK(a.norm() == Approx(1.0).margin(0.03));
      worst = std::max(worst, (a + b).norm());
    }
  }
  CHECK(worst < 0.15);
}

TEST_CASE("E draws the edges of the triangles", "[viewer][sphere]") {
  Shown shown(ellipsoid(3));
  REQUIRE(shown.sphere.result());
  const auto edges = [&] {
    REQUIRE(shown.settle());
    return std::pair{edge_count(WindowFixture::grab(shown.sphere.mesh_scene()), 25),
                     edge_count(WindowFixture::grab(shown.sphere.sphere_scene()), 25)};
  };
  const auto without = edges();
  QTest::keyClick(shown.sphere.content(), Qt::Key_E);
  const auto with = edges();
  CHECK(with.first > without.first + 1000);
  CHECK(with.second > without.second + 1000);
  QTest::keyClick(shown.sphere.content(), Qt::Key_E);
  CHECK(edges() == without);
}

TEST_CASE("turning one scene turns the other", "[viewer][sphere]") {
  Shown shown(ellipsoid(3));
  const QImage before = WindowFixture::grab(shown.sphere.sphere_scene());
  drag(shown.sphere.mesh_scene()->gl_widget(), {80, 80}, {160, 120}, Qt::LeftButton);
  REQUIRE(shown.settle());
  CHECK(camera_numbers(shown.sphere.mesh_scene()->camera()) ==
        camera_numbers(shown.sphere.sphere_scene()->camera()));
  CHECK(changed_pixels(before, WindowFixture::grab(shown.sphere.sphere_scene())) > 1000);
}

TEST_CASE("a mesh that is not closed is refused with the reason", "[viewer][sphere]") {
  auto open = std::make_shared<OpenMesh>(*ellipsoid(2));
  open->mesh.F.conservativeResize(open->mesh.F.rows() - 1, 3);
  Shown shown(open);
  CHECK_FALSE(shown.sphere.result());
  CHECK(shown.window().message().contains("/ellipsoid.off: The mesh cannot be mapped"));
  CHECK(shown.window().failures().size() == 1);
}

}  // namespace
