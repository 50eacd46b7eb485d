#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace shape3d::bench {

/// Isovalue of the generated volumes.
inline constexpr double kCtIsovalue = 1000.0;

/// One row of Table 3.1 of the dissertation, and the generated volume that stands for it.
///
/// The table counts voxels as cells: 209 × 319 × 35 = 2.33 million. Its data are not available; the
/// volumes here have its sizes and, within 1 %, its numbers of Marching Cubes triangles.
struct CtSize {
  std::string_view name;  ///< "210x320x36".
  std::array<std::int64_t, 3> dims;
  double mc_triangles, zmc_triangles;  ///< Millions, as printed.
  double mc_seconds, zmc_seconds;      ///< As printed (Athlon 64 3700+).
  /// Of the coarsest noise, in samples; by bisection on the number of triangles.
  double wavelength;
};

inline constexpr std::array<CtSize, 5> kCtSizes{{
    {"210x320x36", {210, 320, 36}, 0.31, 0.50, 0.45, 0.59, 27.2625},
    {"512x512x28", {512, 512, 28}, 1.12, 1.86, 1.42, 1.73, 19.1722},
    {"512x512x62", {512, 512, 62}, 1.58, 2.62, 2.78, 3.34, 32.3635},
    {"512x512x103", {512, 512, 103}, 4.36, 7.67, 5.50, 7.34, 18.3268},
    {"512x512x150", {512, 512, 150}, 5.88, 10.42, 7.56, 9.88, 20.1067},
}};

/// Volume of int16 samples like those of a CT: a body of noise over four octaves, elliptic in each
/// slice, in air.
///
/// sample = round(900 + s·n(p) − 3000·step(r)), limited to [−1024, 3071]. n has mean 0 and variance
/// of about 1: octaves of wavelength w, w/2, w/4, w/8 (half of each in z, for slices are thicker
/// than pixels are wide) and amplitudes 1, ½, ¼, ⅛, each a cubic B-spline over lattice values that
/// a hash of place and seed draws from [−1, 1]. r is the distance from the axis in half axes of the
/// ellipse; step rises smoothly from r = 0.85 to 1. s is proportional to w, so that samples change
/// from one to the next by as much at any w.
///
/// @param wavelength  w, at least 16.
/// @return  Samples, x fastest. The same on every machine with IEEE 754 doubles.
///
/// O(samples); about 2 s for 512 × 512 × 150.
[[nodiscard]] std::vector<std::int16_t> make_ct_volume(const std::array<std::int64_t, 3>& dims,
                                                       double wavelength, std::uint64_t seed = 1);

}  // namespace shape3d::bench
