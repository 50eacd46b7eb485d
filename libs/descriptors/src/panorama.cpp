#include "shape3d/descriptors/panorama.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "parallel.hpp"
#include "text.hpp"

namespace shape3d::descriptors {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kReach = 2.0;      // of the cylinder on either side of the centroid
constexpr double kRadius = 3.0;     // of the cylinder
constexpr double kRowsApart = 1.0;  // length of an edge of the parts that are sampled, at most
constexpr int kMostParts = 4096;    // of an edge of one triangle
constexpr double kPi = 3.141592653589793;

void check(const PanoramaOptions& options) {
  detail::require_between("size", options.size, 8, 512);
  detail::require_between("K", options.K, 0, options.size / 2 - 1);
}

// Corners of a triangle in the unit of the frame.
struct Corners {
  Vector3d a, b, c;

  Corners(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
          const Frame& frame, Index t) {
    const auto corner = [&](int k) {
      return Vector3d((V.row(F(t, k)).transpose() - frame.centre) / frame.radius);
    };
    a = corner(0);
    b = corner(1);
    c = corner(2);
  }
  [[nodiscard]] Vector3d cross() const { return (b - a).cross(c - a); }
};

// Principal axes in rows, those of the largest moment first.
Matrix3d principal_axes(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
                        const Frame& frame, PanoramaAxes kind) {
  Matrix3d moments = Matrix3d::Zero();
  for (Index t = 0; t < F.rows(); ++t) {
    const Corners k(V, F, frame, t);
    const Vector3d cross = k.cross();
    const double twice = cross.norm();
    if (twice == 0.0) continue;
    if (kind == PanoramaAxes::normals) {
      moments += cross * (cross / twice).transpose();
    } else {  // ∫ x xᵀ over a triangle: A/12 (Σ corners + 9 middle middleᵀ)
      const Vector3d middle = (k.a + k.b + k.c) / 3.0;
      moments += twice * (k.a * k.a.transpose() + k.b * k.b.transpose() + k.c * k.c.transpose() +
                          9.0 * middle * middle.transpose());
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(moments);
  return solver.eigenvectors().rowwise().reverse().transpose();
}

// The outermost surface in each pixel about three axes.
class Panorama {
 public:
  explicit Panorama(int size)
      : size_(size),
        pixels_(static_cast<std::size_t>(size) * static_cast<std::size_t>(2 * size)),
        best_(3 * pixels_) {}

  // x and n in the principal axes.
  void add(const Vector3d& x, const Vector3d& n) {
    for (int axis = 0; axis < 3; ++axis) {
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      const double radius = std::hypot(x[next], x[last]);
      const double row = (x[axis] / kReach + 1.0) * 0.5 * size_;
      if (!(row >= 0.0 && row < size_ && radius < kRadius) || radius == 0.0) continue;
      const double turn = (std::atan2(x[last], x[next]) + kPi) / (2.0 * kPi);
      const int column = std::min(static_cast<int>(turn * 2 * size_), 2 * size_ - 1);
      const double facing = std::abs(n[next] * x[next] + n[last] * x[last]) / radius;
      Pixel& pixel = best_[static_cast<std::size_t>(axis) * pixels_ +
                           static_cast<std::size_t>(static_cast<int>(row) * 2 * size_ + column)];
      pixel = std::max(pixel, Pixel{radius, facing});
    }
  }

  // Maxima do not depend on their order.
  void merge(const Panorama& other) {
    for (std::size_t i = 0; i < best_.size(); ++i) best_[i] = std::max(best_[i], other.best_[i]);
  }

  [[nodiscard]] PanoramaImages images() const {
    PanoramaImages images;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      images.distance[axis].resize(size_, 2 * size_);
      images.facing[axis].resize(size_, 2 * size_);
      for (int row = 0; row < size_; ++row) {
        for (int column = 0; column < 2 * size_; ++column) {
          const Pixel& pixel =
              best_[axis * pixels_ + static_cast<std::size_t>(row * 2 * size_ + column)];
          images.distance[axis](row, column) = pixel.radius;
          images.facing[axis](row, column) = pixel.facing;
        }
      }
    }
    return images;
  }

 private:
  struct Pixel {
    double radius = 0.0, facing = 0.0;
    bool operator<(const Pixel& other) const {
      return radius < other.radius || (radius == other.radius && facing < other.facing);
    }
  };
  int size_;
  std::size_t pixels_;
  std::vector<Pixel> best_;
};

// Adds the middles of n² equal parts of a triangle.
void add_triangle(const Corners& k, double spacing, const Matrix3d& axes, Panorama& panorama) {
  const Vector3d cross = k.cross();
  const double twice = cross.norm();
  if (twice == 0.0) return;
  const double longest = std::sqrt(
      std::max({(k.b - k.a).squaredNorm(), (k.c - k.b).squaredNorm(), (k.a - k.c).squaredNorm()}));
  const int parts = static_cast<int>(std::min<double>(kMostParts, std::ceil(longest / spacing)));
  const Vector3d normal = axes * (cross / twice), origin = axes * k.a;
  const Vector3d u = axes * (k.b - k.a) / parts, v = axes * (k.c - k.a) / parts;
  for (int i = 0; i < parts; ++i) {
    for (int j = 0; i + j < parts; ++j) {
      panorama.add(origin + (i + 1.0 / 3.0) * u + (j + 1.0 / 3.0) * v, normal);
      if (i + j + 1 < parts) {
        panorama.add(origin + (i + 2.0 / 3.0) * u + (j + 2.0 / 3.0) * v, normal);
      }
    }
  }
}

using Complex = std::complex<double>;

// e^{−2πi k x / n}, k = 0 … K by x = 0 … n − 1.
Eigen::MatrixXcd turns(int K, int n) {
  Eigen::MatrixXcd result(K + 1, n);
  for (int k = 0; k <= K; ++k) {
    for (int x = 0; x < n; ++x) {
      result(k, x) = std::polar(1.0, -2.0 * kPi * ((k * x) % n) / n);
    }
  }
  return result;
}

}  // namespace

PanoramaImages panorama_images(const Eigen::Ref<const Points>& V,
                               const Eigen::Ref<const Triangles>& F, const PanoramaOptions& options,
                               int threads) {
  check(options);
  threads = detail::resolve_threads(threads);
  const Frame frame = surface_frame(V, F, Centre::area, Scale::rms, 1.0);
  const Matrix3d axes = principal_axes(V, F, frame, options.axes);
  const double spacing = kRowsApart * 2.0 * kReach / options.size;
  const std::int64_t count = F.rows();
  const std::int64_t grain = std::max<std::int64_t>(256, (count + threads - 1) / threads);
  std::vector<Panorama> parts(static_cast<std::size_t>((count + grain - 1) / grain),
                              Panorama(options.size));
  detail::parallel_blocks(count, grain, threads, [&](std::int64_t first, std::int64_t last) {
    Panorama& part = parts[static_cast<std::size_t>(first / grain)];
    for (std::int64_t t = first; t < last; ++t) {
      add_triangle(Corners(V, F, frame, t), spacing, axes, part);
    }
  });
  for (std::size_t i = 1; i < parts.size(); ++i) parts.front().merge(parts[i]);
  return parts.front().images();
}

Index panorama_length(const PanoramaOptions& options) {
  check(options);
  return Index{6} * (options.K + 1) * (options.K + 1);
}

Eigen::VectorXd panorama_spectrum(const Eigen::Ref<const Points>& V,
                                  const Eigen::Ref<const Triangles>& F,
                                  const PanoramaOptions& options, int threads) {
  const PanoramaImages images = panorama_images(V, F, options, threads);
  const int K = options.K, size = options.size;
  const Eigen::MatrixXcd along = turns(K, size), around = turns(K, 2 * size);
  const double pixels = 2.0 * size * size;
  Eigen::VectorXd spectrum(panorama_length(options));
  Index place = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Eigen::MatrixXd* const image : {&images.distance[axis], &images.facing[axis]}) {
      // Transforms of the rows, size by K + 1; then of their columns, for u and for −u.
      const Eigen::MatrixXcd rows = image->cast<Complex>() * around.transpose();
      const Eigen::MatrixXcd plus = along * rows, minus = along.conjugate() * rows;
      for (int u = 0; u <= K; ++u) {
        for (int v = 0; v <= K; ++v) {
          spectrum[place++] =
              std::sqrt(0.5 * (std::norm(plus(u, v)) + std::norm(minus(u, v)))) / pixels;
        }
      }
    }
  }
  return spectrum;
}

}  // namespace shape3d::descriptors
