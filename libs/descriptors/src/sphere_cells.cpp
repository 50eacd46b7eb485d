#include "sphere_cells.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "sh_checks.hpp"

namespace shape3d::descriptors {
namespace {

using detail::kPi;

constexpr double kOffAxis = 1e-9;

bool before(const Eigen::Vector3d& A, const Eigen::Vector3d& B) {
  return std::lexicographical_compare(A.data(), A.data() + 3, B.data(), B.data() + 3);
}

// Normal of the plane of A and B; the difference is exact when they are near to one another.
Eigen::Vector3d plane_of(const Eigen::Vector3d& A, const Eigen::Vector3d& B) {
  return A.cross(B - A);
}

}  // namespace

Eigen::Vector3d off_axis(const Eigen::Vector3d& point) {
  if (std::hypot(point.x(), point.y()) >= kOffAxis) return point;
  return {kOffAxis, 0.0, std::copysign(1.0, point.z())};
}

double sweep_of(const Eigen::Vector3d& A, const Eigen::Vector3d& B) {
  if (before(B, A)) return -sweep_of(B, A);
  const double east = plane_of(A, B).z();
  double sweep = std::atan2(B.y(), B.x()) - std::atan2(A.y(), A.x());
  if (sweep > kPi) sweep -= 2.0 * kPi;
  if (sweep < -kPi) sweep += 2.0 * kPi;
  // Near ±π the edge passes beside a pole, and its plane says on which side.
  if (std::abs(sweep) > 0.5 * kPi && (sweep > 0.0) != (east > 0.0)) {
    sweep += sweep > 0.0 ? -2.0 * kPi : 2.0 * kPi;
  }
  return sweep;
}

SphereCells::SphereCells(int size, int components)
    : size_(size), components_(components), everywhere_(static_cast<std::size_t>(components), 0.0) {
  for (int row = 0; row <= size; ++row) {
    const double theta = kPi * row / size;
    borders_.push_back(std::cos(theta));
    cotangents_.push_back(std::cos(theta) / std::sin(theta));  // not used at the poles
  }
  borders_.front() = 1.0;
  borders_.back() = -1.0;
  const auto cells = static_cast<std::size_t>(2 * size) * static_cast<std::size_t>(size);
  own_.assign(cells * static_cast<std::size_t>(components), 0.0);
  north_.assign(own_.size(), 0.0);
}

void SphereCells::add(const Eigen::Vector3d (&corners)[3], const double* value) {
  double whole = 0.0;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d &A = corners[i], &B = corners[(i + 1) % 3];
    const double sweep = sweep_of(A, B);
    whole += sweep;
    if (sweep == 0.0) continue;
    // Edges are integrated in one direction only, so that the two triangles at one agree.
    if (before(A, B)) {
      add_edge(A, B, sweep, 1.0, value);
    } else {
      add_edge(B, A, -sweep, -1.0, value);
    }
  }
  if (whole < -kPi) {
    for (int c = 0; c < components_; ++c) everywhere_[static_cast<std::size_t>(c)] += value[c];
  }
}

void SphereCells::add_edge(const Eigen::Vector3d& A, const Eigen::Vector3d& B, double sweep,
                           double side, const double* value) {
  // On the circle cot θ = (g/h) cos u with u = φ − φ0, g² + h² = 1, h > 0.
  const Eigen::Vector3d N = plane_of(A, B);
  const double flat = std::hypot(N.x(), N.y()), length = std::hypot(flat, N.z());
  if (length == 0.0) return;
  const double g = flat / length, h = std::abs(N.z()) / length;
  const double phi0 = N.z() > 0.0 ? std::atan2(-N.y(), -N.x()) : std::atan2(N.y(), N.x());
  const double phi = std::atan2(A.y(), A.x());
  const double west = std::min(phi, phi + sweep), east = std::max(phi, phi + sweep);
  const double sign = sweep > 0.0 ? side : -side;
  const double step = kPi / size_;

  double from = west;
  for (int column = static_cast<int>(std::floor(west / step + 0.5)); from < east; ++column) {
    const double to = std::min(east, (column + 0.5) * step);
    if (to > from) {
      const int index = ((column % (2 * size_)) + 2 * size_) % (2 * size_);
      // u in [−π, π), cut where the circle turns north or south.
      double u0 = std::remainder(from - phi0, 2.0 * kPi);
      double u1 = u0 + (to - from);
      for (const double turn : {0.0, kPi}) {
        if (u0 < turn && turn < u1) {
          add_arc(index, u0, turn, g, h, sign, value);
          u0 = turn;
        }
      }
      if (u0 >= kPi) {
        u0 -= 2.0 * kPi;
        u1 -= 2.0 * kPi;
      }
      add_arc(index, u0, u1, g, h, sign, value);
    }
    from = to;
  }
}

