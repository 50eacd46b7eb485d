#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <shape3d/zmc/surface.hpp>

#include "memory_floor.hpp"
#include "subjects.hpp"
#include "volume_list.hpp"

namespace shape3d::bench {

/// An extractor on a volume.
struct SubjectResult {
  SubjectName name{};
  std::vector<double> wall, cpu;  ///< [r]: seconds of the run in round r.
  std::vector<zmc::Timings> stages;
  Measurement last;
  Measurement own_process;  ///< From which the peak of memory is taken.
  std::string missing;      ///< Why there is no result; empty when there is.
};

/// Extractors whose peak of memory is measured, in a process of their own.
[[nodiscard]] bool peak_is_reported(const SubjectName& name);

/// All extractors on a volume.
struct VolumeResult {
  std::string name;
  const CtSize* published = nullptr;
  std::array<std::int64_t, 3> dims{};
  zmc::SampleType type{};
  double isovalue = 0.0;
  zmc::Counts counts;
  double zero_share = 0.0;  ///< Of the compact triangles, those with a zero vertex.
  std::vector<SubjectResult> subjects;
  MemoryFloor floor;  ///< For the compact surface.
  /// [r]: time a triangle at the isovalue by that at isovalue + ½, where integer samples make no
  /// zero vertices; by the processor, 1 thread, reused.
  std::vector<double> zero_price;
  /// [r]: surfaces at the isovalue and at three above it, extracted one after the other, by the
  /// same in one pass; by the processor, 1 thread, reused.
  std::vector<double> one_pass_gain;

  [[nodiscard]] double voxels() const {
    return static_cast<double>(dims[0]) * static_cast<double>(dims[1]) *
           static_cast<double>(dims[2]);
  }
  /// Null when the extractor has no result here.
  [[nodiscard]] const SubjectResult* find(Method method, int threads) const;
};

struct ComparisonOptions {
  int least_rounds = 7, most_rounds = 25;
  int slow_rounds = 3;   ///< Of the slow extractors.
  double seconds = 8.0;  ///< For a volume, and again for each of the slow extractors.
  bool lewiner = true;
};

/// Runs the extractors in turn, round by round, forwards and backwards, so that what happens to the
/// machine happens to all of them. The slow ones, vtkMarchingCubes and Lewiner's, leave after
/// their rounds, or later when their time is up.
[[nodiscard]] VolumeResult compare(const LoadedVolume& volume, const ComparisonOptions& options);

}  // namespace shape3d::bench
