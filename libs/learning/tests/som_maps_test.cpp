#include "shape3d/learning/som_maps.hpp"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "generated.hpp"
#include "random_numbers.hpp"
#include "shape3d/learning/clustering.hpp"

using namespace shape3d::learning;
using Catch::Matchers::Contains;

namespace {

Som plain_som(const SomGrid& grid, const Features& prototypes) {
  Som som;
  som.grid = grid;
  som.prototypes = prototypes;
  som.scaling = fit_scaling(prototypes, ScalingKind::none);
  return som;
}

}  // namespace

TEST_CASE("a U-matrix holds each distance of neighbours where it lies") {
  // An element between two units lies half way between them and has their distance; a unit has the
  // mean of the elements round it. Prototypes at random: no two distances are equal.
  detail::RandomNumbers random(5);
  const SomLattice lattice = GENERATE(SomLattice::rectangular, SomLattice::hexagonal);
  const SomShape shape = GENERATE(SomShape::sheet, SomShape::toroid);
  const SomGrid grid{6, 5, lattice, shape};
  Features M(grid.units(), 3);
  for (double& m : M.reshaped()) m = random.normal();
  const UMatrix u = u_matrix(plain_som(grid, M));
  const bool wraps = shape == SomShape::toroid;
  REQUIRE(u.values.rows() == (wraps ? 12 : 11));
  REQUIRE(u.values.cols() == (wraps ? 10 : 9));
  CHECK(u.values.allFinite());

  const Eigen::MatrixX2d R = som_positions(grid);
  const auto near = som_neighbours(grid);
  // The value at a place, or NaN; the way round is at the far end.
  const double width = 5.0;
  const double height = 6.0 * (lattice == SomLattice::hexagonal ? std::sqrt(0.75) : 1.0);
  const auto value_at = [&](double x, double y) {
    for (Eigen::Index i = 0; i < u.values.rows(); ++i) {
      for (Eigen::Index j = 0; j < u.values.cols(); ++j) {
        double dx = std::abs(u.x(i, j) - x);
        double dy = std::abs(u.y(i, j) - y);
        if (wraps) {
          dx = std::min(dx, std::abs(width - dx));
          dy = std::min(dy, std::abs(height - dy));
        }
        if (dx < 1e-9 && dy < 1e-9) return u.values(i, j);
      }
    }
    return std::nan("");
  };
  for (int a = 0; a < grid.units(); ++a) {
    double sum = 0.0;
    for (const int b : near[static_cast<std::size_t>(a)]) {
      const double apart = (M.row(a) - M.row(b)).norm();
      sum += apart;
      Eigen::RowVector2d step = R.row(b) - R.row(a);
      if (step.x() > 2.0) step.x() -= width;
      if (step.x() < -2.0) step.x() += width;
      if (step.y() > 2.0) step.y() -= height;
      if (step.y() < -2.0) step.y() += height;
      const Eigen::RowVector2d middle = R.row(a) + 0.5 * step;
      CHECK(value_at(middle.x(), middle.y()) == apart);
    }
    CHECK(value_at(R(a, 0), R(a, 1)) ==
          Approx(sum / static_cast<double>(near[static_cast<std::size_t>(a)].size())));
  }
  if (lattice == SomLattice::rectangular) {
    const double cross = (M.row(0) - M.row(6)).norm() + (M.row(1) - M.row(5)).norm();
    CHECK(u.values(1, 1) == Approx(cross / (2.0 * std::sqrt(2.0))));
  }
}

TEST_CASE("a U-matrix separates planted clusters") {
  // Four clouds, far apart; the border between units of different clouds must stand out from what
  // is inside them.
  const GeneratedSet set = gaussian_clouds(800, 8, 4, 6.0, 77);
  SomOptions options;
  options.scaling = ScalingKind::standard;
  const Som som = train_som(set.X, options);
  const BestUnits best = best_units(som, set.X);
  CHECK(purity(best.first, set.labels, 72) > 0.999);

  const Labels labels = vote_labels(best.first, set.labels, 72);
  const auto near = som_neighbours(som.grid);
  double inside = 0.0;   // the largest distance of neighbours of one cloud
  double between = 1e9;  // the least of two clouds
  for (int a = 0; a < 72; ++a) {
    for (const int b : near[static_cast<std::size_t>(a)]) {
      const int la = labels[static_cast<std::size_t>(a)];
      const int lb = labels[static_cast<std::size_t>(b)];
      if (la == kUnlabelled || lb == kUnlabelled) continue;
      const double apart = (som.prototypes.row(a) - som.prototypes.row(b)).norm();
      if (la == lb) inside = std::max(inside, apart);
      if (la != lb) between = std::min(between, apart);
    }
  }
  INFO(inside << ' ' << between);
  CHECK(between > inside);

  // Second level: the clusters of the prototypes that have items are the clouds.
  std::vector<int> used;
  for (int u = 0; u < 72; ++u) {
    if (labels[static_cast<std::size_t>(u)] != kUnlabelled) used.push_back(u);
  }
  Features M(static_cast<Eigen::Index>(used.size()), 8);
  Labels truth;
  for (std::size_t i = 0; i < used.size(); ++i) {
    M.row(static_cast<Eigen::Index>(i)) = som.prototypes.row(used[i]);
    truth.push_back(labels[static_cast<std::size_t>(used[i])]);
  }
  const ClusterChoice choice = kmeans_by_davies_bouldin(M, 0, 1);
  CHECK(choice.clusters.count() == 4);
  CHECK(purity(choice.clusters.assignment, truth, 4) == 1.0);
  for (const Linkage linkage :
       {Linkage::single, Linkage::complete, Linkage::average, Linkage::ward}) {
    CHECK(purity(cut_tree(M, agglomerate(M, linkage), 4).assignment, truth, 4) == 1.0);
  }
}

