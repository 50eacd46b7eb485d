#include "classify.hpp"

#include <algorithm>
#include <atomic>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "classify_row.hpp"
#include "samples.hpp"

namespace shape3d::zmc::detail {
namespace {

/// Moves the bits of a row up by one sample.
void shift_row_up(Word* row, std::int64_t words) {
  for (std::int64_t w = words - 1; w > 0; --w) row[w] = (row[w] << 1) | (row[w - 1] >> 63);
  row[0] <<= 1;
}

template <class T>
class Classifier {
 public:
  Classifier(const VolumeView& view, double isovalue, const Options& options, SignLattice& lattice)
      : view_(view),
        strides_(view.effective_strides()),
        threshold_(isovalue, options.inside),
        capped_(options.border == Border::capped),
        lattice_(lattice) {}

  /// Fills the rows of layers [first, last) of the lattice; counts samples that are not finite.
  void classify_layers(std::int64_t first, std::int64_t last) {
    Scratch scratch;
    std::int64_t bad = 0;
    for (std::int64_t k = first; k < last; ++k) {
      for (std::int64_t j = 0; j < lattice_.ny; ++j) bad += classify_row(j, k, scratch);
    }
    if (bad != 0) not_finite_.fetch_add(bad, std::memory_order_relaxed);
  }
  [[nodiscard]] std::int64_t not_finite() const { return not_finite_.load(); }
  void forget_not_finite() { not_finite_ = 0; }

  [[noreturn]] void report_not_finite() const {
    if constexpr (std::is_floating_point_v<T>) {
      for (std::int64_t k = 0; k < view_.dims[2]; ++k) {
        for (std::int64_t j = 0; j < view_.dims[1]; ++j) {
          for (std::int64_t i = 0; i < view_.dims[0]; ++i) {
            const T value = row_start(j, k)[i * strides_[0]];
            if (std::isfinite(value)) continue;
            std::ostringstream text;
            text << "samples: expected finite values, got " << value << " at (" << i << ", " << j
                 << ", " << k << "), the first of " << not_finite()
                 << "; NonFinite::mask skips the cells that touch one";
            throw std::invalid_argument(text.str());
          }
        }
      }
    }
    throw std::logic_error("samples: a non-finite value was counted but is not there");
  }

 private:
  /// Room for one row.
  struct Scratch {
    std::vector<T> gathered;  ///< Samples of a row that are not contiguous.
    std::vector<Word> not_finite;
  };

  const T* row_start(std::int64_t j, std::int64_t k) const {
    return static_cast<const T*>(view_.data) + j * strides_[1] + k * strides_[2];
  }

  std::int64_t classify_row(std::int64_t j, std::int64_t k, Scratch& scratch) {
    const std::int64_t row = lattice_.row(j, k);
    Word* n = lattice_.n_bits.data() + row * lattice_.words;
    Word* z = lattice_.z_bits.data() + row * lattice_.words;
    Word* masked = lattice_.masked ? lattice_.cell_bits.data() + row * lattice_.words : nullptr;
    std::uint8_t& flags = lattice_.flags[static_cast<std::size_t>(row)];
    const std::int64_t margin = capped_ ? 1 : 0;
    j -= margin;
    k -= margin;
    if (j < 0 || k < 0 || j >= view_.dims[1] || k >= view_.dims[2]) {
      std::fill_n(n, lattice_.words, Word{0});
      std::fill_n(z, lattice_.words, Word{0});
      if (masked != nullptr) std::fill_n(masked, lattice_.words, Word{0});
      flags = kRowPositive;
      return 0;
    }
    const std::int64_t nx = view_.dims[0];
    const T* samples = row_start(j, k);
    if (strides_[0] != 1) {
      scratch.gathered.resize(static_cast<std::size_t>(nx));
      for (std::int64_t i = 0; i < nx; ++i)
        scratch.gathered[static_cast<std::size_t>(i)] = samples[i * strides_[0]];
      samples = scratch.gathered.data();
    }
    const std::int64_t filled = (nx + 63) / 64;
    std::fill(n + filled, n + lattice_.words, Word{0});
    std::fill(z + filled, z + lattice_.words, Word{0});
    scratch.not_finite.assign(static_cast<std::size_t>(lattice_.words), 0);
    if (threshold_.rule == Threshold<T>::Rule::compare) {
      classify_samples(samples, nx, threshold_, {n, z, scratch.not_finite.data()});
    } else {
      const bool all = threshold_.rule == Threshold<T>::Rule::all_negative;
      for (std::int64_t w = 0; w < filled; ++w) n[w] = all ? below_mask(nx, w) : 0;
      std::fill_n(z, filled, Word{0});
    }
    Word any_negative = 0, any_zero = 0, any_positive = 0;
    std::int64_t bad = 0;
    for (std::int64_t w = 0; w < filled; ++w) {
      const Word not_finite = scratch.not_finite[static_cast<std::size_t>(w)];
      if (not_finite != 0) {
        n[w] &= ~not_finite;
        bad += __builtin_popcountll(not_finite);
      }
      any_negative |= n[w];
      any_zero |= z[w];
      any_positive |= ~(n[w] | z[w]) & below_mask(nx, w);
    }
    if (masked != nullptr) std::copy(scratch.not_finite.begin(), scratch.not_finite.end(), masked);
    flags = static_cast<std::uint8_t>((any_negative != 0 ? kRowNegative : 0) |
                                      (any_positive != 0 || capped_ ? kRowPositive : 0) |
                                      (any_zero != 0 ? kRowZero : 0) | (bad != 0 ? kRowMasked : 0));
    if (capped_) {
      shift_row_up(n, lattice_.words);
      shift_row_up(z, lattice_.words);
      if (masked != nullptr) shift_row_up(masked, lattice_.words);
    }
    return bad;
  }