// A piece of a circle in one column on which θ is monotone: −π ≤ u0 < u1 ≤ 0 (northwards) or
// 0 ≤ u0 < u1 ≤ π (southwards). Cut at the borders of rows.
void SphereCells::add_arc(int column, double u0, double u1, double g, double h, double sign,
                          const double* value) {
  const auto row_at = [&](double u) {
    const double theta = std::atan2(h, g * std::cos(u));
    return std::clamp(static_cast<int>(theta * size_ / kPi), 0, size_ - 1);
  };
  int row = row_at(u0);
  const int last = row_at(u1);
  const bool south = last > row;
  const double side = u0 + u1 < 0.0 ? -1.0 : 1.0;
  while (row != last) {
    const int border = south ? row + 1 : row;
    const double cosine = h / g * cotangents_[static_cast<std::size_t>(border)];
    const double u = std::clamp(side * std::acos(std::clamp(cosine, -1.0, 1.0)), u0, u1);
    add_piece(column, row, u0, u, g, h, sign, value);
    u0 = u;
    row += south ? 1 : -1;
  }
  add_piece(column, row, u0, u1, g, h, sign, value);
}

void SphereCells::add_piece(int column, int row, double u0, double u1, double g, double h,
                            double sign, const double* value) {
  // ∫ Z du = asin(g sin u), as atan2: near ±1 the arc sine would lose half of the digits.
  const auto integral = [g, h](double u) {
    return std::atan2(g * std::sin(u), std::hypot(h, g * std::cos(u)));
  };
  const double width = sign * (u1 - u0);
  const double part =
      borders_[static_cast<std::size_t>(row)] * width - sign * (integral(u1) - integral(u0));
  const std::size_t cell = (static_cast<std::size_t>(column) * static_cast<std::size_t>(size_) +
                            static_cast<std::size_t>(row)) *
                           static_cast<std::size_t>(components_);
  for (int c = 0; c < components_; ++c) {
    own_[cell + static_cast<std::size_t>(c)] += part * value[c];
    north_[cell + static_cast<std::size_t>(c)] += width * value[c];
  }
}

void SphereCells::add(const SphereCells& other) {
  for (std::size_t i = 0; i < own_.size(); ++i) {
    own_[i] += other.own_[i];
    north_[i] += other.north_[i];
  }
  for (std::size_t c = 0; c < everywhere_.size(); ++c) everywhere_[c] += other.everywhere_[c];
}

Eigen::MatrixXd SphereCells::means() const {
  Eigen::MatrixXd means(Eigen::Index{2} * size_ * size_, components_);
  const double width = kPi / size_;
  for (int column = 0; column < 2 * size_; ++column) {
    for (int c = 0; c < components_; ++c) {
      double north = everywhere_[static_cast<std::size_t>(c)] * width;
      for (int row = size_ - 1; row >= 0; --row) {
        const auto j = static_cast<std::size_t>(row);
        const std::size_t cell =
            (static_cast<std::size_t>(column) * static_cast<std::size_t>(size_) + j) *
                static_cast<std::size_t>(components_) +
            static_cast<std::size_t>(c);
        const double height = borders_[j] - borders_[j + 1];
        means(Eigen::Index{2} * size_ * row + column, c) =
            north / width + own_[cell] / (width * height);
        north += north_[cell];
      }
    }
  }
  return means;
}

}  // namespace shape3d::descriptors
