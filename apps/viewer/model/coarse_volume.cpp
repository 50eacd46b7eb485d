#include "coarse_volume.hpp"

#include <algorithm>

#include "samples_at.hpp"

namespace shape3d::apps::viewer {
namespace {

std::int64_t blocks(std::int64_t samples, std::int64_t factor) {
  return (samples + factor - 1) / factor;
}

}  // namespace

CoarseVolume coarsen(const zmc::VolumeView& volume, std::int64_t most) {
  CoarseVolume coarse;
  std::array<std::int64_t, 3>& factors = coarse.factors;
  std::array<std::int64_t, 3> dims = volume.dims;
  while (dims[0] * dims[1] * dims[2] > most) {
    int finest = -1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (blocks(volume.dims[axis], 2 * factors[axis]) < 2) continue;
      const auto step = [&](std::size_t a) {
        return static_cast<double>(factors[a]) * volume.spacing[static_cast<Eigen::Index>(a)];
      };
      if (finest < 0 || step(axis) < step(static_cast<std::size_t>(finest)))
        finest = static_cast<int>(axis);
    }
    if (finest < 0) break;
    const auto axis = static_cast<std::size_t>(finest);
    factors[axis] *= 2;
    dims[axis] = blocks(volume.dims[axis], factors[axis]);
  }

  // Sums along x of a row of blocks, over the samples of each block.
  coarse.samples.assign(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]), 0.0F);
  const std::array<std::int64_t, 3> strides = volume.effective_strides();
  with_samples(volume, [&](const auto* data) {
    std::vector<double> sums(static_cast<std::size_t>(dims[0]));
    for (std::int64_t bk = 0; bk < dims[2]; ++bk) {
      const std::int64_t k_end = std::min((bk + 1) * factors[2], volume.dims[2]);
      for (std::int64_t bj = 0; bj < dims[1]; ++bj) {
        const std::int64_t j_end = std::min((bj + 1) * factors[1], volume.dims[1]);
        std::fill(sums.begin(), sums.end(), 0.0);
        for (std::int64_t k = bk * factors[2]; k < k_end; ++k) {
          for (std::int64_t j = bj * factors[1]; j < j_end; ++j) {
            const auto* row = data + j * strides[1] + k * strides[2];
            for (std::int64_t bi = 0; bi < dims[0]; ++bi) {
              const std::int64_t i_end = std::min((bi + 1) * factors[0], volume.dims[0]);
              double sum = 0.0;
              for (std::int64_t i = bi * factors[0]; i < i_end; ++i)
                sum += static_cast<double>(row[i * strides[0]]);
              sums[static_cast<std::size_t>(bi)] += sum;
            }
          }
        }
        const std::int64_t rows = (k_end - bk * factors[2]) * (j_end - bj * factors[1]);
        for (std::int64_t bi = 0; bi < dims[0]; ++bi) {
          const std::int64_t width =
              std::min((bi + 1) * factors[0], volume.dims[0]) - bi * factors[0];
          coarse.samples[static_cast<std::size_t>(bi + dims[0] * (bj + dims[1] * bk))] =
              static_cast<float>(sums[static_cast<std::size_t>(bi)] /
                                 static_cast<double>(rows * width));
        }
      }
    }
  });
  coarse.view = volume;
  coarse.view.data = coarse.samples.data();
  coarse.view.type = zmc::SampleType::float32;
  coarse.view.dims = dims;
  coarse.view.strides = {0, 0, 0};
  Eigen::Vector3d middle;  // of the first block
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    middle[a] = static_cast<double>(factors[axis] - 1) / 2.0;
    coarse.view.spacing[a] = volume.spacing[a] * static_cast<double>(factors[axis]);
  }
  coarse.view.origin = volume.world(middle);
  return coarse;
}

}  // namespace shape3d::apps::viewer