  const VolumeView& view_;
  std::array<std::int64_t, 3> strides_;
  Threshold<T> threshold_;
  bool capped_;
  SignLattice& lattice_;
  std::atomic<std::int64_t> not_finite_{0};
};

/// Turns bits of masked samples into bits of cells without one, row by row from the front: a row
/// needs only rows behind it.
void make_cell_bits(SignLattice& lattice) {
  for (std::int64_t k = 0; k < lattice.nz; ++k) {
    for (std::int64_t j = 0; j < lattice.ny; ++j) {
      Word* out = lattice.cell_bits.data() + lattice.row(j, k) * lattice.words;
      for (std::int64_t w = 0; w < lattice.words; ++w) {
        Word bad = ~Word{0};
        if (j + 1 < lattice.ny && k + 1 < lattice.nz) {
          bad = 0;
          for (const std::int64_t row : {lattice.row(j, k), lattice.row(j + 1, k),
                                         lattice.row(j, k + 1), lattice.row(j + 1, k + 1)}) {
            const Word* samples = lattice.cell_bits.data() + row * lattice.words;
            bad |= samples[w] | (samples[w] >> 1);
            if (w + 1 < lattice.words) bad |= samples[w + 1] << 63;
          }
        }
        out[w] = ~bad & below_mask(lattice.nx - 1, w);
      }
    }
  }
}

}  // namespace

bool classify(const VolumeView& view, double isovalue, const Options& options,
              const LayerLoop& for_layers, SignLattice& lattice) {
  const std::int64_t margin = options.border == Border::capped ? 2 : 0;
  lattice.nx = view.dims[0] + margin;
  lattice.ny = view.dims[1] + margin;
  lattice.nz = view.dims[2] + margin;
  lattice.words = (lattice.nx + 63) / 64;
  lattice.masked = false;
  const auto size = static_cast<std::size_t>(lattice.rows() * lattice.words + 1);
  lattice.n_bits.resize(size);
  lattice.z_bits.resize(size);
  lattice.flags.resize(static_cast<std::size_t>(lattice.rows()));
  lattice.n_bits.back() = lattice.z_bits.back() = 0;

  return visit_sample_type(view.type, [&](auto sample) {
    Classifier<decltype(sample)> classifier(view, isovalue, options, lattice);
    const auto body = [&](std::int64_t first, std::int64_t last) {
      classifier.classify_layers(first, last);
    };
    if (!for_layers(lattice.nz, body)) return false;
    if (classifier.not_finite() == 0) return true;
    if (options.non_finite == NonFinite::error) classifier.report_not_finite();
    lattice.masked = true;
    lattice.cell_bits.resize(size);
    lattice.cell_bits.back() = 0;
    classifier.forget_not_finite();
    if (!for_layers(lattice.nz, body)) return false;
    make_cell_bits(lattice);
    return true;
  });
}

}  // namespace shape3d::zmc::detail
