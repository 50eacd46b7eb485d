#include "shape3d/learning/svm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "generated.hpp"
#include "random_numbers.hpp"
#include "shape3d/learning/folds.hpp"
#include "svm_machines.hpp"

using namespace shape3d::learning;
using Catch::Matchers::Contains;

namespace {

double correct_rate(const Labels& truth, const Labels& predicted) {
  double right = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) right += truth[i] == predicted[i] ? 1.0 : 0.0;
  return right / static_cast<double>(truth.size());
}

SvmOptions unscaled(SvmKernel kernel, double C) {
  SvmOptions options;
  options.kernel = kernel;
  options.C = C;
  options.scaling = ScalingKind::none;
  options.tolerance = 1e-9;
  return options;
}

}  // namespace

TEST_CASE("two points are divided by the plane half way between them") {
  // The largest margin of a and b: f(x) = 2 (a − b)·(x − (a + b)/2) / ‖a − b‖², ±1 at the points.
  Features X(2, 3);
  X << 1, 2, 3, 4, -2, 5;
  const Svm svm = Svm::train(X, {7, 3}, unscaled(SvmKernel::linear, 1e6));
  CHECK(svm.order() == std::vector<int>{7, 3});
  CHECK(svm.classes() == std::vector<int>{3, 7});
  CHECK(svm.support_vectors() == 2);

  const Eigen::RowVector3d normal = X.row(0) - X.row(1);
  const Eigen::RowVector3d middle = 0.5 * (X.row(0) + X.row(1));
  Features queries(4, 3);
  queries << 1, 2, 3, 4, -2, 5, 2.5, 0, 4, 10, -7, 0.5;
  const Eigen::MatrixXd decisions = svm.decision_values(queries);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const double expected = 2.0 * normal.dot(queries.row(i) - middle) / normal.squaredNorm();
    CHECK(decisions(i, 0) == Approx(expected).margin(1e-9));
  }
}

TEST_CASE("a Gaussian kernel divides what no plane divides") {
  Features X(4, 2);
  X << 0, 0, 1, 1, 0, 1, 1, 0;
  const Labels labels{0, 0, 1, 1};
  SvmOptions options = unscaled(SvmKernel::rbf, 1e6);
  options.gamma = 1.0;
  CHECK(Svm::train(X, labels, options).predict(X) == labels);
  // By symmetry all four are support vectors of one weight a and the bias is 0: the decision at the
  // first is a (1 + e^−2 − 2 e^−1) = 1, and it is 0 in the middle.
  Features queries(2, 2);
  queries << 0, 0, 0.5, 0.5;
  const Eigen::MatrixXd decisions = Svm::train(X, labels, options).decision_values(queries);
  CHECK(decisions(0, 0) == Approx(1.0).margin(1e-8));
  CHECK(std::abs(decisions(1, 0)) < 1e-8);
}

TEST_CASE("the optimality conditions of the soft margin hold") {
  // For C-SVC: y f > 1 only off the support vectors, y f < 1 only at the weight C; Σ y α = 0.
  const GeneratedSet set = gaussian_clouds(120, 4, 2, 0.7, 12);
  SvmOptions options;
  options.C = 3.0;
  options.tolerance = 1e-9;
  options.scaling = ScalingKind::standard;
  const Svm svm = Svm::train(set.X, set.labels, options);
  const Eigen::MatrixXd decisions = svm.decision_values(set.X);
  int on_margin = 0;
  int inside = 0;
  for (std::size_t i = 0; i < set.labels.size(); ++i) {
    const double y = set.labels[i] == svm.order()[0] ? 1.0 : -1.0;
    const double margin = y * decisions(static_cast<Eigen::Index>(i), 0);
    if (std::abs(margin - 1.0) < 1e-6) ++on_margin;
    if (margin < 1.0 - 1e-6) ++inside;
  }
  CHECK(on_margin > 3);
  CHECK(inside > 3);
  CHECK(svm.support_vectors() == on_margin + inside);
}

