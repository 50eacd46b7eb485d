#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <shape3d/zmc/volume_view.hpp>

#include "volume_header.hpp"

namespace shape3d::apps {

/// value = slope · stored + intercept.
struct Scale {
  double slope = 1.0;
  double intercept = 0.0;

  [[nodiscard]] bool trivial() const { return slope == 1.0 && intercept == 0.0; }
  friend bool operator==(const Scale& a, const Scale& b) {
    return a.slope == b.slope && a.intercept == b.intercept;
  }
};

/// Samples of one of the seven types that extraction reads.
struct TypedSamples {
  std::vector<std::byte> bytes;
  zmc::SampleType type = zmc::SampleType::float32;
};

/// Applies scales and brings stored samples to a type that extraction reads.
///
/// The samples are scales.size() equal blocks, one after another, each with its scale. The result
/// has
///  - the stored type, when every scale is trivial and it is one of the seven;
///  - for uint32, int64 and uint64: int32 when the values fit, else float64 when it holds them
///  exactly;
///  - for integers with integral scales: the stored type if the scaled values fit, else the first
///  of int16,
///    uint16, int32 they fit, else float64;
///  - otherwise float32 for integers of 8 and 16 bits and for float32 (if no finite value overflows
///  it),
///    float64 for the others.
///
/// @param memory_limit  as in require_memory(), for the copy when the sample size changes.
/// @throws FileError  a slope is 0 or not finite, an intercept is not finite, a 64-bit integer has
/// no exact
///         double.
[[nodiscard]] TypedSamples convert_samples(std::vector<std::byte> bytes, StoredType stored,
                                           const std::vector<Scale>& scales,
                                           const std::filesystem::path& path,
                                           std::uint64_t memory_limit);

/// Reverses the bytes of each sample.
void swap_bytes(std::vector<std::byte>& bytes, std::size_t sample_size);

}  // namespace shape3d::apps
