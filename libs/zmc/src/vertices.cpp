#include "vertices.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

#include "cell_words.hpp"
#include "crossings.hpp"
#include "isa.hpp"
#include "samples.hpp"

namespace shape3d::zmc::detail {
namespace {

/// Indices of the vertices of one kind in a row.
template <class Words>
SHAPE3D_ZMC_INLINE std::size_t collect(std::int64_t words, const Words& word_at,
                                       std::uint32_t* index) {
  std::size_t n = 0;
  for (std::int64_t w = 0; w < words; ++w) {
    const auto base = static_cast<std::uint32_t>(64 * w);
    for (Word left = word_at(w); left != 0; left &= left - 1) {
      index[n++] = base + static_cast<std::uint32_t>(__builtin_ctzll(left));
    }
  }
  return n;
}

/// The edges of a row that a collection or interpolation is about: from sample i of `lower` to
/// sample i of `upper`.
template <class T>
struct EdgeSamples {
  const T* lower;
  const T* upper;
  std::int64_t stride;
  double isovalue;
};

/// Crossing parameters of n edges. Samples are fetched first, so that the divisions can be done
/// side by side.
template <class T>
SHAPE3D_ZMC_INLINE void interpolate_body(const EdgeSamples<T>& edges, const std::uint32_t* index,
                                         std::size_t count, double* parameter) {
  using Wide = std::conditional_t<std::is_floating_point_v<T>, T, std::int32_t>;
  constexpr std::size_t kBlock = 64;
  std::array<Wide, kBlock> lower, upper;
  for (std::size_t first = 0; first < count; first += kBlock) {
    const std::size_t n = std::min(kBlock, count - first);
    for (std::size_t m = 0; m < n; ++m) {
      const std::int64_t at = static_cast<std::int64_t>(index[first + m]) * edges.stride;
      lower[m] = edges.lower[at];
      upper[m] = edges.upper[at];
    }
    for (std::size_t m = 0; m < n; ++m) {
      parameter[first + m] = crossing_parameter<T>(lower[m], upper[m], edges.isovalue);
    }
  }
}

template <class T>
void interpolate_portable(const EdgeSamples<T>& edges, const std::uint32_t* index, std::size_t n,
                          double* t) {
  interpolate_body(edges, index, n, t);
}
#if SHAPE3D_ZMC_X86
template <class T>
SHAPE3D_ZMC_TARGET_AVX2 void interpolate_avx2(const EdgeSamples<T>& edges,
                                              const std::uint32_t* index, std::size_t n,
                                              double* t) {
  interpolate_body(edges, index, n, t);
}
#endif

template <class T>
void interpolate(const EdgeSamples<T>& edges, const std::uint32_t* index, std::size_t n,
                 double* t) {
#if SHAPE3D_ZMC_X86
  if (active_isa() != Isa::portable) return interpolate_avx2(edges, index, n, t);
#endif
  interpolate_portable(edges, index, n, t);
}

/// Two rows whose samples with one index are the ends of an edge; for edges along x the row and
/// itself.
struct RowPair {
  const Word *n, *z, *upper_n, *upper_z;
  std::int64_t words;
  std::int64_t edges;  ///< Along the row.
};

template <bool AlongX, bool Zeros>
SHAPE3D_ZMC_INLINE std::size_t collect_body(const RowPair& rows, std::uint32_t* index) {
  return collect(
      rows.words,
      [&](std::int64_t w) {
        Word crossing = load(rows.n + w) ^ (AlongX ? load_next(rows.n, w) : load(rows.upper_n + w));
        if (Zeros) crossing &= ~(rows.z[w] | (AlongX ? load_next(rows.z, w) : rows.upper_z[w]));
        return AlongX ? crossing & below_mask(rows.edges, w) : crossing;
      },
      index);
}

template <bool AlongX, bool Zeros>
std::size_t collect_portable(const RowPair& rows, std::uint32_t* index) {
  return collect_body<AlongX, Zeros>(rows, index);
}
#if SHAPE3D_ZMC_X86
template <bool AlongX, bool Zeros>
SHAPE3D_ZMC_TARGET_AVX2 std::size_t collect_avx2(const RowPair& rows, std::uint32_t* index) {
  return collect_body<AlongX, Zeros>(rows, index);
}
#endif

template <bool AlongX, bool Zeros>
std::size_t collect_rows(const RowPair& rows, std::uint32_t* index) {
#if SHAPE3D_ZMC_X86
  if (active_isa() != Isa::portable) return collect_avx2<AlongX, Zeros>(rows, index);
#endif
  return collect_portable<AlongX, Zeros>(rows, index);
}

std::size_t collect_crossings(const SignLattice& lattice, std::int64_t j, std::int64_t k, int axis,
                              std::uint32_t* index) {
  if (lattice.masked) {
    const Crossings crossings(lattice);
    return collect(
        lattice.words,
        [&](std::int64_t w) {
          return axis == 0   ? crossings.along_x(j, k, w)
                 : axis == 1 ? crossings.along_y(j, k, w)
                             : crossings.along_z(j, k, w);
        },
        index);
  }
  const std::int64_t lower = lattice.row(j, k),
                     upper = lattice.row(j + (axis == 1), k + (axis == 2));
  const RowPair rows{lattice.n_row(lower), lattice.z_row(lower), lattice.n_row(upper),
                     lattice.z_row(upper), lattice.words,        lattice.nx - 1};
  const bool zeros = ((lattice.flags[static_cast<std::size_t>(lower)] |
                       lattice.flags[static_cast<std::size_t>(upper)]) &
                      kRowZero) != 0;
  if (axis == 0)
    return zeros ? collect_rows<true, true>(rows, index) : collect_rows<true, false>(rows, index);
  return zeros ? collect_rows<false, true>(rows, index) : collect_rows<false, false>(rows, index);
}

}  // namespace

template <class Real>
VertexWriter<Real>::VertexWriter(const VolumeView& view, double isovalue, const Options& options,
                                 const Geometry& geometry, const SignLattice& lattice,
                                 const Plan& plan, const VertexArrays<Real>& arrays)
    : view_(view),
      strides_(view.effective_strides()),
      isovalue_(isovalue),
      capped_(options.border == Border::capped),
      lattice_(lattice),
      plan_(plan),
      arrays_(arrays),
      geometry_(geometry),
      attributes_(view, options),
      index_(static_cast<std::size_t>(lattice.nx)),
      parameter_(static_cast<std::size_t>(lattice.nx)) {}

template <class Real>
void VertexWriter<Real>::write_row(std::int64_t j, std::int64_t k) {
  const std::int64_t row = lattice_.row(j, k);
  const RowPlan& r = plan_.rows[static_cast<std::size_t>(row)];
  std::int64_t first = plan_.first_vertex(row) - plan_.part_vertex;
  if (r.x != 0) write_crossings(j, k, 0, first);
  first += r.x;
  if (r.y != 0) write_crossings(j, k, 1, first);
  first += r.y;
  if (r.z != 0) write_crossings(j, k, 2, first);
  first += r.z;
  if ((lattice_.flags[static_cast<std::size_t>(row)] & kRowZero) != 0) write_zeros(j, k, first);
}

template <class Real>
void VertexWriter<Real>::write_crossings(std::int64_t j, std::int64_t k, int axis,
                                         std::int64_t first) {
  Real* out = arrays_.positions + 3 * first;
  const std::size_t n = collect_crossings(lattice_, j, k, axis, index_.data());
  if (capped_) {
    const AnyMagnitudeReader magnitude(view_, isovalue_, true);
    for (std::size_t m = 0; m < n; ++m) {
      parameter_[m] = magnitude.crossing(index_[m], j, k, axis);
    }
  } else {
    visit_sample_type(view_.type, [&](auto sample) {
      using T = decltype(sample);
      const T* lower = static_cast<const T*>(view_.data) + j * strides_[1] + k * strides_[2];
      const EdgeSamples<T> edges{lower, lower + strides_[static_cast<std::size_t>(axis)],
                                 strides_[0], isovalue_};
      interpolate(edges, index_.data(), n, parameter_.data());
    });
  }

  const Eigen::Vector3d plane = geometry_.plane(k), y_term = geometry_.y_term(j);
  const auto put = [&](std::size_t m, const Eigen::Vector3d& p) {
    for (int d = 0; d < 3; ++d) out[3 * m + static_cast<std::size_t>(d)] = static_cast<Real>(p[d]);
  };
  switch (axis) {
    case 0: {
      const Eigen::Vector3d line = plane + y_term;
      for (std::size_t m = 0; m < n; ++m) {
        put(m, line + geometry_.x_term(index_[m], parameter_[m]));
      }
      break;
    }
    case 1:
      for (std::size_t m = 0; m < n; ++m) {
        put(m, plane + geometry_.y_term(j, parameter_[m]) + geometry_.x_term(index_[m]));
      }
      break;
    default:
      for (std::size_t m = 0; m < n; ++m) {
        put(m, geometry_.plane(k, parameter_[m]) + y_term + geometry_.x_term(index_[m]));
      }
  }
  if (arrays_.edges != nullptr) write_edges(j, k, axis, n, first);
  if (arrays_.with_attributes()) write_attributes(j, k, axis, n, first);
}

template <class Real>
void VertexWriter<Real>::write_zeros(std::int64_t j, std::int64_t k, std::int64_t first) {
  Real* out = arrays_.positions + 3 * first;
  const Crossings crossings(lattice_);
  const std::size_t n = collect(
      lattice_.words, [&](std::int64_t w) { return crossings.used_zeros(j, k, w); }, index_.data());
  const Eigen::Vector3d line = geometry_.plane(k) + geometry_.y_term(j);
  for (std::size_t m = 0; m < n; ++m) {
    const Eigen::Vector3d p = line + geometry_.x_term(index_[m]);
    for (int d = 0; d < 3; ++d) out[3 * m + static_cast<std::size_t>(d)] = static_cast<Real>(p[d]);
  }
  if (arrays_.with_attributes() || arrays_.edges != nullptr) {
    std::fill_n(parameter_.begin(), n, 0.0);
    if (arrays_.edges != nullptr) write_edges(j, k, 0, n, first);
    if (arrays_.with_attributes()) write_attributes(j, k, 0, n, first);
  }
}

template <class Real>
void VertexWriter<Real>::write_edges(std::int64_t j, std::int64_t k, int axis, std::size_t count,
                                     std::int64_t first) const {
  const std::int64_t margin = capped_ ? 1 : 0;
  const auto d = static_cast<std::size_t>(axis);
  for (std::size_t m = 0; m < count; ++m) {
    std::array<std::int64_t, 3> lower{index_[m] - margin, j - margin, k - margin};
    const auto vertex = static_cast<std::size_t>(first) + m;
    const bool before = lower[d] < 0;
    const bool cap = before || (parameter_[m] > 0.0 && lower[d] + 1 >= view_.dims[d]);
    if (before) lower[d] = 0;
    arrays_.edges[vertex] =
        3 * (lower[0] + view_.dims[0] * (lower[1] + view_.dims[1] * lower[2])) + (cap ? 0 : axis);
    arrays_.edge_parameters[vertex] = cap ? Real{0} : static_cast<Real>(parameter_[m]);
  }
}

template <class Real>
void VertexWriter<Real>::write_attributes(std::int64_t j, std::int64_t k, int axis,
                                          std::size_t count, std::int64_t first) {
  visit_sample_type(view_.type, [&](auto sample) {
    const LatticeGradient<decltype(sample)> gradient(view_);
    for (std::size_t m = 0; m < count; ++m) {
      arrays_.put(first + static_cast<std::int64_t>(m),
                  attributes_.at_edge(gradient, index_[m], j, k, axis, parameter_[m]));
    }
  });
}

template class VertexWriter<float>;
template class VertexWriter<double>;

}  // namespace shape3d::zmc::detail