TEST_CASE("scaling belongs to the machine") {
  const GeneratedSet set = gaussian_clouds(150, 5, 3, 2.0, 5);
  SvmOptions options;
  options.C = 4.0;
  const Svm svm = Svm::train(set.X, set.labels, options);
  // The same items in other units (powers of two: no rounding) and another origin.
  Features moved = 1024.0 * set.X;
  const Svm other = Svm::train(moved, set.labels, options);
  CHECK(svm.predict(set.X) == other.predict(moved));
  CHECK(svm.decision_values(set.X) == other.decision_values(moved));
  CHECK(correct_rate(set.labels, svm.predict(set.X)) > 0.9);
  CHECK(svm.options().gamma == 1.0 / 5.0);
}

TEST_CASE("rows without a label do not matter") {
  const GeneratedSet set = gaussian_clouds(90, 4, 3, 1.5, 6);
  Features more(set.X.rows() + 2, 4);
  more << set.X.topRows(10), Eigen::RowVector4d::Constant(1e12), set.X.bottomRows(80),
      Eigen::RowVector4d::Constant(-5.0);
  Labels labels = set.labels;
  labels.insert(labels.begin() + 10, kUnlabelled);
  labels.push_back(kUnlabelled);
  CHECK(Svm::train(more, labels).serialize() == Svm::train(set.X, set.labels).serialize());
}

TEST_CASE("weights of classes are costs of their errors") {
  // Two overlapping clouds of 1 : 9. Without weights the large one prevails; balanced, both are
  // found equally often; ten times the weight of the small one is nearly the same.
  detail::RandomNumbers random(3);
  Features X(1000, 1);
  Labels labels;
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    labels.push_back(i % 10 == 0 ? 0 : 1);
    X(i, 0) = random.normal() + (labels.back() == 0 ? 0.0 : 1.5);
  }
  const auto share_of_small = [&](const SvmOptions& options) {
    const Labels predicted = Svm::train(X, labels, options).predict(X);
    int right = 0;
    for (std::size_t i = 0; i < labels.size(); i += 10) right += predicted[i] == 0 ? 1 : 0;
    return right / 100.0;
  };
  SvmOptions options;
  options.kernel = SvmKernel::linear;
  CHECK(share_of_small(options) < 0.4);
  options.balanced = true;
  const double balanced = share_of_small(options);
  CHECK(balanced > 0.65);
  options.balanced = false;
  options.class_weights = {1000.0 / 200.0, 1000.0 / 1800.0};
  CHECK(share_of_small(options) == balanced);
}

TEST_CASE("the sigmoid is that of greatest likelihood") {
  detail::RandomNumbers random(8);
  std::vector<double> decisions;
  std::vector<bool> is_first;
  for (int i = 0; i < 500; ++i) {
    decisions.push_back(3.0 * random.normal());
    is_first.push_back(random.uniform() < 1.0 / (1.0 + std::exp(-1.3 * decisions.back() + 0.4)));
  }
  const detail::Sigmoid s = detail::fit_sigmoid(decisions, is_first);
  const double first = static_cast<double>(std::count(is_first.begin(), is_first.end(), true));
  const auto likelihood = [&](double a, double b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < decisions.size(); ++i) {
      const double p = 1.0 / (1.0 + std::exp(a * decisions[i] + b));
      const double t = is_first[i] ? (first + 1.0) / (first + 2.0) : 1.0 / (502.0 - first);
      sum += t * std::log(p) + (1.0 - t) * std::log(1.0 - p);
    }
    return sum;
  };
  const double best = likelihood(s.a, s.b);
  for (const double step : {1e-3, -1e-3}) {
    CHECK(likelihood(s.a + step, s.b) < best);
    CHECK(likelihood(s.a, s.b + step) < best);
  }
  CHECK(s.a == Approx(-1.3).margin(0.25));
  CHECK(s.b == Approx(0.4).margin(0.3));
}

