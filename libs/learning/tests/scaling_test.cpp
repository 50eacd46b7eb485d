#include "shape3d/learning/scaling.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "generated.hpp"

using namespace shape3d::learning;
using Catch::Matchers::Contains;

TEST_CASE("scalings do what their equations say") {
  const Features X = gaussian_clouds(57, 6, 3, 2.0, 4).X;
  const Scaling range = fit_scaling(X, ScalingKind::range);
  const Features ranged = range.apply(X);
  CHECK((ranged.colwise().minCoeff().array() + 1.0).abs().maxCoeff() < 1e-13);
  CHECK((ranged.colwise().maxCoeff().array() - 1.0).abs().maxCoeff() < 1e-13);

  const Features standard = fit_scaling(X, ScalingKind::standard).apply(X);
  CHECK(standard.colwise().mean().cwiseAbs().maxCoeff() < 1e-13);
  CHECK((standard.colwise().squaredNorm().array() / 57.0 - 1.0).abs().maxCoeff() < 1e-12);

  CHECK(fit_scaling(X, ScalingKind::none).apply(X) == X);
  for (const ScalingKind kind : {ScalingKind::none, ScalingKind::range, ScalingKind::standard}) {
    const Scaling scaling = fit_scaling(X, kind);
    CHECK(
        ((scaling.undo(scaling.apply(X)) - X).cwiseAbs().array() <= 1e-12 * X.cwiseAbs().maxCoeff())
            .all());
  }
}

TEST_CASE("a constant component has the factor 0") {
  Features X(3, 2);
  X << 0.1, 1, 0.1, 2, 0.1, 3;  // the mean of three 0.1 is not 0.1
  for (const ScalingKind kind : {ScalingKind::range, ScalingKind::standard}) {
    const Scaling scaling = fit_scaling(X, kind);
    CHECK(scaling.factor(0) == 0.0);
    Features other(1, 2);
    other << 1e9, 2;
    CHECK(scaling.apply(other).isZero());
    CHECK(scaling.undo(scaling.apply(X)) == X);
  }
}

TEST_CASE("scaling refuses what it cannot scale") {
  Features X = Features::Ones(2, 3);
  const Scaling scaling = fit_scaling(X, ScalingKind::range);
  CHECK_THROWS_WITH(scaling.apply(Features::Ones(1, 4)), Contains("X has 4 columns, expected 3"));
  CHECK_THROWS_WITH(scaling.undo(Features::Ones(1, 2)), Contains("X has 2 columns, expected 3"));
  CHECK_THROWS_WITH(fit_scaling(Features(0, 3), ScalingKind::none),
                    Contains("X has 0 rows and 3 columns"));
  X(1, 2) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(fit_scaling(X, ScalingKind::none),
                    Contains("row 1, column 2 of X is nan, expected a finite number"));
}
