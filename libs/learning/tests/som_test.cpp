#include "shape3d/learning/som.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <catch2/catch.hpp>

#include "generated.hpp"
#include "random_numbers.hpp"
#include "shape3d/learning/som_maps.hpp"

using namespace shape3d::learning;
using Catch::Matchers::Contains;

namespace {

constexpr double kPi = 3.141592653589793;

// Columns of random orthonormal vectors: d by k.
Eigen::MatrixXd orthonormal(int d, int k, std::uint64_t seed) {
  detail::RandomNumbers random(seed);
  Eigen::MatrixXd A(d, k);
  for (double& a : A.reshaped()) a = random.normal();
  return Eigen::HouseholderQR<Eigen::MatrixXd>(A).householderQ() * Eigen::MatrixXd::Identity(d, k);
}

// Batch training as the equation says, in plain loops.
Features reference_batch(const Features& X, const SomOptions& options, Features M) {
  const Eigen::MatrixX2d R = som_positions(options.grid);
  const double first = options.sigma_first;
  for (int epoch = 0; epoch < options.epochs; ++epoch) {
    const double sigma =
        first * std::pow(options.sigma_last / first, epoch / (options.epochs - 1.0));
    Features top = Features::Zero(M.rows(), M.cols());
    Eigen::VectorXd bottom = Eigen::VectorXd::Zero(M.rows());
    for (Eigen::Index x = 0; x < X.rows(); ++x) {
      Eigen::Index b = 0;
      double nearest = std::numeric_limits<double>::infinity();
      for (Eigen::Index i = 0; i < M.rows(); ++i) {
        const double d = (X.row(x) - M.row(i)).norm();
        if (d < nearest) {
          nearest = d;
          b = i;
        }
      }
      for (Eigen::Index i = 0; i < M.rows(); ++i) {
        const double h = std::exp(-(R.row(b) - R.row(i)).squaredNorm() / (2.0 * sigma * sigma));
        top.row(i) += h * X.row(x);
        bottom(i) += h;
      }
    }
    M = bottom.cwiseInverse().asDiagonal() * top;
  }
  return M;
}

// The prototypes that training starts from: of one epoch in which σ leaves all where it was.
SomOptions small_options() {
  SomOptions options;
  options.grid = {5, 4, SomLattice::hexagonal, SomShape::sheet};
  options.epochs = 12;
  options.sigma_first = 2.5;
  options.sigma_last = 0.6;
  return options;
}

}  // namespace

