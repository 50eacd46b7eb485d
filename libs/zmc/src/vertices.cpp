#include "vertices.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <type_traits>

#include "attributes.hpp"
#include "cell_words.hpp"
#include "crossings.hpp"
#include "isa.hpp"
#include "samples.hpp"
#include "vector_blocks.hpp"

namespace shape3d::zmc::detail {
namespace {

/// Indices of the vertices of one kind in a row, the last repeated as padding.
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
  if (n > 0) std::fill_n(index + n, kBlock - 1, index[n - 1]);
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

/// Crossing parameters of n edges, as crossing_parameter() gives them.
template <class T>
SHAPE3D_ZMC_INLINE void interpolate_body(const EdgeSamples<T>& edges, const std::uint32_t* index,
                                         std::size_t count, double* parameter) {
  using Wide = std::conditional_t<std::is_floating_point_v<T>, T, std::int32_t>;
  const Doubles isovalue = Doubles{} + edges.isovalue, zero{};
  for (std::size_t first = 0; first < count; first += kBlock) {
    std::array<Wide, kBlock> at_lower, at_upper;
    for (std::size_t m = 0; m < kBlock; ++m) {
      const std::int64_t at = static_cast<std::int64_t>(index[first + m]) * edges.stride;
      at_lower[m] = edges.lower[at];
      at_upper[m] = edges.upper[at];
    }
    Doubles lower, upper;
    load_block(at_lower.data(), lower);
    load_block(at_upper.data(), upper);
    Doubles a = lower - isovalue, b = upper - isovalue;
    a = a < zero ? -a : a;
    b = b < zero ? -b : b;
    if constexpr (std::is_same_v<T, double>) {
      const auto finite = a + b <= zero + std::numeric_limits<double>::max();
      Doubles quarter_a = 0.25 * lower - 0.25 * isovalue,
              quarter_b = 0.25 * upper - 0.25 * isovalue;
      quarter_a = quarter_a < zero ? -quarter_a : quarter_a;
      quarter_b = quarter_b < zero ? -quarter_b : quarter_b;
      a = finite ? a : quarter_a;
      b = finite ? b : quarter_b;
    }
    const Doubles least = zero + kCrossingMargin, most = zero + (1.0 - kCrossingMargin);
    Doubles t = a / (a + b);
    t = t < least ? least : t;
    t = t > most ? most : t;
    std::memcpy(parameter + first, &t, sizeof t);
  }
}

/// Where the points of a row lie: the terms of Geometry::world(). Along `axis` they are moved by
/// their parameters.
struct RowPlace {
  int axis;
  std::array<double, 3> origin;
  std::array<std::array<double, 3>, 3> axes;  ///< Steps along x, y, z.
  double x_shift, y, z;                       ///< Lattice coordinates less the shifts.
};

/// Places of n vertices with indices and parameters. Sums are in the order of Geometry::world().
template <int Axis, class Real>
SHAPE3D_ZMC_INLINE void place_body(const RowPlace& row, const std::uint32_t* index,
                                   const double* parameter, std::size_t count, Real* out) {
  for (std::size_t first = 0; first < count; first += kBlock) {
    Doubles x, t;
    load_block(reinterpret_cast<const std::int32_t*>(index + first), x);
    x -= row.x_shift;
    load_block(parameter + first, t);
    Doubles place[3];
    for (std::size_t d = 0; d < 3; ++d) {
      const double x_axis = row.axes[0][d], y_axis = row.axes[1][d], z_axis = row.axes[2][d],
                   origin = row.origin[d], plane = origin + z_axis * row.z, y_term = y_axis * row.y,
                   line = plane + y_term;
      Doubles value;
      if constexpr (Axis == 0) value = line + x_axis * (x + t);
      if constexpr (Axis == 1) value = (plane + y_axis * (row.y + t)) + x_axis * x;
      if constexpr (Axis == 2) value = ((origin + z_axis * (row.z + t)) + y_term) + x_axis * x;
      place[d] = value;
    }
    store_points(place, std::min(kBlock, count - first), out + 3 * first);
  }
}

template <class Real>
SHAPE3D_ZMC_INLINE void place_along(const RowPlace& row, const std::uint32_t* index,
                                    const double* parameter, std::size_t n, Real* out) {
  if (row.axis == 0) return place_body<0>(row, index, parameter, n, out);
  if (row.axis == 1) return place_body<1>(row, index, parameter, n, out);
  place_body<2>(row, index, parameter, n, out);
}

template <class T>
void interpolate_portable(const EdgeSamples<T>& edges, const std::uint32_t* index, std::size_t n,
                          double* t) {
  interpolate_body(edges, index, n, t);
}
template <class Real>
void place_portable(const RowPlace& row, const std::uint32_t* index, const double* parameter,
                    std::size_t n, Real* out) {
  place_along(row, index, parameter, n, out);
}
#if SHAPE3D_ZMC_X86
template <class T>
SHAPE3D_ZMC_TARGET_AVX2 void interpolate_avx2(const EdgeSamples<T>& edges,
                                              const std::uint32_t* index, std::size_t n,
                                              double* t) {
  interpolate_body(edges, index, n, t);
}
template <class Real>
SHAPE3D_ZMC_TARGET_AVX2 void place_avx2(const RowPlace& row, const std::uint32_t* index,
                                        const double* parameter, std::size_t n, Real* out) {
  place_along(row, index, parameter, n, out);
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
template <class Real>
void place(const RowPlace& row, const std::uint32_t* index, const double* parameter, std::size_t n,
           Real* out) {
#if SHAPE3D_ZMC_X86
  if (active_isa() != Isa::portable) return place_avx2(row, index, parameter, n, out);
#endif
  place_portable(row, index, parameter, n, out);
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

RowPlace row_place(const Geometry& geometry, int axis, std::int64_t j, std::int64_t k) {
  RowPlace row{};
  row.axis = axis;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto component = static_cast<Eigen::Index>(d);
    row.origin[d] = geometry.origin()[component];
    for (std::size_t a = 0; a < 3; ++a) {
      row.axes[a][d] = geometry.axes()(component, static_cast<Eigen::Index>(a));
    }
  }
  row.x_shift = geometry.shift(0);
  row.y = static_cast<double>(j) - geometry.shift(1);
  row.z = static_cast<double>(k) - geometry.shift(2);
  return row;
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
      index_(static_cast<std::size_t>(lattice.nx) + kBlock),
      parameter_(static_cast<std::size_t>(lattice.nx) + kBlock) {}

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

  place<Real>(row_place(geometry_, axis, j, k), index_.data(), parameter_.data(), n,
              arrays_.positions + 3 * first);
  if (arrays_.edges != nullptr) write_edges(j, k, axis, n, first);
  if (arrays_.with_attributes()) write_attributes(j, k, axis, n, first);
}

template <class Real>
void VertexWriter<Real>::write_zeros(std::int64_t j, std::int64_t k, std::int64_t first) {
  const Crossings crossings(lattice_);
  const std::size_t n = collect(
      lattice_.words, [&](std::int64_t w) { return crossings.used_zeros(j, k, w); }, index_.data());
  std::fill_n(parameter_.begin(), n, 0.0);
  place<Real>(row_place(geometry_, 0, j, k), index_.data(), parameter_.data(), n,
              arrays_.positions + 3 * first);
  if (arrays_.edges != nullptr) write_edges(j, k, 0, n, first);
  if (arrays_.with_attributes()) write_attributes(j, k, 0, n, first);
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
  if (!capped_ && !lattice_.masked && count > 0 && parameter_[0] > 0.0) {
    const auto at = [first](Real* array) { return array == nullptr ? nullptr : array + 3 * first; };
    detail::write_attributes(view_, attributes_,
                             {j, k, axis, index_.data(), parameter_.data(), count},
                             at(arrays_.gradients), at(arrays_.normals));
    return;
  }
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
