#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <shape3d/zmc/surface.hpp>
#include <shape3d/zmc/volume_view.hpp>

namespace shape3d::bench {

/// One extraction.
struct Measurement {
  double wall = 0.0, cpu = 0.0;  ///< Seconds; of all threads.
  std::int64_t triangles = 0, vertices = 0;
  std::int64_t output_bytes = 0;
  /// What the process has in memory before the extraction, and at most during it; 0: not measured.
  std::int64_t resident_before = 0, resident_peak = 0;
  zmc::Timings stages;  ///< Of this library's.
};

/// The extractors that are compared. All give points in float, and no normals, gradients or scalars
/// but where they are named, and except for scikit-image's, which cannot do without normals.
enum class Method {
  zmc_compact,
  zmc_centroid,
  zmc_compact_reused,  ///< Surface and working memory of the last extraction are used again.
  zmc_centroid_reused,
  zmc_attributes,  ///< Compact, with normals and gradients.
  zmc_filter,      ///< The compact surface by vtkZeroCrossingMarchingCubes.
  flying_edges,
  flying_edges_attributes,  ///< With normals and gradients.
  marching_cubes,
  lewiner
};

struct SubjectName {
  Method method;
  int threads;
  friend bool operator==(const SubjectName& a, const SubjectName& b) {
    return a.method == b.method && a.threads == b.threads;
  }
};

/// For people: "ZMC compact, reused".
[[nodiscard]] std::string to_string(Method method);

/// An extractor together with the volume that it is run on.
class Subject {
 public:
  Subject() = default;
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;
  virtual ~Subject() = default;
  /// Extracts once; the result is freed outside the time measured.
  virtual Measurement run() = 0;
};

/// Where the volume of a subject is: in memory, and in a file for other processes.
struct Source {
  zmc::VolumeView view;  ///< Dense.
  double isovalue = 0.0;
  std::string file;  ///< Its samples, native byte order, x fastest.
};

/// @throws std::runtime_error  the subject cannot be run here; says why.
[[nodiscard]] std::unique_ptr<Subject> make_subject(const SubjectName& name, const Source& source);

/// run() in a process of its own, which has loaded the volume and run once on a small one before:
/// resident_before and resident_peak are set.
/// @throws std::runtime_error  it ended without a result.
[[nodiscard]] Measurement run_in_own_process(const SubjectName& name, const Source& source);

/// What the process started by run_in_own_process() does; its arguments follow the program's name.
/// @return  Exit status.
int run_as_own_process(const std::vector<std::string>& arguments);

/// "0.19.3", or empty when scikit-image is not installed.
[[nodiscard]] std::string scikit_image_version();

}  // namespace shape3d::bench
