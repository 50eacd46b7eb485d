#pragma once

#include <vector>

#include <Eigen/Core>

namespace shape3d::descriptors {

/// Sums over the cells of an image on the sphere, each triangle counting by the area that it and a
/// cell have in common.
///
/// In (z, φ), z = cos θ, area is dz dφ. The part of a cell that lies north of the great circle
/// z = Z(φ) through an edge is ∫ (z1 − clip(Z, z0, z1)) dφ, which is elementary; a triangle is the
/// sum over its edges of those parts, counted + where the edge runs east with the triangle to its
/// north and − where it runs west, plus the whole sphere when the south pole is inside.
class SphereCells {
 public:
  SphereCells(int size, int components);

  /// Adds `value` times the common areas of a spherical triangle, counter-clockwise seen from
  /// outside.
  /// @param corners  Unit vectors, no two opposite; not closer to the z axis than off_axis() makes
  /// them.
  void add(const Eigen::Vector3d (&corners)[3], const double* value);

  /// The sums of another of the same size and components.
  void add(const SphereCells& other);

  /// Sums divided by the areas of the cells: 2n² by components, rows of a SphericalImage.
  [[nodiscard]] Eigen::MatrixXd means() const;

 private:
  void add_edge(const Eigen::Vector3d& A, const Eigen::Vector3d& B, double sweep, double side,
                const double* value);
  void add_arc(int column, double u0, double u1, double g, double h, double sign,
               const double* value);
  void add_piece(int column, int row, double u0, double u1, double g, double h, double sign,
                 const double* value);

  int size_, components_;
  std::vector<double> borders_;     // z of the northern border of each row, and of the south pole
  std::vector<double> cotangents_;  // of θ at the borders
  std::vector<double> own_;    // part of the cell that holds the edge, by column, row, component
  std::vector<double> north_;  // ∫ dφ of the edges in a cell, for all rows north of it
  std::vector<double> everywhere_;  // of triangles that hold the south pole
};

/// A point nearer to the z axis than 1e-9 is moved there, so that every edge has a sweep in φ.
[[nodiscard]] Eigen::Vector3d off_axis(const Eigen::Vector3d& point);

/// Change of φ from A to B along the great circle, in (−π, π): positive when it runs east. The
/// change from B to A is exactly its negative.
[[nodiscard]] double sweep_of(const Eigen::Vector3d& A, const Eigen::Vector3d& B);

}  // namespace shape3d::descriptors