TEST_CASE("probabilities come near those the items were drawn with") {
  // Two normal distributions of the same covariance: P(0 | x) = 1 / (1 + exp(−2 x)) at ±1.
  detail::RandomNumbers random(9);
  Features X(1200, 1);
  Labels labels;
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    labels.push_back(static_cast<int>(random.below(2)));
    X(i, 0) = random.normal() + (labels.back() == 0 ? 1.0 : -1.0);
  }
  SvmOptions options;
  options.kernel = SvmKernel::linear;
  options.probabilities = true;
  const Features P = Svm::train(X, labels, options).probabilities(X);
  double error = 0.0;
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    error += std::abs(P(i, 0) - 1.0 / (1.0 + std::exp(-2.0 * X(i, 0))));
  }
  CHECK(error / 1200.0 < 0.03);
}

TEST_CASE("probabilities are of the classes and sum to 1") {
  const GeneratedSet set = gaussian_clouds(200, 4, 4, 1.5, 21);
  SvmOptions options;
  options.probabilities = true;
  const Svm svm = Svm::train(set.X, set.labels, options, 1);
  const Features P = svm.probabilities(set.X);
  REQUIRE(P.cols() == 4);
  CHECK((P.rowwise().sum().array() - 1.0).abs().maxCoeff() < 1e-9);
  Labels most;
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    Eigen::Index c = 0;
    P.row(i).maxCoeff(&c);
    most.push_back(svm.classes()[static_cast<std::size_t>(c)]);
  }
  CHECK(correct_rate(svm.predict(set.X), most) > 0.9);
  CHECK(Svm::train(set.X, set.labels, options, 2).serialize() == svm.serialize());
  options.seed = 2;
  CHECK(Svm::train(set.X, set.labels, options, 1).serialize() != svm.serialize());
}

TEST_CASE("cross-validation never sees what it predicts") {
  // Labels drawn at random: whoever has seen them can tell them, others cannot.
  detail::RandomNumbers random(10);
  Features X(300, 3);
  for (double& x : X.reshaped()) x = random.normal();
  Labels labels;
  for (int i = 0; i < 300; ++i) labels.push_back(static_cast<int>(random.below(2)));
  SvmOptions options;
  options.C = 1000.0;
  options.gamma = 100.0;
  CHECK(correct_rate(labels, Svm::train(X, labels, options).predict(X)) == 1.0);
  const std::vector<int> folds = stratified_folds(labels, 5, 1);
  const SvmPredictions held = cross_validate_svm(X, labels, folds, options);
  CHECK(std::abs(correct_rate(labels, held.labels) - 0.5) < 0.15);

  // A fold's predictions are those of a machine trained by hand without it.
  Features seen(0, 3);
  Labels seen_labels;
  for (Eigen::Index i = 0; i < 300; ++i) {
    if (folds[static_cast<std::size_t>(i)] == 2) continue;
    seen.conservativeResize(seen.rows() + 1, 3);
    seen.bottomRows(1) = X.row(i);
    seen_labels.push_back(labels[static_cast<std::size_t>(i)]);
  }
  const Labels by_hand = Svm::train(seen, seen_labels, options).predict(X);
  for (std::size_t i = 0; i < 300; ++i) {
    if (folds[i] == 2) CHECK(held.labels[i] == by_hand[i]);
  }
  CHECK(cross_validate_svm(X, labels, folds, options, 1).labels == held.labels);
}

TEST_CASE("classes that a fold has not seen have no probability there") {
  GeneratedSet set = gaussian_clouds(60, 3, 2, 3.0, 11);
  set.labels[0] = 5;  // a class of one
  SvmOptions options;
  options.probabilities = true;
  const SvmPredictions result =
      cross_validate_svm(set.X, set.labels, stratified_folds(set.labels, 3, 2), options);
  CHECK(result.classes == std::vector<int>{0, 1, 5});
  CHECK(result.labels[0] != 5);
  CHECK(result.probabilities(0, 2) == 0.0);
  CHECK((result.probabilities.rowwise().sum().array() - 1.0).abs().maxCoeff() < 1e-9);

  // Where the other folds hold one class only, it is the answer; rows without a label get one.
  const SvmPredictions one =
      cross_validate_svm(set.X.topRows(3), {4, 8, kUnlabelled}, {0, 1, 1}, options);
  CHECK(one.labels == Labels{8, 4, 4});
  CHECK(one.probabilities.row(0) == Eigen::RowVector2d(0.0, 1.0));
}

