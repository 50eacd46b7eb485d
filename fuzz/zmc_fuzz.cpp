// The extractor on random volumes: equal to the reference, closed, clean, neutral, the same bytes
// for any number of threads, instruction set and layout of the samples; slabs of a stream are the
// whole.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "check.hpp"
#include "shape3d/zmc/contour.hpp"
#include "shape3d/zmc/extract.hpp"
#include "shape3d/zmc/extractor.hpp"
#include "shape3d/zmc/stream.hpp"
#include "surface_set.hpp"
#include "zmc_case.hpp"

namespace {

using namespace shape3d::zmc;
using shape3d::fuzz::check;
using shape3d::fuzz::decode_zmc_case;
using shape3d::fuzz::strided;
using shape3d::fuzz::ZmcCase;
namespace reference = shape3d::test::reference;
using shape3d::zmc::test::at_border_or_mask;
using shape3d::zmc::test::Conversion;
using shape3d::zmc::test::convert;
using shape3d::zmc::test::MeshProperties;
using Mesh = Surface<double, std::int32_t>;
using Whole = Surface<double, std::int64_t>;

template <class T>
bool same_bytes(const T& a, const T& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

bool same_counts(const Counts& a, const Counts& b) {
  return a.cells_with_patch == b.cells_with_patch && a.faces_by_case == b.faces_by_case &&
         a.patches == b.patches && a.zero_vertices == b.zero_vertices &&
         a.zero_faces == b.zero_faces && a.closing_triangles == b.closing_triangles &&
         a.all_zero_cells == b.all_zero_cells && a.masked_cells == b.masked_cells &&
         a.centroids == b.centroids && a.nonmanifold_edges == b.nonmanifold_edges;
}

template <class Real, class Index>
bool same(const Surface<Real, Index>& a, const Surface<Real, Index>& b) {
  return same_bytes(a.positions, b.positions) && same_bytes(a.indices, b.indices) &&
         same_bytes(a.normals, b.normals) && same_bytes(a.gradients, b.gradients) &&
         same_bytes(a.edges, b.edges) && same_bytes(a.edge_parameters, b.edge_parameters) &&
         a.first_zero_face == b.first_zero_face && a.first_closing == b.first_closing &&
         same_counts(a.counts, b.counts);
}

/// Samples minus isovalue, the inside negative; with one more layer of samples all round when
/// capped: the lattice of the reference.
reference::Volume reference_volume(const ZmcCase& one) {
  reference::Volume volume{one.dims, one.values};
  for (double& v : volume.samples) {
    v -= one.isovalue;
    if (one.options.inside == Inside::above) v = -v;
  }
  // Far outside: larger than any sample by more than 2^20, so that the crossing is clamped.
  return one.options.border == Border::capped ? padded(volume, 1e300) : volume;
}

/// Edges at which the surface may end; a capped surface may end at masked cells alone.
shape3d::test::Exempt open_edges(const reference::Volume& named, int outside) {
  return [exempt = at_border_or_mask(named), outside](const Eigen::Vector3d& p,
                                                      const Eigen::Vector3d& q) {
    const Eigen::Vector3d shift = Eigen::Vector3d::Constant(outside);
    return exempt(p + shift, q + shift);
  };
}

void check_reference(const ZmcCase& one, Status status, const Mesh& surface,
                     const reference::Volume& named, int outside,
                     const MeshProperties& properties) {
  const Options& options = one.options;
  const reference::Result expected = reference::extract(
      named,
      {options.ties == TieRule::neutral ? reference::Ties::neutral : reference::Ties::positive,
       options.zero_faces == ZeroFaces::mating});
  const reference::SurfaceSet& want = expected.surface;
  const bool nothing = want.patches.empty() && want.zero_faces.empty() && want.closing.empty();
  check(status == (nothing ? Status::empty : Status::ok), "the status is that of the reference");
  Conversion conversion;
  try {
    conversion = convert(surface, named, outside);
  } catch (const std::runtime_error& error) {
    check(false, std::string("triangles make polygons: ") + error.what());
  }
  check(conversion.surface == want, "the surface is that of the reference");
  check(conversion.position_error < 1e-12, "vertices lie where the reference puts them");
  check(std::is_sorted(conversion.triangle_cells.begin(), conversion.triangle_cells.end()),
        "triangles are in the order of cells");
  const Counts& counts = surface.counts;
  check(counts.patches == static_cast<std::int64_t>(want.patches.size()) &&
            counts.zero_faces == static_cast<std::int64_t>(want.zero_faces.size()) &&
            counts.closing_triangles == static_cast<std::int64_t>(want.closing.size()) &&
            counts.zero_vertices == conversion.zero_vertices &&
            counts.centroids == conversion.centroids &&
            counts.nonmanifold_edges ==
                (options.count_nonmanifold ? properties.nonmanifold_edges : -1) &&
            counts.all_zero_cells == expected.census.all_zero_cells &&
            counts.cells_with_patch == expected.census.cells_with_patch &&
            counts.faces_by_case == expected.census.faces_by_case,
        "the counts are those of the reference");
  if (options.border == Border::open) {
    check(counts.masked_cells == expected.census.masked_cells, "masked cells are counted");
  }
}

/// extract(−f) is extract(f) with every triangle turned over.
void check_neutral(const ZmcCase& one, const Mesh& surface) {
  if (one.options.ties != TieRule::neutral || one.options.border != Border::open) return;
  std::vector<double> negated = one.values;
  for (double& v : negated) {
    const bool finite = std::isfinite(v);
    v = -(v - one.isovalue);
    if (finite && !std::isfinite(v)) return;  // -f is not a volume of finite doubles
  }
  Mesh other;
  static_cast<void>(extract(make_view(negated.data(), one.dims), 0.0, one.options, other));
  check(other.positions == surface.positions, "negated samples have the same vertices");
  check(other.indices.size() == surface.indices.size(), "negated samples have as many triangles");
  for (std::size_t n = 0; n < surface.indices.size(); n += 3) {
    check(surface.indices[n] == other.indices[n] &&
              surface.indices[n + 1] == other.indices[n + 2] &&
              surface.indices[n + 2] == other.indices[n + 1],
          "negated samples turn each triangle over");
  }
}

void check_attributes(const ZmcCase& one, const Mesh& surface) {
  const auto n = static_cast<std::size_t>(surface.vertex_count());
  check(surface.normals.size() == 3 * n && surface.gradients.size() == 3 * n &&
            surface.edges.size() == n && surface.edge_parameters.size() == n,
        "each vertex has its attributes");
  const bool ordinary = one.ordinary();
  const std::int64_t lattice_edges = 3 * one.dims[0] * one.dims[1] * one.dims[2];
  for (std::size_t v = 0; v < n; ++v) {
    const auto row = static_cast<Eigen::Index>(v);
    const std::int64_t edge = surface.edges[v];
    check(edge >= -1 && edge < lattice_edges, "a vertex lies on an edge of the lattice");
    const double t = surface.edge_parameters[v];
    check(t >= 0.0 && t < 1.0, "the place on an edge is in [0, 1)");
    if (edge >= 0) {
      const std::int64_t at = edge / 3;
      Eigen::Vector3d place(static_cast<double>(at % one.dims[0]),
                            static_cast<double>(at / one.dims[0] % one.dims[1]),
                            static_cast<double>(at / one.dims[0] / one.dims[1]));
      place[static_cast<Eigen::Index>(edge % 3)] += t;
      // Caps lie 2⁻²⁰ outside the border sample that their vertices are said to be at.
      const double error = (surface.V().row(row).transpose() - place).cwiseAbs().maxCoeff();
      check(error <= (one.options.border == Border::capped ? 0x1p-19 : 1e-12),
            "a vertex lies at its place on its edge");
    }
    if (!ordinary) continue;  // differences of samples overflow
    check(surface.G().row(row).allFinite(), "gradients are finite");
    const double length = surface.N().row(row).norm();
    check(length == 0.0 || std::abs(length - 1.0) < 1e-12, "normals are of unit length or zero");
  }
}

/// The same volume in other ways.
void check_same(const ZmcCase& one, Status status, const Mesh& surface) {
  Extractor extractor;
  Mesh other;
  Options options = one.options;
  options.normals = options.gradients = options.edges = true;
  for (const auto set : {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512}) {
    static_cast<void>(use_instruction_set(set));
    options.threads = 1 + static_cast<int>(set);
    check(extractor.extract(one.view(), one.isovalue, options, other) == status &&
              same(surface, other),
          "another instruction set and number of threads give the same bytes");
  }
  static_cast<void>(use_instruction_set(one.instruction_set));
  options.threads = one.options.threads;
  const shape3d::fuzz::Strided elsewhere = strided(one);
  check(extract(elsewhere.view, one.isovalue, options, other) == status && same(surface, other),
        "another layout of the samples gives the same bytes");

  std::vector<Mesh> several;
  const std::vector<Status> statuses =
      extractor.extract(one.view(), {one.second_isovalue, one.isovalue}, options, several);
  check(statuses[1] == status && same(surface, several[1]),
        "one of several isovalues gives the same bytes");
  check(extract(one.view(), one.second_isovalue, options, other) == statuses[0] &&
            same(several[0], other),
        "the other of several isovalues gives the same bytes");

  Surface<float, std::int64_t> narrow;
  check(extract(one.view(), one.isovalue, options, narrow) == status, "float has the same status");
  check(std::equal(narrow.indices.begin(), narrow.indices.end(), surface.indices.begin(),
                   surface.indices.end()),
        "float positions have the same triangles");
  for (std::size_t n = 0; n < narrow.positions.size(); ++n) {
    check(narrow.positions[n] == static_cast<float>(surface.positions[n]),
          "float positions are rounded doubles");
  }
}

/// A limit on vertices, and cancelling after any call of progress.
void check_ends(const ZmcCase& one, Status status, const Mesh& surface) {
  Options options = one.options;
  Mesh other;
  if (status == Status::ok) {
    options.max_vertices = surface.vertex_count();
    check(extract(one.view(), one.isovalue, options, other) == Status::ok,
          "as many vertices as allowed");
    options.max_vertices = surface.vertex_count() - 1;
    check(extract(one.view(), one.isovalue, options, other) == Status::too_many_vertices &&
              other.triangle_count() == 0 && same_counts(other.counts, surface.counts),
          "one vertex more than allowed is not generated, but counted");
    options.max_vertices = 0;
  }
  int left = static_cast<int>(one.gap) * 7 + static_cast<int>(one.planes_per_slab);
  options.progress = [&left](double share) {
    check(share >= 0.0 && share <= 1.0, "progress is a share");
    return left-- > 0;
  };
  const Status stopped = extract(one.view(), one.isovalue, options, other);
  check(stopped == status ||
            (stopped == Status::cancelled && other.positions.empty() && other.indices.empty()),
        "a cancelled surface is empty");
}

/// The slabs of a stream, joined, are the whole surface.
void check_stream(const ZmcCase& one, bool twice) {
  PlaneSource source;
  source.type = one.type;
  source.dims = one.dims;
  source.spacing = {0.5, 0.75, 2.0};
  source.origin = {-3.0, 7.0, 11.0};
  if (one.mirrored) source.direction(1, 1) = -1.0;
  source.can_be_read_twice = twice;
  const std::size_t plane =
      static_cast<std::size_t>(one.dims[0] * one.dims[1]) * sample_size(one.type);
  source.read = [&](std::int64_t first, std::int64_t count, void* out) {
    std::memcpy(out, one.samples.data() + static_cast<std::size_t>(first) * plane,
                static_cast<std::size_t>(count) * plane);
  };
  Options options = one.options;
  options.normals = options.gradients = true;
  VolumeView view = one.view();
  view.spacing = source.spacing;
  view.origin = source.origin;
  view.direction = source.direction;
  Whole whole, joined;
  const Status status = extract(view, one.isovalue, options, whole);
  std::array<std::vector<std::int64_t>, 3> triangles;
  StreamOptions stream_options;
  stream_options.planes_per_slab = one.planes_per_slab;
  Counts counts;
  const Status streamed = stream<double>(
      source, one.isovalue, options, stream_options,
      [&](const Whole& slab, std::int64_t first_id) {
        check(first_id == joined.vertex_count(), "slabs number vertices on");
        joined.positions.insert(joined.positions.end(), slab.positions.begin(),
                                slab.positions.end());
        joined.normals.insert(joined.normals.end(), slab.normals.begin(), slab.normals.end());
        joined.gradients.insert(joined.gradients.end(), slab.gradients.begin(),
                                slab.gradients.end());
        for (std::int64_t t = 0; t < slab.triangle_count(); ++t) {
          auto& kind = triangles[static_cast<std::size_t>(slab.kind(t))];
          kind.insert(kind.end(), slab.indices.data() + 3 * t, slab.indices.data() + 3 * t + 3);
        }
        return true;
      },
      &counts);
  if (!twice && streamed == Status::zero_region_at_seam) return;
  check(streamed == status, "a stream ends as the whole does");
  for (const auto& kind : triangles) {
    joined.indices.insert(joined.indices.end(), kind.begin(), kind.end());
  }
  check(same_bytes(joined.positions, whole.positions), "slabs have the vertices of the whole");
  check(same_bytes(joined.normals, whole.normals) && same_bytes(joined.gradients, whole.gradients),
        "slabs have the normals and gradients of the whole");
  check(same_bytes(joined.indices, whole.indices), "slabs have the triangles of the whole");
  check(same_counts(counts, whole.counts), "slabs have the counts of the whole");
}

/// A contour ends at the border of its plane and at masked cells alone.
void check_contour(const ZmcCase& one) {
  if (one.options.border == Border::capped) return;
  const Contour contour = shape3d::zmc::contour(one.view(), one.isovalue, one.contour_axis,
                                                one.contour_slice, one.options);
  std::vector<int> degree(static_cast<std::size_t>(contour.V.rows()), 0);
  for (Eigen::Index e = 0; e < contour.E.rows(); ++e) {
    for (int side = 0; side < 2; ++side) {
      const std::int32_t v = contour.E(e, side);
      check(v >= 0 && v < contour.V.rows(), "contour edges name vertices");
      ++degree[static_cast<std::size_t>(v)];
    }
  }
  const bool finite = one.finite();
  for (Eigen::Index v = 0; v < contour.V.rows(); ++v) {
    check(contour.V(v, one.contour_axis) == static_cast<double>(one.contour_slice),
          "contour vertices lie in the plane");
    // In mating mode the surface has more faces than a closed one.
    bool at_border = !finite || one.options.zero_faces == ZeroFaces::mating;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == one.contour_axis) continue;
      const double last = static_cast<double>(one.dims[static_cast<std::size_t>(axis)] - 1);
      at_border = at_border || contour.V(v, axis) == 0.0 || contour.V(v, axis) == last;
    }
    const int edges = degree[static_cast<std::size_t>(v)];
    check(edges > 0 && (at_border || edges % 2 == 0), "contours are closed");
  }
}

