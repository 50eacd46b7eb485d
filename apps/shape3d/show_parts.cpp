#include "show_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include <shape3d/descriptors/csm.hpp>
#include <shape3d/descriptors/hsh.hpp>
#include <shape3d/descriptors/sh.hpp>
#include <shape3d/descriptors/shape_distribution.hpp>
#include <shape3d/descriptors/spherical_image.hpp>
#include <shape3d/descriptors/voxelize.hpp>
#include <shape3d/zmc/extract.hpp>

#include "common/color_map.hpp"
#include "common/describe_mesh.hpp"
#include "common/raster.hpp"
#include "common/text.hpp"

namespace shape3d::apps {
namespace {

namespace d = descriptors;

constexpr double kPi = 3.14159265358979323846;
constexpr int kImageHeight = 240;

std::string percent(double share) { return to_text(std::round(1000.0 * share) / 10.0) + " %"; }

// Collects the panels.
class Collector {
 public:
  explicit Collector(ShownParts& parts) : parts_(parts) {}

  /// The y axis upwards, as in the slices and as most models stand; pictures have z upwards.
  SceneMesh scene(Mesh mesh) {
    mesh.V.col(1).swap(mesh.V.col(2));
    mesh.V.col(1) = -mesh.V.col(1);
    parts_.meshes.push_back(std::move(mesh));
    SceneMesh scene;
    scene.mesh = view_of(parts_.meshes.back());
    return scene;
  }

  void add_scene(SceneMesh scene, const std::string& caption) {
    Panel panel;
    panel.meshes.push_back(std::move(scene));
    panel.caption = caption;
    panel.view = View::oblique;
    parts_.panels.push_back(std::move(panel));
  }

  void add_image(Raster image, const std::string& caption,
                 const std::optional<ColorScale>& scale = std::nullopt) {
    Panel panel;
    panel.image = std::move(image);
    panel.caption = caption;
    panel.scale = scale;
    parts_.panels.push_back(std::move(panel));
  }

  void set_residual(double residual) { parts_.residual = residual; }

 private:
  ShownParts& parts_;
};

Mesh mesh_of(const Mesh::Points& V, const Mesh::Triangles& F) {
  Mesh mesh;
  mesh.V = V;
  mesh.F = F;
  return mesh;
}

ColorScale voxel_scale(const d::Voxels& voxels) {
  ColorScale scale;
  scale.map = ColorMap::viridis;
  scale.upper = std::max(1e-30f, *std::max_element(voxels.values.begin(), voxels.values.end()));
  return scale;
}

// The upper one of the two middle layers in z, y upwards.
Raster slice_of(const d::Voxels& voxels, const ColorScale& scale) {
  const int n = voxels.side;
  std::vector<double> values;
  for (int j = n - 1; j >= 0; --j) {
    for (int i = 0; i < n; ++i) values.push_back(voxels.at(i, j, n / 2));
  }
  Raster raster = make_raster(n, n, {0, 0, 0});
  raster.rgb = colors_of(values.data(), values.size(), scale);
  return raster;
}

// Isosurface of voxels; empty when the level divides nothing.
Mesh level_surface(const d::Voxels& voxels, double level) {
  zmc::VolumeView view;
  view.data = voxels.values.data();
  view.type = zmc::SampleType::float32;
  view.dims = {voxels.side, voxels.side, voxels.side};
  zmc::Options options;
  options.inside = zmc::Inside::above;
  options.border = zmc::Border::capped;
  const auto surface = zmc::extract(view, level, options);
  Mesh mesh;
  mesh.V = surface.V();
  mesh.F = surface.F();
  return mesh;
}

// Gaussians of distances are cut nearer to the surface than the middle of their range.
double share_of(d::Fill fill) {
  return fill == d::Fill::gedt || fill == d::Fill::distance ? 0.8 : 0.5;
}

// A table of numbers, one row of squares above the other, row 0 at the foot; NaN is left grey.
Raster squares_of(const Eigen::MatrixXd& values, const ColorScale& scale) {
  const int rows = static_cast<int>(values.rows()), columns = static_cast<int>(values.cols());
  std::vector<double> ordered;
  for (int row = rows - 1; row >= 0; --row) {
    for (int column = 0; column < columns; ++column) ordered.push_back(values(row, column));
  }
  Raster raster = make_raster(columns, rows, {0, 0, 0});
  raster.rgb = colors_of(ordered.data(), ordered.size(), scale);
  return raster;
}

Raster equirectangular(const d::SphericalImage& image, double low, double high) {
  Raster raster = make_raster(2 * kImageHeight, kImageHeight, {0, 0, 0});
  if (image.samples.cols() == 3) {
    raster.rgb = d::equirectangular_picture(image, kImageHeight, low, high);
    return raster;
  }
  ColorScale scale;
  scale.map = low < 0.0 ? ColorMap::cool_warm : ColorMap::viridis;
  scale.lower = low;
  scale.upper = high;
  // Rows from the north; columns from φ = −π.
  std::vector<double> values;
  for (int row = 0; row < image.size; ++row) {
    for (int column = 0; column < 2 * image.size; ++column) {
      const int shifted = (column + image.size) % (2 * image.size);
      values.push_back(image.samples(Eigen::Index{2} * image.size * row + shifted, 0));
    }
  }
  Raster small = make_raster(2 * image.size, image.size, {0, 0, 0});
  small.rgb = colors_of(values.data(), values.size(), scale);
  return resized(small, raster.width, raster.height);
}

// Voxels on a sphere of radius ρ (of the ball), by trilinear interpolation.
d::SphericalImage sphere_of(const d::Voxels& voxels, double radius, int size) {
  d::SphericalImage image;
  image.size = size;
  image.samples.resize(Eigen::Index{2} * size * size, 1);
  const int n = voxels.side;
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < 2 * size; ++column) {
      const Eigen::Vector3d place =
          (radius * d::image_direction(size, row, column).array() + 1.0) * (0.5 * n) - 0.5;
      double sum = 0.0;
      const Eigen::Vector3i low = place.array().floor().cast<int>();
      for (int corner = 0; corner < 8; ++corner) {
        double weight = 1.0;
        int index[3];
        for (int axis = 0; axis < 3; ++axis) {
          const int step = (corner >> axis) & 1;
          const double part = place[axis] - low[axis];
          weight *= step == 1 ? part : 1.0 - part;
          index[axis] = low[axis] + step;
        }
        const bool inside =
            *std::min_element(index, index + 3) >= 0 && *std::max_element(index, index + 3) < n;
        if (inside) sum += weight * voxels.at(index[0], index[1], index[2]);
      }
      image.samples(Eigen::Index{2} * size * row + column, 0) = sum;
    }
  }
  return image;
}

