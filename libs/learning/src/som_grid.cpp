#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shape3d/learning/som.hpp"
#include "text.hpp"

namespace shape3d::learning {
namespace {

const double kRowHeight = std::sqrt(0.75);  // of a hexagonal grid

double row_height(const SomGrid& grid) {
  return grid.lattice == SomLattice::hexagonal ? kRowHeight : 1.0;
}

}  // namespace

void check_grid(const SomGrid& grid) {
  constexpr int kMost = 1000;
  const int least = grid.shape == SomShape::toroid ? 3 : 1;
  detail::require_between("rows", grid.rows, least, kMost);
  detail::require_between("columns", grid.columns, least, kMost);
  detail::require_between("units", grid.units(), 2, 10000);
  if (grid.shape == SomShape::toroid && grid.lattice == SomLattice::hexagonal) {
    detail::require(grid.rows % 2 == 0, "rows", grid.rows,
                    "an even number for a hexagonal toroid, whose odd rows are shifted");
  }
}

Eigen::MatrixX2d som_positions(const SomGrid& grid) {
  check_grid(grid);
  Eigen::MatrixX2d R(grid.units(), 2);
  const bool shifted = grid.lattice == SomLattice::hexagonal;
  for (int i = 0; i < grid.units(); ++i) {
    const int row = i / grid.columns;
    R(i, 0) = i % grid.columns + (shifted && row % 2 == 1 ? 0.5 : 0.0);
    R(i, 1) = row * row_height(grid);
  }
  return R;
}

Eigen::MatrixXd som_distances(const SomGrid& grid) {
  const Eigen::MatrixX2d R = som_positions(grid);
  const double width = grid.columns;
  const double height = grid.rows * row_height(grid);
  Eigen::MatrixXd D(grid.units(), grid.units());
  for (Eigen::Index i = 0; i < D.rows(); ++i) {
    for (Eigen::Index j = 0; j < D.cols(); ++j) {
      double dx = std::abs(R(i, 0) - R(j, 0));
      double dy = std::abs(R(i, 1) - R(j, 1));
      if (grid.shape == SomShape::toroid) {
        dx = std::min(dx, width - dx);
        dy = std::min(dy, height - dy);
      }
      D(i, j) = std::sqrt(dx * dx + dy * dy);
    }
  }
  return D;
}

std::vector<std::vector<int>> som_neighbours(const SomGrid& grid) {
  const Eigen::MatrixXd D = som_distances(grid);
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(grid.units()));
  for (int i = 0; i < grid.units(); ++i) {
    for (int j = 0; j < grid.units(); ++j) {
      // The next distances are √2 and √3.
      if (i != j && D(i, j) < 1.2) neighbours[static_cast<std::size_t>(i)].push_back(j);
    }
  }
  return neighbours;
}

}  // namespace shape3d::learning
