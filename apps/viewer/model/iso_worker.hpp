#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <vtkSmartPointer.h>
#include <shape3d/zmc/options.hpp>
#include <shape3d/zmc/surface.hpp>

#include "common/volume.hpp"
#include "slice_image.hpp"

class vtkPolyData;

namespace shape3d::apps::viewer {

/// What surface is wanted.
struct IsoWish {
  double isovalue = 0.0;
  zmc::Inside inside = zmc::Inside::above;
  bool flying_edges = false;  ///< vtkFlyingEdges3D instead of ZMC.
  bool marks = false;         ///< Also zero faces and non-manifold edges.
  /// Slices across each axis on which coarse surfaces are to have contours; -1: none.
  std::array<std::int64_t, 3> slices{-1, -1, -1};
};

/// How far a result is.
enum class IsoStage {
  coarse,  ///< The surface of a volume of fewer samples.
  full,    ///< The surface.
  detail   ///< For the full surface before: one of fewer triangles for turning.
};

struct IsoResult {
  int surface = 0;         ///< Whose wish it was.
  std::uint64_t wish = 0;  ///< Number that the wish was given.
  IsoStage stage = IsoStage::full;
  IsoWish of;
  vtkSmartPointer<vtkPolyData> data;  ///< Null when there is no surface, or no detail is needed.
  vtkSmartPointer<vtkPolyData> zero_faces, nonmanifold;  ///< With marks; null when there is none.
  std::int64_t vertices = 0, triangles = 0;
  zmc::Counts counts;  ///< Of ZMC's full surface.
  std::int64_t nonmanifold_edges = 0;
  /// Of coarse surfaces: where ZMC's cuts the slices of the wish, or the nearest ones of the coarse
  /// volume.
  std::array<SliceLines, 3> contours;
  double seconds = 0.0;  ///< Of the extraction.
  std::string error;     ///< A sentence; empty: none.
};

/// Extracts isosurfaces of one volume in a thread of its own. For each surface the last wish
/// counts: earlier ones that have not begun are dropped, and a full extraction that has begun is
/// cancelled. Coarse ones go first.
class IsoWorker {
 public:
  /// Coarse volumes have at most this many samples.
  static constexpr std::int64_t kCoarseSamples = std::int64_t{1} << 18;
  /// Triangles of what is drawn while turning.
  static constexpr std::int64_t kDetailTriangles = 40'000;

  /// @param volume  Held as long as this lives.
  /// @param done    Called by the thread with each result.
  IsoWorker(std::shared_ptr<const Volume> volume, std::function<void(IsoResult)> done);
  /// Cancels what is under way.
  ~IsoWorker();
  IsoWorker(const IsoWorker&) = delete;
  IsoWorker& operator=(const IsoWorker&) = delete;

  /// @return the number of the wish.
  std::uint64_t request_coarse(int surface, const IsoWish& wish);
  std::uint64_t request_full(int surface, const IsoWish& wish);
  /// Drops the wishes for a surface.
  void forget(int surface);
  /// Whether a wish waits or is worked on. Results of stage detail count, too.
  [[nodiscard]] bool busy() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shape3d::apps::viewer