void show_voxels(Collector& collector, const d::Voxels& voxels, double level,
                 const ColorScale& scale) {
  Mesh surface = level_surface(voxels, level);
  if (surface.F.rows() > 0) {
    collector.add_scene(collector.scene(std::move(surface)), "voxels at " + to_text(level));
  }
  collector.add_image(slice_of(voxels, scale), "middle slice of the voxels", scale);
}

// ‖f_{λ,l}‖ as a triangle.
void show_energies(Collector& collector, const d::HshCoefficients& coefficients) {
  const Eigen::VectorXd energies = d::hsh_energies(coefficients);
  const int K = coefficients.K;
  Eigen::MatrixXd table =
      Eigen::MatrixXd::Constant(K + 1, K + 1, std::numeric_limits<double>::quiet_NaN());
  for (int lambda = 0; lambda <= K; ++lambda) {
    for (int l = 0; l <= lambda; ++l) {
      table(lambda, l) = energies[static_cast<Eigen::Index>(d::hsh_pair_index(lambda, l))];
    }
  }
  ColorScale scale;
  scale.upper = std::max(1e-30, energies.maxCoeff());
  collector.add_image(squares_of(table, scale), "norms: l across, lambda upwards", scale);
}

// Three digits, as the captions show it.
double rounded_level(double level) {
  const double digit = std::pow(10.0, std::floor(std::log10(level)) - 2.0);
  return std::round(level / digit) * digit;
}

