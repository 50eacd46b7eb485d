#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "shape3d/zmc/instruction_set.hpp"
#include "shape3d/zmc/options.hpp"
#include "shape3d/zmc/volume_view.hpp"

namespace shape3d::fuzz {

/// A volume and how to extract from it, as the bytes of an input describe them.
struct ZmcCase {
  std::array<std::int64_t, 3> dims{2, 2, 2};
  zmc::SampleType type = zmc::SampleType::int16;
  std::vector<std::byte> samples;  ///< Dense, x fastest, of `type`.
  std::vector<double> values;      ///< The same numbers.
  double isovalue = 0.0;
  double second_isovalue = 0.0;
  zmc::Options options;
  zmc::InstructionSet instruction_set = zmc::InstructionSet::portable;
  std::int64_t planes_per_slab = 0;
  int layout = 0;       ///< How strided() lays the samples out, 0 … 47.
  std::size_t gap = 0;  ///< Foreign samples between two of the same row.
  int contour_axis = 0;
  std::int64_t contour_slice = 0;
  bool mirrored = false;  ///< The world frame of the streamed volume is left-handed.

  [[nodiscard]] std::size_t size() const { return values.size(); }
  /// The dense samples at unit spacing.
  [[nodiscard]] zmc::VolumeView view() const;
  /// Every value is finite.
  [[nodiscard]] bool finite() const;
  /// Every finite value is the isovalue, or is away from it by 2⁻⁴⁰⁰ … 2⁴⁰⁰: products of two such
  /// distances neither vanish nor overflow.
  [[nodiscard]] bool ordinary() const;
  [[nodiscard]] std::string text() const;
};

/// Any bytes make a case.
[[nodiscard]] ZmcCase decode_zmc_case(const std::uint8_t* data, std::size_t size);

/// The same samples in memory of another layout: axes in any order and direction, with foreign
/// samples between them.
struct Strided {
  std::vector<std::byte> memory;
  zmc::VolumeView view;
};
[[nodiscard]] Strided strided(const ZmcCase& one);

}  // namespace shape3d::fuzz