TEST_CASE("batch training is the plain sum of its equation") {
  const GeneratedSet set = gaussian_clouds(230, 7, 4, 2.0, 3);
  SomOptions options = small_options();
  options.scaling = ScalingKind::standard;
  options.grid.lattice = GENERATE(SomLattice::hexagonal, SomLattice::rectangular);
  const Som som = train_som(set.X, options);
  const Features X = som.scaling.apply(set.X);

  // The start by its definition: mean ± one standard deviation along two axes. Their variances and
  // directions come from a singular value decomposition here.
  const Eigen::RowVectorXd mean = X.colwise().mean();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd((X.rowwise() - mean) / std::sqrt(230.0),
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  Features start(20, 7);
  Eigen::MatrixXd axes = svd.matrixV();
  for (Eigen::Index a = 0; a < 2; ++a) {
    Eigen::Index largest = 0;
    axes.col(a).cwiseAbs().maxCoeff(&largest);
    if (axes(largest, a) < 0.0) axes.col(a) *= -1.0;
  }
  for (int i = 0; i < 20; ++i) {
    const double u = (i / 4) / 2.0 - 1.0;
    const double v = (i % 4) / 1.5 - 1.0;
    start.row(i) = mean + u * svd.singularValues()(0) * axes.col(0).transpose() +
                   v * svd.singularValues()(1) * axes.col(1).transpose();
  }
  const Features expected = reference_batch(X, options, start);
  CHECK((som.prototypes - expected).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("sequential training with one item and h = 1 is a geometric series") {
  // σ so large that h is 1 everywhere: M(t) = x + (M(0) − x) Π (1 − α(t)).
  Features X(1, 3);
  X << 3.0, -1.0, 2.0;
  SomOptions options;
  options.grid = {2, 3, SomLattice::rectangular, SomShape::sheet};
  options.training = SomTraining::sequential;
  options.epochs = 9;
  options.sigma_first = options.sigma_last = 1e9;
  options.alpha_first = 0.4;
  options.alpha_last = 0.1;
  options.start = SomStart::random;
  CHECK((train_som(X, options).prototypes.rowwise() - X.row(0)).isZero());  // it starts at x

  Features Y(2, 1);
  Y << 0.0, 1.0;
  options.epochs = 1;
  options.seed = 4;
  const Features M = train_som(Y, options).prototypes;
  detail::RandomNumbers random(4);
  Eigen::VectorXd start(6);
  for (double& m : start) m = random.uniform();
  std::vector<Eigen::Index> order{0, 1};
  random.shuffle(order);
  const double one = Y(order[0], 0);
  const double two = Y(order[1], 0);
  for (Eigen::Index i = 0; i < 6; ++i) {
    double m = start(i);
    m += 0.4 * (one - m);
    m += 0.1 * (two - m);
    CHECK(M(i, 0) == Approx(m).margin(1e-12));
  }
}

TEST_CASE("a map is the same for any number of threads") {
  const GeneratedSet set = gaussian_clouds(1500, 9, 5, 2.0, 8);
  SomOptions options;
  options.scaling = ScalingKind::range;
  options.training = GENERATE(SomTraining::batch, SomTraining::sequential);
  options.epochs = 6;
  const std::string one = train_som(set.X, options, 1).serialize();
  CHECK(train_som(set.X, options, 2).serialize() == one);
  CHECK(train_som(set.X, options, 7).serialize() == one);
  const Som som = Som::deserialize(one);
  CHECK(best_units(som, set.X, 1).first == best_units(som, set.X, 2).first);
}

TEST_CASE("best units are those of a plain search") {
  GeneratedSet set = gaussian_clouds(300, 6, 3, 1.0, 15);
  SomOptions options = small_options();
  Som som = train_som(set.X, options);
  som.prototypes.row(13) = som.prototypes.row(4);  // equally near: the lower number
  const double offset = GENERATE(0.0, 1e7);        // the product loses 14 digits there
  som.prototypes.array() += offset;
  set.X.array() += offset;
  set.X.row(0) = som.prototypes.row(13);
  const BestUnits best = best_units(som, set.X);
  for (Eigen::Index x = 0; x < set.X.rows(); ++x) {
    const Eigen::VectorXd squares =
        (som.prototypes.rowwise() - set.X.row(x)).rowwise().squaredNorm();
    Eigen::Index first = 0;
    const double least = squares.minCoeff(&first);
    Eigen::VectorXd others = squares;
    others(first) = std::numeric_limits<double>::infinity();
    Eigen::Index second = 0;
    others.minCoeff(&second);
    CHECK(best.first[static_cast<std::size_t>(x)] == first);
    CHECK(best.second[static_cast<std::size_t>(x)] == second);
    CHECK(best.distance(x) == Approx(std::sqrt(least)).epsilon(1e-14).margin(0.0));
  }
  CHECK(best.first[0] == 4);
  CHECK(best.second[0] == 13);
}

TEST_CASE("neighbours are at distance 1, four or six of them") {
  const int columns = GENERATE(3, 4, 7);
  for (const SomLattice lattice : {SomLattice::rectangular, SomLattice::hexagonal}) {
    const std::size_t around = lattice == SomLattice::rectangular ? 4 : 6;
    const SomGrid toroid{6, columns, lattice, SomShape::toroid};
    const Eigen::MatrixXd D = som_distances(toroid);
    CHECK(D == D.transpose());
    for (const auto& near : som_neighbours(toroid)) CHECK(near.size() == around);
    const SomGrid sheet{6, columns, lattice, SomShape::sheet};
    std::size_t edges = 0;
    for (const auto& near : som_neighbours(sheet)) {
      CHECK(near.size() >= 2);
      CHECK(near.size() <= around);
      edges += near.size();
    }
    // Between rows of a hexagonal sheet there are 2 c − 1 edges, of a rectangular one c.
    const int between = lattice == SomLattice::rectangular ? columns : 2 * columns - 1;
    CHECK(edges / 2 == static_cast<std::size_t>(6 * (columns - 1) + 5 * between));
    // All units of a toroid are alike: the same distances from each.
    for (int i = 0; i < toroid.units(); ++i) CHECK(D.row(i).sum() == Approx(D.row(0).sum()));
  }
}

TEST_CASE("a map keeps the topology of a plane in ten dimensions") {
  detail::RandomNumbers random(31);
  const Eigen::MatrixXd Q = orthonormal(10, 2, 32);
  Features X(2000, 10);
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    X.row(i) = (Q * Eigen::Vector2d(2.0 * random.uniform(), random.uniform())).transpose();
  }
  SomOptions options;
  options.training = GENERATE(SomTraining::batch, SomTraining::sequential);
  const Som som = train_som(X, options);
  const SomQuality quality = som_quality(som, best_units(som, X));
  INFO(quality.topographic_error << ' ' << quality.quantization_error);
  CHECK(quality.topographic_error < 0.05);
  // 72 hexagonal cells of area 2/72 have the mean distance 0.3772 √area = 0.063 to their middle; no
  // division of the rectangle is better (Fejes Tóth), one of a map at σ > 0 not much worse.
  CHECK(quality.quantization_error > 0.060);
  CHECK(quality.quantization_error < 0.075);
}

TEST_CASE("a torus is a toroid and no sheet") {
  detail::RandomNumbers random(33);
  Features X(3000, 4);
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    const double a = 2.0 * kPi * random.uniform();
    const double b = 2.0 * kPi * random.uniform();
    X.row(i) << 2.0 * std::cos(a), 2.0 * std::sin(a), std::cos(b), std::sin(b);
  }
  SomOptions options;
  options.grid = {16, 8, SomLattice::hexagonal, SomShape::toroid};
  options.start = SomStart::random;
  options.epochs = 100;
  options.sigma_first = 5.0;
  const Som toroid = train_som(X, options);
  options.grid.shape = SomShape::sheet;
  const Som sheet = train_som(X, options);
  const double toroid_error = som_quality(toroid, best_units(toroid, X)).topographic_error;
  const double sheet_error = som_quality(sheet, best_units(sheet, X)).topographic_error;
  INFO(toroid_error << ' ' << sheet_error);
  CHECK(toroid_error < 0.05);
  CHECK(sheet_error > 2.0 * toroid_error);
}

TEST_CASE("a closed curve runs round a toroid without a tear") {
  // Items in the order of their angle: the next one's best unit is never far on the grid, and the
  // way leads once through all rows.
  const Eigen::MatrixXd Q = orthonormal(6, 2, 35);
  Features X(1000, 6);
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    const double a = 2.0 * kPi * static_cast<double>(i) / 1000.0;
    X.row(i) = (Q * Eigen::Vector2d(std::cos(a), std::sin(a))).transpose();
  }
  SomOptions options;
  options.grid = {30, 3, SomLattice::rectangular, SomShape::toroid};
  options.start = SomStart::random;  // the plane of the principal axes has no hole
  options.epochs = 100;
  options.sigma_first = 10.0;
  const std::vector<int> units = best_units(train_som(X, options), X).first;
  const Eigen::MatrixXd D = som_distances(options.grid);
  std::vector<bool> visited(30, false);
  double farthest = 0.0;
  for (std::size_t i = 0; i < units.size(); ++i) {
    visited[static_cast<std::size_t>(units[i] / 3)] = true;
    farthest = std::max(farthest, D(units[i], units[(i + 1) % units.size()]));
  }
  CHECK(farthest <= 2.5);
  CHECK(std::count(visited.begin(), visited.end(), true) >= 28);
}