// Up to eight spheres, from the inner to the outer, before and after truncation, and the vector by
// sphere.
void show_spheres(Collector& collector, const d::CsmParameters& p, const d::Voxels& voxels,
                  const ColorScale& scale, int threads) {
  const Eigen::VectorXd vector = d::ConcentricSpheres(p.spheres, p.voxels.side)(voxels, threads);
  ColorScale norms;
  norms.upper = std::max(1e-30, vector.maxCoeff());
  const Eigen::Index numbers = vector.size() / p.spheres.R;
  const Eigen::MatrixXd table = vector.reshaped(numbers, p.spheres.R).transpose();
  collector.add_image(squares_of(table, norms), "norms: degree across, sphere upwards", norms);

  const int shown = std::min(8, p.spheres.R);
  const int rows = (shown + 1) / 2, height = kImageHeight / 2, gap = 4;
  Raster spheres = make_raster(2 * (2 * height + gap), rows * (height + gap), {1, 1, 1});
  Raster truncated = spheres;
  const int size = 2 * (p.voxels.side / 2);  // rows of an image are even
  const d::ShTransform transform(size, p.spheres.K);
  double rest = 0.0, whole = 0.0;
  for (int i = 0; i < shown; ++i) {
    const int sphere = shown == 1 ? 0 : i * (p.spheres.R - 1) / (shown - 1);
    const double radius = (sphere + 0.5) / p.spheres.R;
    d::SphericalImage image = sphere_of(voxels, radius, size);
    const int x = (i % 2) * (2 * height + gap), y = (i / 2) * (height + gap);
    paste(spheres, resized(equirectangular(image, 0.0, scale.upper), 2 * height, height), x, y);
    const Eigen::MatrixXcd coefficients = transform(image.samples);
    const double norm = coefficients.norm(),
                 residual = d::sh_residual(coefficients, image.samples, size);
    if (residual < 1.0) {
      const double power = radius * radius * norm * norm / (1.0 - residual * residual);
      whole += power;
      rest += power * residual * residual;
    }
    image.samples = d::sh_reconstruct(coefficients, size);
    paste(truncated, resized(equirectangular(image, 0.0, scale.upper), 2 * height, height), x, y);
  }
  collector.add_image(std::move(spheres), "spheres from the inner to the outer", scale);
  std::string caption = "degrees up to " + std::to_string(p.spheres.K);
  if (whole > 0.0) {
    collector.set_residual(std::sqrt(rest / whole));
    caption += ", residual " + percent(std::sqrt(rest / whole));
  }
  collector.add_image(std::move(truncated), caption, scale);
}

void show(Collector& collector, const d::HshParameters& p, const PosedMesh& mesh, int threads) {
  const d::Voxels voxels = [&] {
    d::VoxelizeOptions options = p.voxels;
    options.threads = threads;
    return d::voxelize(mesh.V, mesh.F, options);
  }();
  const ColorScale scale = voxel_scale(voxels);
  const double level = rounded_level(share_of(p.voxels.fill) * scale.upper);
  show_voxels(collector, voxels, level, scale);
  const d::HshCoefficients coefficients =
      d::HshTransform(p.transform, p.voxels.side)(voxels, threads);
  const d::Voxels series = d::reconstruct(coefficients, p.voxels.side, threads);
  const double residual = d::hsh_residual(coefficients, voxels, threads);
  collector.set_residual(residual);
  show_energies(collector, coefficients);
  Mesh surface = level_surface(series, level);
  if (surface.F.rows() > 0) {
    collector.add_scene(collector.scene(std::move(surface)),
                        "degrees up to " + std::to_string(p.transform.K) + " at " + to_text(level));
  }
  collector.add_image(slice_of(series, scale),
                      "middle slice of these, residual " + percent(residual), scale);
}

void show(Collector& collector, const d::CsmParameters& p, const PosedMesh& mesh, int threads) {
  d::VoxelizeOptions options = p.voxels;
  options.threads = threads;
  const d::Voxels voxels = d::voxelize(mesh.V, mesh.F, options);
  const ColorScale scale = voxel_scale(voxels);
  show_voxels(collector, voxels, rounded_level(share_of(p.voxels.fill) * scale.upper), scale);
  show_spheres(collector, p, voxels, scale, threads);
}

void show(Collector& collector, const d::EgiParameters& p, const PosedMesh& mesh, int threads) {
  const int size = std::max(64, 2 * (p.K + 1));
  d::SphericalImage image;
  image.size = size;
  image.samples = d::sh_reconstruct(d::extended_gaussian_image(mesh.V, mesh.F, p.K, threads), size);
  ColorScale scale;
  scale.upper = std::max(1e-30, image.samples.maxCoeff());
  collector.add_image(equirectangular(image, 0.0, scale.upper),
                      "area by direction of the normal, degrees up to " + std::to_string(p.K),
                      scale);
}

