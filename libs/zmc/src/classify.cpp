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
  Classifier(const VolumeView& view, const std::vector<Classification>& targets,
             const Options& options)
      : view_(view),
        strides_(view.effective_strides()),
        capped_(options.border == Border::capped),
        targets_(targets) {
    for (const Classification& target : targets) {
      thresholds_.emplace_back(target.isovalue, options.inside);
    }
  }

  /// Fills the rows of layers [first, last) of the lattices; counts samples that are not finite.
  void classify_layers(std::int64_t first, std::int64_t last) {
    Scratch scratch;
    std::int64_t bad = 0;
    for (std::int64_t k = first; k < last; ++k) {
      for (std::int64_t j = 0; j < targets_[0].lattice->ny; ++j) {
        // A row is read once for all isovalues.
        std::int64_t bad_in_row = 0;
        for (std::size_t n = 0; n < targets_.size(); ++n) {
          bad_in_row = classify_row(j, k, thresholds_[n], *targets_[n].lattice, scratch);
        }
        bad += bad_in_row;
      }
    }
    if (bad != 0) not_finite_.fetch_add(bad, std::memory_order_relaxed);
  }
  [[nodiscard]] std::int64_t not_finite() const { return not_finite_.load(); }
  void forget_not_finite() { not_finite_ = 0; }

  [[noreturn]] void report_not_finite(std::int64_t first_plane) const {
    if constexpr (std::is_floating_point_v<T>) {
      for (std::int64_t k = 0; k < view_.dims[2]; ++k) {
        for (std::int64_t j = 0; j < view_.dims[1]; ++j) {
          for (std::int64_t i = 0; i < view_.dims[0]; ++i) {
            const T value = row_start(j, k)[i * strides_[0]];
            if (std::isfinite(value)) continue;
            std::ostringstream text;
            text << "samples: expected finite values, got " << value << " at (" << i << ", " << j
                 << ", " << first_plane + k << "), the first of " << not_finite()
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

  std::int64_t classify_row(std::int64_t j, std::int64_t k, const Threshold<T>& threshold,
                            SignLattice& lattice, Scratch& scratch) const {
    const std::int64_t row = lattice.row(j, k);
    Word* n = lattice.n_bits.data() + row * lattice.words;
    Word* z = lattice.z_bits.data() + row * lattice.words;
    Word* masked = lattice.masked ? lattice.cell_bits.data() + row * lattice.words : nullptr;
    std::uint8_t& flags = lattice.flags[static_cast<std::size_t>(row)];
    const std::int64_t margin = capped_ ? 1 : 0;
    j -= margin;
    k -= margin;
    if (j < 0 || k < 0 || j >= view_.dims[1] || k >= view_.dims[2]) {
      std::fill_n(n, lattice.words, Word{0});
      std::fill_n(z, lattice.words, Word{0});
      if (masked != nullptr) std::fill_n(masked, lattice.words, Word{0});
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
    std::fill(n + filled, n + lattice.words, Word{0});
    std::fill(z + filled, z + lattice.words, Word{0});
    scratch.not_finite.assign(static_cast<std::size_t>(lattice.words), 0);
    if (threshold.rule == Threshold<T>::Rule::compare) {
      classify_samples(samples, nx, threshold, {n, z, scratch.not_finite.data()});
    } else {
      const bool all = threshold.rule == Threshold<T>::Rule::all_negative;
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
      shift_row_up(n, lattice.words);
      shift_row_up(z, lattice.words);
      if (masked != nullptr) shift_row_up(masked, lattice.words);
    }
    return bad;
  }

  const VolumeView& view_;
  std::array<std::int64_t, 3> strides_;
  bool capped_;
  const std::vector<Classification>& targets_;
  std::vector<Threshold<T>> thresholds_;
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

void resize(SignLattice& lattice, const VolumeView& view, const Options& options) {
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
}

}  // namespace

bool classify(const VolumeView& view, const std::vector<Classification>& targets,
              const Options& options, const LayerLoop& for_layers, std::int64_t first_plane) {
  for (const Classification& target : targets) resize(*target.lattice, view, options);
  const std::int64_t layers = targets[0].lattice->nz;
  return visit_sample_type(view.type, [&](auto sample) {
    Classifier<decltype(sample)> classifier(view, targets, options);
    const auto body = [&](std::int64_t first, std::int64_t last) {
      classifier.classify_layers(first, last);
    };
    if (!for_layers(layers, body)) return false;
    if (classifier.not_finite() == 0) return true;
    if (options.non_finite == NonFinite::error) classifier.report_not_finite(first_plane);
    for (const Classification& target : targets) {
      target.lattice->masked = true;
      target.lattice->cell_bits.resize(target.lattice->n_bits.size());
      target.lattice->cell_bits.back() = 0;
    }
    classifier.forget_not_finite();
    if (!for_layers(layers, body)) return false;
    for (const Classification& target : targets) make_cell_bits(*target.lattice);
    return true;
  });
}

}  // namespace shape3d::zmc::detail