TEST_CASE("a map of few items in many dimensions spans their plane") {
  // More components than items: the axes come from the Gram matrix.
  detail::RandomNumbers random(36);
  const Eigen::MatrixXd Q = orthonormal(50, 2, 37);
  Features X(12, 50);
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    X.row(i) = (Q * Eigen::Vector2d(3.0 * random.normal(), random.normal())).transpose();
  }
  SomOptions options = small_options();
  const Som som = train_som(X, options);
  const Eigen::MatrixXd rest = som.prototypes - som.prototypes * Q * Q.transpose();
  CHECK(rest.cwiseAbs().maxCoeff() < 1e-12);
  CHECK(train_som(X.leftCols(1), options).prototypes.allFinite());  // a single component
  CHECK(train_som(X.topRows(1), options).prototypes.rowwise().operator-(X.row(0)).isZero(1e-12));
}

TEST_CASE("training reports its progress and can be cancelled") {
  const GeneratedSet set = gaussian_clouds(50, 3, 2, 2.0, 1);
  SomOptions options = small_options();
  options.epochs = 4;
  std::vector<double> shares;
  options.progress = [&](double share) {
    shares.push_back(share);
    return shares.size() < 2;
  };
  CHECK(train_som(set.X, options).cancelled);
  CHECK(shares == std::vector<double>{0.25, 0.5});
  options.progress = [](double) { return true; };
  CHECK_FALSE(train_som(set.X, options).cancelled);
}

