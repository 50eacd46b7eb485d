#pragma once

#include <functional>
#include <vector>

#include "shape3d/zmc/options.hpp"
#include "shape3d/zmc/volume_view.hpp"
#include "sign_lattice.hpp"

namespace shape3d::zmc::detail {

/// How long stages run: for_layers(count, body) calls body on ranges of layers and may be
/// cancelled.
using LayerLoop =
    std::function<bool(std::int64_t, const std::function<void(std::int64_t, std::int64_t)>&)>;

/// A lattice to be filled, and by comparison with what.
struct Classification {
  double isovalue = 0.0;
  SignLattice* lattice = nullptr;
};

/// Signs of all samples of a view by comparison with one or more isovalues, in one pass over the
/// samples; the lattices are sized and filled anew. With a capped border they are one sample larger
/// on every side and positive there.
/// @param first_plane  What the view's first plane is called in messages.
/// @return false when the loop was cancelled.
/// @throws std::invalid_argument  a sample is not finite and options.non_finite is error.
bool classify(const VolumeView& view, const std::vector<Classification>& targets,
              const Options& options, const LayerLoop& for_layers, std::int64_t first_plane = 0);

}  // namespace shape3d::zmc::detail