TEST_CASE("an SVM survives its bytes") {
  const GeneratedSet set = gaussian_clouds(80, 4, 3, 1.5, 13);
  SvmOptions options;
  options.probabilities = GENERATE(false, true);
  options.class_weights = {1.0, 2.0, 0.5};
  options.scaling = ScalingKind::range;
  const Svm svm = Svm::train(set.X, set.labels, options);
  const std::string bytes = svm.serialize();
  const Svm read = Svm::deserialize(bytes);
  CHECK(read.serialize() == bytes);
  CHECK(read.decision_values(set.X) == svm.decision_values(set.X));
  CHECK(read.predict(set.X) == svm.predict(set.X));
  if (options.probabilities) CHECK(read.probabilities(set.X) == svm.probabilities(set.X));

  int found = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    try {
      static_cast<void>(Svm::deserialize(damaged));
    } catch (const std::invalid_argument&) {
      ++found;
    }
  }
  CHECK(found == static_cast<int>(bytes.size()));
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{7}, bytes.size() / 2, bytes.size() - 1}) {
    CHECK_THROWS_WITH(Svm::deserialize(bytes.substr(0, length)), Contains("the SVM is damaged"));
  }
}

TEST_CASE("an SVM refuses what cannot be trained") {
  const Features X = Features::Identity(4, 4);
  const auto message = [&](const Labels& labels, const SvmOptions& options) -> std::string {
    try {
      static_cast<void>(Svm::train(X, labels, options));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message({2, 2, 2, -1}, {}) ==
        "all labelled rows are of class 2, expected two classes or more");
  CHECK(message({-1, -1, -1, -1}, {}) == "no row has a label, expected two classes or more");
  CHECK(message({0, 1}, {}) == "there are 2 labels, expected one for each of 4 rows");
  CHECK(message({0, 1, -2, 0}, {}) == "a label is -2, expected -1 or more");
  const Labels labels{0, 1, 0, 1};
  SvmOptions options;
  options.C = 0.0;
  CHECK(message(labels, options) == "C is 0, expected a positive number");
  options = {};
  options.gamma = -1.0;
  CHECK(message(labels, options) == "gamma is -1, expected 0 for 1/d, or a positive number");
  options = {};
  options.tolerance = std::numeric_limits<double>::infinity();
  CHECK(message(labels, options) == "tolerance is inf, expected a positive number");
  options = {};
  options.cache_mb = -3.0;
  CHECK(message(labels, options) == "cache_mb is -3, expected a positive number");
  options = {};
  options.class_weights = {1.0, 0.0};
  CHECK(message(labels, options) == "a class weight is 0, expected a positive number");
  options.class_weights = {1.0};
  CHECK(message(labels, options) ==
        "there are 1 class weights, expected one for each label up to 1");

  const Svm svm = Svm::train(X, labels);
  CHECK_THROWS_WITH(svm.predict(Features::Zero(1, 3)), Contains("X has 3 columns, expected 4"));
  CHECK_THROWS_WITH(svm.probabilities(X), Contains("trained without probabilities"));
  CHECK_THROWS_WITH(svm.predict(X, -1), Contains("threads is -1"));
  CHECK_THROWS_WITH(cross_validate_svm(X, labels, {0, 1}), Contains("there are 2 folds"));
  CHECK_THROWS_WITH(cross_validate_svm(X, labels, {0, 1, -1, 0}), Contains("a fold is -1"));
  CHECK_THROWS_WITH(cross_validate_svm(X, labels, {0, 0, 0, 0}),
                    Contains("no row outside fold 0 has a label"));
}
