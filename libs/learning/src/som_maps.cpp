#include "shape3d/learning/som_maps.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "text.hpp"

namespace shape3d::learning {
namespace {

void check_units(const std::vector<int>& units, int count) {
  for (const int unit : units) detail::require_between("a unit", unit, 0, count - 1);
}

// Items of each label at each unit; labels are 0 … the largest.
Eigen::MatrixXi votes(const std::vector<int>& units, const Labels& labels, int count) {
  if (units.size() != labels.size()) {
    throw std::invalid_argument("there are " + std::to_string(labels.size()) +
                                " labels, expected one for each of " +
                                std::to_string(units.size()) + " items");
  }
  check_units(units, count);
  int last = -1;
  for (const int label : labels) {
    detail::require(label >= kUnlabelled, "a label", label, "-1 or more");
    last = std::max(last, label);
  }
  Eigen::MatrixXi table = Eigen::MatrixXi::Zero(count, last + 1);
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (labels[i] != kUnlabelled) ++table(units[i], labels[i]);
  }
  return table;
}

}  // namespace

SomQuality som_quality(const Som& som, const BestUnits& best) {
  if (best.first.empty()) throw std::invalid_argument("there is no item, expected at least one");
  const auto neighbours = som_neighbours(som.grid);
  SomQuality quality;
  quality.quantization_error = best.distance.mean();
  std::size_t torn = 0;
  for (std::size_t i = 0; i < best.first.size(); ++i) {
    const auto& near = neighbours[static_cast<std::size_t>(best.first[i])];
    if (!std::binary_search(near.begin(), near.end(), best.second[i])) ++torn;
  }
  quality.topographic_error = static_cast<double>(torn) / static_cast<double>(best.first.size());
  return quality;
}

UMatrix u_matrix(const Som& som) {
  const SomGrid& grid = som.grid;
  const Eigen::MatrixX2d R = som_positions(grid);
  const bool wraps = grid.shape == SomShape::toroid;
  const bool hexagonal = grid.lattice == SomLattice::hexagonal;
  const Eigen::Index rows = 2 * grid.rows - (wraps ? 0 : 1);
  const Eigen::Index columns = 2 * grid.columns - (wraps ? 0 : 1);
  const auto at = [&](Eigen::Index r, Eigen::Index c) {
    return (r % grid.rows) * grid.columns + c % grid.columns;
  };
  const auto distance = [&](Eigen::Index a, Eigen::Index b) {
    return (som.prototypes.row(a) - som.prototypes.row(b)).norm();
  };

  UMatrix u;
  u.values.resize(rows, columns);
  u.x.resize(rows, columns);
  u.y.resize(rows, columns);
  const auto neighbours = som_neighbours(grid);
  const double row_height = hexagonal ? std::sqrt(0.75) : 1.0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Eigen::Index r = i / 2;
    double shift = 0.0;
    if (hexagonal) shift = i % 2 == 1 ? 0.25 : (r % 2 == 1 ? 0.5 : 0.0);
    for (Eigen::Index j = 0; j < columns; ++j) {
      const Eigen::Index c = j / 2;
      u.x(i, j) = 0.5 * static_cast<double>(j) + shift;
      u.y(i, j) = 0.5 * static_cast<double>(i) * row_height;
      if (i % 2 == 0 && j % 2 == 0) {
        const auto unit = at(r, c);
        double sum = 0.0;
        const auto& near = neighbours[static_cast<std::size_t>(unit)];
        for (const int other : near) sum += distance(unit, other);
        u.values(i, j) = sum / static_cast<double>(near.size());
      } else if (i % 2 == 0) {
        u.values(i, j) = distance(at(r, c), at(r, c + 1));
      } else if (j % 2 == 0) {
        u.values(i, j) = distance(at(r, c), at(r + 1, c));
      } else if (hexagonal) {
        // Left and right of it are the unit of the unshifted row and that of the shifted one.
        u.values(i, j) = r % 2 == 0 ? distance(at(r, c + 1), at(r + 1, c))
                                    : distance(at(r, c), at(r + 1, c + 1));
      } else {
        u.values(i, j) =
            (distance(at(r, c), at(r + 1, c + 1)) + distance(at(r, c + 1), at(r + 1, c))) /
            (2.0 * std::sqrt(2.0));
      }
    }
  }
  return u;
}

Eigen::MatrixXd component_plane(const Som& som, Eigen::Index component) {
  detail::require_between("component", component, 0, som.prototypes.cols() - 1);
  const Features M = som.unscaled_prototypes();
  Eigen::MatrixXd plane(som.grid.rows, som.grid.columns);
  for (int i = 0; i < som.grid.units(); ++i) {
    plane(i / som.grid.columns, i % som.grid.columns) = M(i, component);
  }
  return plane;
}

Eigen::MatrixXi hit_histogram(const SomGrid& grid, const std::vector<int>& units) {
  check_grid(grid);
  check_units(units, grid.units());
  Eigen::MatrixXi hits = Eigen::MatrixXi::Zero(grid.rows, grid.columns);
  for (const int unit : units) ++hits(unit / grid.columns, unit % grid.columns);
  return hits;
}

Labels vote_labels(const std::vector<int>& units, const Labels& labels, int count) {
  const Eigen::MatrixXi table = votes(units, labels, count);
  Labels result(static_cast<std::size_t>(count), kUnlabelled);
  for (int u = 0; u < count; ++u) {
    Eigen::Index label = 0;
    if (table.cols() > 0 && table.row(u).maxCoeff(&label) > 0) {
      result[static_cast<std::size_t>(u)] = static_cast<int>(label);
    }
  }
  return result;
}

double purity(const std::vector<int>& units, const Labels& labels, int count) {
  const Eigen::MatrixXi table = votes(units, labels, count);
  const int all = table.sum();
  if (all == 0) return 0.0;
  return static_cast<double>(table.rowwise().maxCoeff().sum()) / all;
}

Labels classify_by_som(const Som& som, const Labels& unit_labels, const FeaturesView& X,
                       int threads) {
  if (static_cast<int>(unit_labels.size()) != som.grid.units()) {
    throw std::invalid_argument("there are " + std::to_string(unit_labels.size()) +
                                " labels of units, expected " + std::to_string(som.grid.units()));
  }
  std::vector<Eigen::Index> named;
  for (std::size_t u = 0; u < unit_labels.size(); ++u) {
    if (unit_labels[u] != kUnlabelled) named.push_back(static_cast<Eigen::Index>(u));
  }
  if (named.empty()) {
    throw std::invalid_argument("no unit of the map has a label, expected at least one");
  }
  Som part;
  part.scaling = som.scaling;
  part.prototypes.resize(static_cast<Eigen::Index>(named.size()), som.prototypes.cols());
  for (std::size_t i = 0; i < named.size(); ++i) {
    part.prototypes.row(static_cast<Eigen::Index>(i)) = som.prototypes.row(named[i]);
  }
  Labels result;
  for (const int unit : best_units(part, X, threads).first) {
    result.push_back(unit_labels[static_cast<std::size_t>(named[static_cast<std::size_t>(unit)])]);
  }
  return result;
}

}  // namespace shape3d::learning
