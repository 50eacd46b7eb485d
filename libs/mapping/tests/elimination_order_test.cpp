#include "elimination_order.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include <Eigen/SparseCholesky>
#include <catch2/catch.hpp>

#include "support/closed_meshes.hpp"

namespace {
using namespace shape3d::mapping;
using namespace shape3d::test;
using Matrix = Eigen::SparseMatrix<double>;

/// A positive definite matrix with an entry for each vertex and edge, its rows in an order.
Matrix system(const ClosedMesh& mesh, const std::vector<std::int32_t>& order) {
  std::vector<std::int32_t> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<std::int32_t>(k);
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [from, to] : half_edges(mesh.F)) {
    entries.emplace_back(place[from], place[to], -1);
    entries.emplace_back(place[from], place[from], 2);
  }
  Matrix A(mesh.V.rows(), mesh.V.rows());
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

template <typename Ordering>
Eigen::Index fill(const Matrix& A) {
  const Eigen::SimplicialLLT<Matrix, Eigen::Lower, Ordering> factor(A);
  return Matrix(factor.matrixL()).nonZeros();
}

TEST_CASE("the elimination order is a permutation that fills less than minimum degree") {
  for (const int levels : {2, 4, 5, 6}) {
    const ClosedMesh mesh = star_shaped(levels, 3);
    const std::vector<std::int32_t> order = elimination_order(mesh.V, half_edges(mesh.F));
    std::vector<std::int32_t> sorted = order, all(mesh.V.rows());
    std::sort(sorted.begin(), sorted.end());
    std::iota(all.begin(), all.end(), 0);
    CHECK(sorted == all);
    CHECK(order == elimination_order(mesh.V, half_edges(mesh.F)));
    const Matrix A = system(mesh, order);
    const Eigen::Index ours = fill<Eigen::NaturalOrdering<int>>(A);
    const Eigen::Index minimum_degree = fill<Eigen::AMDOrdering<int>>(A);
    INFO("levels = " << levels << ": " << ours << ", " << minimum_degree);
    CHECK(static_cast<double>(ours) <
          (levels > 4 ? 0.97 : 1.1) * static_cast<double>(minimum_degree));
  }
}

TEST_CASE("loops, repeated edges and four vertices are ordered, too") {
  ClosedMesh mesh = icosphere(0);
  HalfEdges edges = half_edges(mesh.F);
  const std::vector<std::int32_t> order = elimination_order(mesh.V, edges);
  edges.push_back({3, 3});
  edges.insert(edges.end(), edges.begin(), edges.begin() + 9);
  CHECK(elimination_order(mesh.V, edges) == order);
  const Points corners = mesh.V.topRows(4);
  Triangles tetrahedron(4, 3);
  tetrahedron << 0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0;
  CHECK(elimination_order(corners, half_edges(tetrahedron)).size() == 4);
}

}  // namespace
