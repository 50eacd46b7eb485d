#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "support/lung_anatomy.hpp"

/// A seeded phantom of a chest CT: a wall round two lungs, trees of vessels whose ends are thinner
/// than two samples, nodules, blur and noise; with its truth.
namespace shape3d::test {

/// Noise of standard deviation s at −400 HU. Gaussian: additive. Poisson: v = g·N − 1024 with
/// counts N of mean (v₀ + 1024)/g, g = s²/624: the variance grows with the intensity. Rayleigh:
/// additive, skewed to bright values, shifted to mean 0.
enum class PhantomNoise { gaussian, poisson, rayleigh };

[[nodiscard]] std::string to_string(PhantomNoise noise);
[[nodiscard]] std::string to_string(NoduleKind kind);

struct LungPhantomOptions {
  std::array<std::int64_t, 3> dims{290, 380, 62};  ///< Each at least 24.
  Eigen::Vector3d spacing{0.68, 0.68, 0.63};       ///< Millimetres: that of chapter 3.
  PhantomNoise noise = PhantomNoise::gaussian;
  double noise_hu = 25.0;  ///< Standard deviation s; 0: none.
  std::uint64_t seed = 1;
};

struct PhantomNodule {
  NoduleKind kind = NoduleKind::isolated;
  std::uint8_t label = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< In samples, not necessarily integers.
  double radius = 0.0;                               ///< Millimetres.
};

/// Labels of the truth: a sample belongs to what covers most of the 27 points of a 3 × 3 × 3 grid
/// inside its cell. Nodules have kFirstNodule and on, one each.
struct LungPhantom {
  static constexpr std::uint8_t kLung = 0, kWall = 1, kVessel = 2, kFirstNodule = 3;
  static constexpr double kAir = -800.0, kTissue = 0.0, kGroundGlass = -480.0;
  /// Half way between air and tissue: where the truth's border is.
  static constexpr double kHalfLevel = -400.0;

  std::array<std::int64_t, 3> dims{};
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();
  std::vector<std::int16_t> samples;  ///< HU, x fastest, limited to −1024 … 3071.
  std::vector<std::uint8_t> labels;   ///< As many.
  std::vector<PhantomNodule> nodules;

  /// 1 for wall, vessels and solid nodules; 0 for lung and ground glass.
  [[nodiscard]] std::vector<std::uint8_t> tissue() const;
  /// 1 for the nodule's label.
  [[nodiscard]] std::vector<std::uint8_t> nodule(const PhantomNodule& nodule) const;
};

/// Two nodules of each kind (one of each in a volume of less than 10⁶ samples) of 5 … 7 samples
/// radius, less in small volumes. Two are apart, and other vessels keep away from them; the one on
/// a vessel has a vessel through it, which is the nodule's where it is inside; that at the pleura
/// is the part of a ball that is not in the wall.
///
/// The intensity is that of the covered parts of each cell, blurred by a Gaussian of 0.9 samples,
/// plus noise.
/// @throws std::invalid_argument  a dimension below 24, noise_hu negative or not finite.
/// The same samples for the same seed, but for the last bits of std::log and the like.
[[nodiscard]] LungPhantom make_lung_phantom(const LungPhantomOptions& options);

}  // namespace shape3d::test
