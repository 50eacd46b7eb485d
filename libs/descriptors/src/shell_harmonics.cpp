#include "shell_harmonics.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "parallel.hpp"
#include "vector_lanes.hpp"

namespace shape3d::descriptors::detail {
namespace {

constexpr std::size_t kChunk = 64;  // octant voxels at a time: their state stays in the first cache

// Of a chunk: directions, and the eight sums over mirror images, [x parity][y parity][z parity].
struct Chunk {
  std::size_t size = 0;  // a multiple of kLanes
  alignas(64) std::array<double, kChunk> cos_theta, sin_theta, cos_phi, sin_phi;
  alignas(64) std::array<std::array<double, kChunk>, 8> folded;

  void clear() { size = 0; }

  // Fills up to whole vectors with voxels that hold nothing.
  void pad() {
    while (size % kLanes != 0) {
      cos_theta[size] = cos_phi[size] = 1.0;
      sin_theta[size] = sin_phi[size] = 0.0;
      for (auto& sums : folded) sums[size] = 0.0;
      ++size;
    }
  }
};

// Adds octant voxel v, unless all its mirror images are 0.
void gather(const BallVoxels& ball, const Voxels& voxels, std::size_t v, Chunk& chunk) {
  const auto n = static_cast<std::size_t>(voxels.side);
  const std::size_t x[2] = {ball.column[v], n - 1 - ball.column[v]};
  const std::size_t y[2] = {n * ball.row[v], n * (n - 1 - ball.row[v])};
  const std::size_t z[2] = {n * n * ball.plane[v], n * n * (n - 1 - ball.plane[v])};
  float f[8];
  bool empty = true;
  for (std::size_t image = 0; image < 8; ++image) {
    f[image] = voxels.values[x[(image >> 2) & 1] + y[(image >> 1) & 1] + z[image & 1]];
    empty = empty && f[image] == 0.0F;
  }
  if (empty) return;
  const std::size_t place = chunk.size++;
  chunk.cos_theta[place] = ball.cos_theta[v];
  chunk.sin_theta[place] = ball.sin_theta[v];
  chunk.cos_phi[place] = ball.cos_phi[v];
  chunk.sin_phi[place] = ball.sin_phi[v];
  double g[8];
  for (std::size_t image = 0; image < 8; ++image) g[image] = f[image] * ball.share[v];
  for (const std::size_t bit : {std::size_t{4}, std::size_t{2}, std::size_t{1}}) {
    for (std::size_t image = 0; image < 8; ++image) {
      if ((image & bit) != 0) continue;
      const double plus = g[image] + g[image | bit], minus = g[image] - g[image | bit];
      g[image] = plus;
      g[image | bit] = minus;
    }
  }
  for (std::size_t parity = 0; parity < 8; ++parity) chunk.folded[parity][place] = g[parity];
}

// Adds a chunk's part to the sums of its shell.
SHAPE3D_DESCRIPTORS_INLINE void add_chunk_lanes(const Chunk& chunk, const Legendre& legendre,
                                                double* cosines, double* sines) {
  const int K = legendre.degree();
  const std::size_t vectors = chunk.size / kLanes;
  constexpr std::size_t kVectors = kChunk / kLanes;
  Lanes u[kVectors], sectoral[kVectors], turn_cos[kVectors], turn_sin[kVectors];
  Lanes last[kVectors], before[kVectors], even[2][kVectors], odd[2][kVectors];
  for (std::size_t i = 0; i < vectors; ++i) {
    load(u[i], chunk.cos_theta.data() + i * kLanes);
    set(sectoral[i], Legendre::kFirst);
    set(turn_cos[i], 1.0);
    set(turn_sin[i], 0.0);
  }
  for (int m = 0; m <= K; ++m) {
    // cos mφ is odd in x for odd m; sin mφ is odd in y, and odd in x for even m.
    const auto cos_class = static_cast<std::size_t>(m % 2 != 0 ? 4 : 0);
    const auto sin_class = static_cast<std::size_t>(m % 2 != 0 ? 2 : 6);
    for (std::size_t i = 0; i < vectors; ++i) {
      if (m > 0) {
        Lanes sin_theta, cos_phi, sin_phi;
        load(sin_theta, chunk.sin_theta.data() + i * kLanes);
        load(cos_phi, chunk.cos_phi.data() + i * kLanes);
        load(sin_phi, chunk.sin_phi.data() + i * kLanes);
        sectoral[i] *= -legendre.sectoral(m) * sin_theta;
        const Lanes next = turn_cos[i] * cos_phi - turn_sin[i] * sin_phi;
        turn_sin[i] = turn_sin[i] * cos_phi + turn_cos[i] * sin_phi;
        turn_cos[i] = next;
      }
      for (std::size_t z = 0; z < 2; ++z) {
        Lanes f;
        load(f, chunk.folded[cos_class + z].data() + i * kLanes);
        even[z][i] = f * turn_cos[i];
        load(f, chunk.folded[sin_class + z].data() + i * kLanes);
        odd[z][i] = f * turn_sin[i];
      }
      last[i] = sectoral[i];
      set(before[i], 0.0);
    }
    for (int l = m; l <= K; ++l) {
      const auto z = static_cast<std::size_t>((l - m) % 2);
      Lanes cos_sum, sin_sum;
      set(cos_sum, 0.0);
      set(sin_sum, 0.0);
      if (l > m) {
        const double first = legendre.first(l, m), second = legendre.second(l, m);
        for (std::size_t i = 0; i < vectors; ++i) {
          const Lanes next = first * u[i] * last[i] - second * before[i];
          before[i] = last[i];
          last[i] = next;
          cos_sum += next * even[z][i];
          sin_sum += next * odd[z][i];
        }
      } else {
        for (std::size_t i = 0; i < vectors; ++i) {
          cos_sum += last[i] * even[z][i];
          sin_sum += last[i] * odd[z][i];
        }
      }
      cosines[Legendre::index(l, m)] += sum(cos_sum);
      sines[Legendre::index(l, m)] += sum(sin_sum);
    }
  }
}

void add_chunk_portable(const Chunk& chunk, const Legendre& legendre, double* cosines,
                        double* sines) {
  add_chunk_lanes(chunk, legendre, cosines, sines);
}

SHAPE3D_DESCRIPTORS_AVX2 void add_chunk_avx2(const Chunk& chunk, const Legendre& legendre,
                                             double* cosines, double* sines) {
  add_chunk_lanes(chunk, legendre, cosines, sines);
}

}  // namespace

ShellSums shell_sums(const BallVoxels& ball, const Legendre& legendre, const Voxels& voxels,
                     int threads) {
  const std::size_t pairs = Legendre::count(legendre.degree());
  ShellSums sums = ShellSums::Zero(static_cast<Eigen::Index>(ball.shells()),
                                   static_cast<Eigen::Index>(2 * pairs));
  const auto add_chunk = has_avx2() ? add_chunk_avx2 : add_chunk_portable;
  parallel_blocks(static_cast<std::int64_t>(ball.shells()), 8, threads,
                  [&](std::int64_t first, std::int64_t last) {
                    Chunk chunk;
                    for (auto s = static_cast<std::size_t>(first);
                         s < static_cast<std::size_t>(last); ++s) {
                      double* const cosines = sums.row(static_cast<Eigen::Index>(s)).data();
                      chunk.clear();
                      for (std::size_t v = ball.shell_begin[s]; v < ball.shell_begin[s + 1]; ++v) {
                        gather(ball, voxels, v, chunk);
                        if (chunk.size == kChunk) {
                          add_chunk(chunk, legendre, cosines, cosines + pairs);
                          chunk.clear();
                        }
                      }
                      chunk.pad();
                      if (chunk.size > 0) add_chunk(chunk, legendre, cosines, cosines + pairs);
                    }
                  });
  return sums;
}

}  // namespace shape3d::descriptors::detail
