#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace shape3d::apps {

/// Squared Euclidean distance, mm², of each sample of a lattice to the nearest marked one: exact,
/// with rows of parabolas along x, y and z.
///
/// @param marks    nx·ny·nz bytes, x fastest; not 0 is marked.
/// @param spacing  Millimetres along x, y and z.
/// @return As many floats (each the double rounded); infinity everywhere when nothing is marked.
/// @throws std::invalid_argument  marks has not the samples that dims say; a spacing is not finite
///         and positive.
/// Cost: O(samples). Source: P. F. Felzenszwalb and D. P. Huttenlocher, "Distance transforms of
/// sampled functions", Theory of Computing 8 (2012), section 2.1.
[[nodiscard]] std::vector<float> squared_distances(const std::vector<std::uint8_t>& marks,
                                                   const std::array<std::int64_t, 3>& dims,
                                                   const Eigen::Vector3d& spacing);

}  // namespace shape3d::apps
