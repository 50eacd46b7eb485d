#include "shape3d/learning/confusion.hpp"

#include <catch2/catch.hpp>

using namespace shape3d::learning;

TEST_CASE("confusions are counted by true and predicted class") {
  const Labels truth{0, 0, 0, 1, 1, kUnlabelled, 2}, predicted{0, 0, 1, 1, 0, 2, 0};
  const Confusion found = confusion(truth, predicted, 4);
  CHECK(found.counts ==
        (Eigen::MatrixXi(4, 4) << 2, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0).finished());
  CHECK(found.total() == 6);
  CHECK(found.correct_rate() == Approx(3 / 6.0));
  CHECK(found.balanced_rate() == Approx((2 / 3.0 + 1 / 2.0 + 0) / 3));
  CHECK(found.majority_rate() == Approx(3 / 6.0));
  const Confusion none = confusion({}, {}, 2);
  CHECK(none.correct_rate() == 0.0);
  CHECK(none.balanced_rate() == 0.0);
  CHECK(none.majority_rate() == 0.0);
}

TEST_CASE("the paired test is the exact binomial one") {
  // 8 items that only the first has right, 2 that only the second has: p = 2 · 56 / 1024.
  Labels truth(20, 0), first(20, 0), second(20, 0);
  for (std::size_t i = 0; i < 8; ++i) second[i] = 1;
  first[8] = first[9] = 1;
  first[10] = second[10] = 1;
  const PairedTest test = paired_test(truth, first, second);
  CHECK(test.first_only == 8);
  CHECK(test.second_only == 2);
  CHECK(test.p == Approx(2.0 * (1 + 10 + 45) / 1024));
  CHECK(paired_test(truth, first, first).p == 1.0);
  CHECK(paired_test({0, 0}, {0, 1}, {1, 0}).p == 1.0);
}

TEST_CASE("confusions refuse what does not fit") {
  CHECK_THROWS_WITH(confusion({0, 1}, {0}, 2), "predicted has 1 labels, expected 2 as truth has");
  CHECK_THROWS_WITH(confusion({2}, {0}, 2),
                    "truth 0 is 2, expected less than 2, the number of classes");
  CHECK_THROWS_WITH(confusion({0}, {kUnlabelled}, 2),
                    "predicted 0 is -1, expected less than 2, the number of classes");
  CHECK_THROWS_WITH(confusion({}, {}, -1), "classes is -1, expected 0 or more");
  CHECK_THROWS_WITH(paired_test({0}, {0, 0}, {0}), "first has 2 labels, expected 1 as truth has");
  CHECK_THROWS_WITH(paired_test({0}, {0}, {}), "second has 0 labels, expected 1 as truth has");
}
