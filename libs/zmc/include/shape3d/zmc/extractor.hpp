#pragma once

#include <memory>
#include <vector>

#include "shape3d/zmc/export.hpp"
#include "shape3d/zmc/extract.hpp"

namespace shape3d::zmc {

/// extract() with working memory that is kept from call to call, for series of volumes or
/// isovalues.
///
/// Together with a Surface that is filled again and again, nothing is allocated once sizes have
/// settled. Not for concurrent calls; use one object a thread.
class SHAPE3D_ZMC_EXPORT Extractor {
 public:
  Extractor();
  ~Extractor();
  Extractor(Extractor&&) noexcept;
  Extractor& operator=(Extractor&&) noexcept;

  /// As the function extract().
  template <class Real, class Index>
  Status extract(const VolumeView& view, double isovalue, const Options& options,
                 Surface<Real, Index>& surface);

  /// Several isovalues, whose samples are read in one pass: surfaces[n] is that of isovalues[n],
  /// and the same as extract() gives. Surfaces of isovalues that end otherwise than ok or empty
  /// have no triangles.
  /// @return a status for each.
  /// @throws std::invalid_argument  as extract(); there is no isovalue.
  /// Working memory: 0.25 byte a sample for each isovalue.
  template <class Real, class Index>
  std::vector<Status> extract(const VolumeView& view, const std::vector<double>& isovalues,
                              const Options& options, std::vector<Surface<Real, Index>>& surfaces);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace shape3d::zmc
