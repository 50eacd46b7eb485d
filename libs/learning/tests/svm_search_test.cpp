#include "shape3d/learning/svm_search.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "generated.hpp"
#include "shape3d/learning/folds.hpp"

using namespace shape3d::learning;
using Catch::Matchers::Contains;

TEST_CASE("each rate of the search is that of a cross-validation") {
  GeneratedSet set = gaussian_clouds(140, 4, 3, 1.2, 3);
  set.labels[5] = kUnlabelled;
  set.labels[9] = 17;  // a class of one: nobody can predict it
  const std::vector<int> folds = stratified_folds(set.labels, 4, 7);
  const SvmGrid grid{{0.1, 1.0, 100.0}, {0.01, 0.1, 1.0}};
  SvmOptions options;
  options.balanced = true;
  const SvmSearch search = search_svm(set.X, set.labels, folds, options, grid, 1);
  double best = -1.0;
  for (Eigen::Index c = 0; c < 3; ++c) {
    for (Eigen::Index g = 0; g < 3; ++g) {
      SvmOptions tried = options;
      tried.C = grid.C[static_cast<std::size_t>(c)];
      tried.gamma = grid.gamma[static_cast<std::size_t>(g)];
      const Labels predicted = cross_validate_svm(set.X, set.labels, folds, tried).labels;
      int right = 0;
      for (std::size_t i = 0; i < predicted.size(); ++i) right += predicted[i] == set.labels[i];
      CHECK(search.correct_rate(c, g) == right / 138.0);
      if (right / 138.0 > best) {
        best = right / 138.0;
        CHECK(search.best >= best);
        if (best == search.best) {
          CHECK(search.C == tried.C);
          CHECK(search.gamma == tried.gamma);
        }
      }
    }
  }
  CHECK(search.best == best);
  const SvmSearch threads = search_svm(set.X, set.labels, folds, options, grid, 2);
  CHECK(threads.correct_rate == search.correct_rate);
}

TEST_CASE("the grid is that of libsvm") {
  const SvmGrid rbf = default_svm_grid(SvmKernel::rbf);
  CHECK(rbf.C.size() == 11);
  CHECK(rbf.gamma.size() == 10);
  CHECK(rbf.C.front() == 1.0 / 32.0);
  CHECK(rbf.C.back() == 32768.0);
  CHECK(rbf.gamma.front() == 1.0 / 32768.0);
  CHECK(rbf.gamma.back() == 8.0);
  CHECK(default_svm_grid(SvmKernel::linear).gamma.size() == 1);
}

TEST_CASE("a search reports its progress and can be cancelled") {
  const GeneratedSet set = gaussian_clouds(40, 3, 2, 2.0, 3);
  const std::vector<int> folds = stratified_folds(set.labels, 2, 7);
  const SvmGrid grid{{1.0, 10.0}, {0.1}};
  std::vector<double> shares;
  const auto note = [&](double share) {
    shares.push_back(share);
    return true;
  };
  CHECK_FALSE(search_svm(set.X, set.labels, folds, {}, grid, 2, note).cancelled);
  CHECK(shares == std::vector<double>{0.25, 0.5, 0.75, 1.0});

  int calls = 0;
  const SvmSearch cancelled = search_svm(set.X, set.labels, folds, {}, grid, 1, [&](double) {
    ++calls;
    return false;
  });
  CHECK(calls == 1);
  CHECK(cancelled.cancelled);
  CHECK(std::isnan(cancelled.correct_rate(0, 0)));
}

TEST_CASE("a search refuses an empty grid and classes of one") {
  const Features X = Features::Identity(4, 4);
  const std::vector<int> folds{0, 1, 0, 1};
  CHECK_THROWS_WITH(search_svm(X, {0, 1, 0, 1}, folds, {}, {{}, {1.0}}),
                    Contains("the grid has no C"));
  CHECK_THROWS_WITH(search_svm(X, {0, 1, 0, 1}, folds, {}, {{1.0}, {}}),
                    Contains("the grid has no gamma"));
  CHECK_THROWS_WITH(search_svm(X, {0, 1, 0, 1}, folds, {}, {{1.0}, {0.0}}),
                    Contains("gamma is 0, expected a positive number"));
  CHECK_THROWS_WITH(search_svm(X, {0, 1, 2, 3}, folds, {}, {{1.0}, {1.0}}),
                    Contains("expected classes of two members or more"));
}