TEST_CASE("a map survives its bytes") {
  const GeneratedSet set = gaussian_clouds(60, 4, 2, 2.0, 1);
  SomOptions options = small_options();
  options.scaling = ScalingKind::standard;
  const Som som = train_som(set.X, options);
  const std::string bytes = som.serialize();
  const Som read = Som::deserialize(bytes);
  CHECK(read.serialize() == bytes);
  CHECK(read.prototypes == som.prototypes);
  CHECK(read.grid.rows == 5);
  int found = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    try {
      static_cast<void>(Som::deserialize(damaged));
    } catch (const std::invalid_argument&) {
      ++found;
    }
  }
  CHECK(found == static_cast<int>(bytes.size()));
}

TEST_CASE("a map refuses options out of range") {
  const Features X = Features::Identity(4, 4);
  const auto message = [&](const SomOptions& options) -> std::string {
    try {
      static_cast<void>(train_som(X, options));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  SomOptions options;
  options.grid.rows = 0;
  CHECK(message(options) == "rows is 0, expected 1 … 1000");
  options.grid = {1, 1, SomLattice::hexagonal, SomShape::sheet};
  CHECK(message(options) == "units is 1, expected 2 … 10000");
  options.grid = {2, 4, SomLattice::hexagonal, SomShape::toroid};
  CHECK(message(options) == "rows is 2, expected 3 … 1000");
  options.grid = {4, 2, SomLattice::rectangular, SomShape::toroid};
  CHECK(message(options) == "columns is 2, expected 3 … 1000");
  options.grid = {5, 4, SomLattice::hexagonal, SomShape::toroid};
  CHECK(message(options) ==
        "rows is 5, expected an even number for a hexagonal toroid, whose odd rows are shifted");
  options = {};
  options.epochs = 0;
  CHECK_THAT(message(options), Contains("epochs is 0"));
  options = {};
  options.sigma_first = -1.0;
  CHECK(message(options) ==
        "sigma_first is -1, expected 0 for half the longer side, or a positive number");
  options = {};
  options.sigma_last = 0.0;
  CHECK(message(options) == "sigma_last is 0, expected a positive number");
  options = {};
  options.alpha_first = 1.5;
  CHECK(message(options) == "alpha_first is 1.5, expected 0 < alpha_first <= 1");
  options = {};
  options.alpha_last = 0.0;
  CHECK(message(options) == "alpha_last is 0, expected 0 < alpha_last <= 1");
  CHECK_THROWS_WITH(train_som(Features(0, 4)), Contains("X has 0 rows"));
  Features bad = X;
  bad(2, 1) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(train_som(bad), Contains("row 2, column 1 of X is inf"));
  CHECK_THROWS_WITH(train_som(X, {}, -1), Contains("threads is -1"));
  CHECK_THROWS_WITH(best_units(train_som(X), Features::Zero(1, 3)),
                    Contains("X has 3 columns, expected 4"));
}