void run(const ZmcCase& one) {
  static_cast<void>(use_instruction_set(one.instruction_set));
  Options options = one.options;
  options.normals = options.gradients = options.edges = true;
  Mesh surface;
  if (!one.finite() && options.non_finite == NonFinite::error) {
    try {
      static_cast<void>(extract(one.view(), one.isovalue, options, surface));
      check(false, "samples that are not finite are refused");
    } catch (const std::invalid_argument& error) {
      check(std::strstr(error.what(), "expected") != nullptr, "the error says what is expected");
    }
    return;
  }
  const Status status = extract(one.view(), one.isovalue, options, surface);
  const int outside = options.border == Border::capped ? 1 : 0;
  const reference::Volume named = reference_volume(one);
  const MeshProperties properties =
      shape3d::zmc::test::properties_of(surface, open_edges(named, outside));
  check(properties.is_clean(), "no degenerate, double or unused element");
  if (options.zero_faces == ZeroFaces::boundary) {
    // Beside a masked cell two of an edge's four triangles may be missing, and the others run it
    // the same way.
    check(properties.is_closed() && (!one.finite() || properties.inconsistent_edges == 0),
          "the surface is closed");
  }
  if (one.ordinary()) check_reference(one, status, surface, named, outside, properties);
  check_neutral(one, surface);
  check_attributes(one, surface);
  check_same(one, status, surface);
  check_ends(one, status, surface);
  check_stream(one, true);
  check_stream(one, false);
  check_contour(one);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ZmcCase one = decode_zmc_case(data, size);
  shape3d::fuzz::expect_no_exception([&] { run(one); }, one.text());
  return 0;
}