void show(Collector& collector, const d::SphericalParameters& p, const PosedMesh& mesh,
          int threads) {
  d::SphericalImageOptions options;
  options.size = p.size;
  options.sampling = p.sampling;
  options.threads = threads;
  d::SphericalImage image;
  double low = -1.0, high = 1.0;
  std::optional<ColorScale> scale;
  std::vector<std::uint8_t> triangle_colors, vertex_colors;
  std::string name;
  switch (p.image) {
    case d::SphericalImageKind::sni: {
      image = d::spherical_normal_image(mesh.V, mesh.F, mesh.S, options);
      Mesh::Points normals(mesh.F.rows(), 3);
      for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
        const Eigen::Vector3d a = mesh.V.row(mesh.F(t, 1)) - mesh.V.row(mesh.F(t, 0)),
                              b = mesh.V.row(mesh.F(t, 2)) - mesh.V.row(mesh.F(t, 0));
        normals.row(t) = a.cross(b).normalized();
      }
      triangle_colors =
          colors_of_directions(normals.data(), static_cast<std::size_t>(normals.rows()));
      name = "normals as red, green, blue";
      break;
    }
    case d::SphericalImageKind::sgi: {
      image = d::spherical_geometry_image(mesh.V, mesh.F, mesh.S, options);
      const d::Frame frame = d::surface_frame(mesh.V, mesh.F, d::Centre::area, d::Scale::rms, 1.0);
      high = std::max(1.0, image.samples.cwiseAbs().maxCoeff());
      low = -high;
      for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          const double x = (mesh.V(i, axis) - frame.centre[axis]) / frame.radius / high;
          vertex_colors.push_back(
              static_cast<std::uint8_t>(std::lround(127.5 * (1.0 + std::clamp(x, -1.0, 1.0)))));
        }
      }
      name = "positions as red, green, blue";
      break;
    }
    case d::SphericalImageKind::sci: {
      image = d::spherical_curvature_image(mesh.V, mesh.F, mesh.S, options);
      const double radius = std::sqrt(d::surface_area(mesh.V, mesh.F) / (4.0 * kPi));
      const Eigen::VectorXd values =
          (radius * d::vertex_mean_curvature(mesh.V, mesh.F)).array().atan() * (2.0 / kPi);
      scale.emplace();
      scale->map = ColorMap::cool_warm;
      scale->lower = -1.0;
      vertex_colors = colors_of(values.data(), static_cast<std::size_t>(values.size()), *scale);
      name = "mean curvature, 1/2 for a ball";
      break;
    }
  }
  for (const auto& [points, caption] :
       {std::pair{mesh.V, name}, std::pair{mesh.S, std::string("spherical map")}}) {
    SceneMesh scene = collector.scene(mesh_of(points, mesh.F));
    scene.triangle_colors = triangle_colors;
    scene.vertex_colors = vertex_colors;
    scene.shading = 0.35;
    collector.add_scene(std::move(scene), caption);
  }
  collector.add_image(equirectangular(image, low, high),
                      "image of " + std::to_string(p.size) + " rows", scale);
  const Eigen::MatrixXcd coefficients = d::ShTransform(p.size, p.K, p.route)(image.samples);
  const double residual = d::sh_residual(coefficients, image.samples, p.size);
  collector.set_residual(residual);
  image.samples = d::sh_reconstruct(coefficients, p.size);
  collector.add_image(equirectangular(image, low, high),
                      "degrees up to " + std::to_string(p.K) + ", residual " + percent(residual),
                      scale);
}

// One picture of three views, and one of how squarely they look at the surface.
void show(Collector& collector, const d::PanoramaParameters& p, const PosedMesh& mesh,
          int threads) {
  const d::PanoramaImages images = d::panorama_images(mesh.V, mesh.F, p.options, threads);
  static constexpr std::array<const char*, 3> kNames{"first", "second", "third"};
  for (const bool is_distance : {true, false}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Eigen::MatrixXd& image = is_distance ? images.distance[axis] : images.facing[axis];
      ColorScale scale;
      scale.upper = is_distance ? std::max(1e-30, image.maxCoeff()) : 1.0;
      Raster raster = make_raster(static_cast<int>(image.cols()), static_cast<int>(image.rows()),
                                  {0.0, 0.0, 0.0});
      // Rows of pixels from the top, which is the positive end of the axis.
      const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values =
          image.colwise().reverse();
      raster.rgb = colors_of(values.data(), static_cast<std::size_t>(values.size()), scale);
      collector.add_image(std::move(raster),
                          std::string(is_distance ? "distance from the " : "facing from the ") +
                              kNames[axis] + " axis",
                          scale);
    }
  }
}

void show(Collector& /*collector*/, const d::D2Parameters& /*p*/, const PosedMesh& /*mesh*/,
          int /*threads*/) {}

void show(Collector& /*collector*/, const d::RandomParameters& /*p*/, const PosedMesh& /*mesh*/,
          int /*threads*/) {}

}  // namespace

ShownParts shown_parts(const Mesh& mesh, const d::Descriptor& descriptor, int threads) {
  ShownParts parts;
  Collector collector(parts);
  const PosedMesh posed = posed_mesh(mesh, descriptor.align(), descriptor.needs_map());
  // Those of a spherical map begin with the mesh in colors.
  if (!descriptor.needs_map()) {
    collector.add_scene(collector.scene(mesh_of(posed.V, posed.F)), "mesh");
  }
  std::visit([&](const auto& parameters) { show(collector, parameters, posed, threads); },
             descriptor.parameters());
  return parts;
}

}  // namespace shape3d::apps