TEST_CASE("component planes and hits are laid out as the grid") {
  Features M(6, 2);
  M << 1, 10, 2, 20, 3, 30, 4, 40, 5, 50, 6, 60;
  Som som = plain_som({2, 3, SomLattice::rectangular, SomShape::sheet}, M);
  som.scaling = fit_scaling(M, ScalingKind::standard);
  som.prototypes = som.scaling.apply(M);
  Eigen::MatrixXd expected(2, 3);
  expected << 10, 20, 30, 40, 50, 60;
  CHECK((component_plane(som, 1) - expected).cwiseAbs().maxCoeff() < 1e-12);
  Eigen::MatrixXi hits(2, 3);
  hits << 1, 0, 2, 0, 0, 1;
  CHECK(hit_histogram(som.grid, {5, 0, 2, 2}) == hits);
  CHECK_THROWS_WITH(component_plane(som, 2), Contains("component is 2, expected 0 … 1"));
  CHECK_THROWS_WITH(hit_histogram(som.grid, {6}), Contains("a unit is 6, expected 0 … 5"));
}

TEST_CASE("labels are voted, ties go to the lowest") {
  const std::vector<int> units{0, 0, 0, 1, 1, 3, 3, 3};
  const Labels labels{2, 2, 1, 5, 4, -1, -1, 0};
  CHECK(vote_labels(units, labels, 4) == Labels{2, 4, kUnlabelled, 0});
  CHECK(purity(units, labels, 4) == 4.0 / 6.0);
  CHECK(vote_labels({0}, {kUnlabelled}, 1) == Labels{kUnlabelled});
  CHECK(purity({0}, {kUnlabelled}, 1) == 0.0);
  CHECK_THROWS_WITH(vote_labels({0, 1}, {0}, 2),
                    Contains("there are 1 labels, expected one for each of 2"));
  CHECK_THROWS_WITH(vote_labels({2}, {0}, 2), Contains("a unit is 2, expected 0 … 1"));
  CHECK_THROWS_WITH(purity({0}, {-2}, 2), Contains("a label is -2"));
}

TEST_CASE("items are of the class of the nearest unit that has one") {
  Features M(3, 1);
  M << 0, 1, 5;
  const Som som = plain_som({1, 3, SomLattice::rectangular, SomShape::sheet}, M);
  Features X(3, 1);
  X << 0.9, 2.9, 100;
  CHECK(classify_by_som(som, {7, kUnlabelled, 2}, X) == Labels{7, 2, 2});
  CHECK_THROWS_WITH(classify_by_som(som, {-1, -1, -1}, X),
                    Contains("no unit of the map has a label"));
  CHECK_THROWS_WITH(classify_by_som(som, {1}, X),
                    Contains("there are 1 labels of units, expected 3"));
}

TEST_CASE("quality is what it is called") {
  Features M(4, 1);
  M << 0, 10, 1, 11;  // a folded line: 0 and 2 are near in value and not neighbours
  const Som som = plain_som({1, 4, SomLattice::rectangular, SomShape::sheet}, M);
  Features X(4, 1);
  X << 0.25, 10.25, 5.4, 6;  // seconds: 2, 3, 1, 2; the last two: 2 then 1, 1 then 2
  const SomQuality quality = som_quality(som, best_units(som, X));
  CHECK(quality.quantization_error == Approx((0.25 + 0.25 + 4.4 + 4.0) / 4.0));
  CHECK(quality.topographic_error == 0.5);
  CHECK_THROWS_WITH(som_quality(som, {}), Contains("there is no item"));
}

TEST_CASE("a map with its labels survives its bytes") {
  const GeneratedSet set = gaussian_clouds(60, 4, 2, 2.0, 1);
  SomOptions options;
  options.grid = {3, 2, SomLattice::hexagonal, SomShape::sheet};
  SomModel model;
  model.som = train_som(set.X, options);
  model.hits = {1, 2, 3, 4, 5, 6};
  model.labels = {0, 1, -1, 0, 1, -1};
  model.clusters = {0, 0, 0, 1, 1, 1};
  model.names = {"a", "", "c d", "e\n", "f", "g"};
  const std::string bytes = model.serialize();
  const SomModel read = SomModel::deserialize(bytes);
  CHECK(read.serialize() == bytes);
  CHECK(read.names == model.names);
  CHECK(read.labels == model.labels);
  model.hits.pop_back();
  CHECK_THROWS_WITH(SomModel::deserialize(model.serialize()),
                    Contains("its sizes do not fit together"));
  CHECK_THROWS_WITH(SomModel::deserialize(model.som.serialize()), Contains("it is something else"));
}
