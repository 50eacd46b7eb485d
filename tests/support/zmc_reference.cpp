#include "zmc_reference.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace shape3d::test::reference {
namespace {

using Lattice = std::array<std::int64_t, 3>;

enum class CellKind { solved, all_zero, masked };

class Extractor {
 public:
  Extractor(const Volume& volume, const Options& options)
      : volume_(volume),
        options_(options),
        cells_{volume.dims[0] - 1, volume.dims[1] - 1, volume.dims[2] - 1} {}

  Result run() {
    solve_cells();
    if (options_.sign_all_zero_cells) sign_zero_regions();
    for (int axis = 0; axis < 3; ++axis) insert_faces(axis);
    std::sort(result_.surface.patches.begin(), result_.surface.patches.end());
    std::sort(result_.surface.zero_faces.begin(), result_.surface.zero_faces.end());
    std::sort(result_.surface.closing.begin(), result_.surface.closing.end());
    return std::move(result_);
  }

 private:
  struct Cell {
    CellKind kind = CellKind::masked;
    CellSolution solution;
    int zero_sign = 0;  ///< Of an all-zero cell.
    int level = 0;      ///< Of an all-zero cell; 0: not reached.
  };

  template <class Visit>
  void for_each_cell(Visit visit) {
    for (std::int64_t k = 0; k < cells_[2]; ++k) {
      for (std::int64_t j = 0; j < cells_[1]; ++j) {
        for (std::int64_t i = 0; i < cells_[0]; ++i) visit(Lattice{i, j, k});
      }
    }
  }

  Cell& cell(const Lattice& at) { return all_[at[0] + cells_[0] * (at[1] + cells_[1] * at[2])]; }

  std::optional<Lattice> neighbour(Lattice at, Face face) const {
    const auto axis = face / 2;
    at[axis] += face % 2 == 1 ? 1 : -1;
    if (at[axis] < 0 || at[axis] >= cells_[axis]) return std::nullopt;
    return at;
  }

  std::int64_t sample_number(const Lattice& at, Corner c) const {
    return volume_.index(at[0] + (c & 1), at[1] + (c >> 1 & 1), at[2] + (c >> 2 & 1));
  }

  Cycle global(const Lattice& at, const std::vector<LocalVertex>& local) const {
    Cycle result;
    for (const LocalVertex v : local) {
      result.push_back({sample_number(at, first_corner(v)), sample_number(at, second_corner(v))});
    }
    return canonical(std::move(result));
  }

  void solve_cells() {
    all_.resize(cells_[0] * cells_[1] * cells_[2]);
    for_each_cell([&](const Lattice& at) {
      std::array<double, 8> samples{};
      for (Corner c = 0; c < 8; ++c) {
        samples[c] = volume_.samples[sample_number(at, c)];
      }
      Cell& here = cell(at);
      if (!std::all_of(samples.begin(), samples.end(), [](double s) { return std::isfinite(s); })) {
        ++result_.census.masked_cells;
        return;
      }
      if (std::all_of(samples.begin(), samples.end(), [](double s) { return s == 0.0; })) {
        here.kind = CellKind::all_zero;
        ++result_.census.all_zero_cells;
        return;
      }
      here.kind = CellKind::solved;
      here.solution = solve_cell(samples, options_.ties);
      const auto patches = cycles(here.solution.edges);
      for (const auto& patch : patches) {
        result_.surface.patches.push_back({sample_number(at, 0), global(at, patch)});
      }
      if (!patches.empty()) {
        ++result_.census.cells_with_patch;
        for (const int c : here.solution.face_case) {
          ++result_.census.faces_by_case[c - 1];
        }
      }
    });
  }

  /// The sign of the first neighbour of `at` that `qualifies`; 0: none does.
  template <class Sign>
  int first_sign(const Lattice& at, Sign sign) {
    for (const Face face : {4, 2, 0, 1, 3, 5}) {  // -z -y -x +x +y +z
      const std::optional<Lattice> other = neighbour(at, face);
      if (!other) continue;
      const int s = sign(cell(*other), face ^ 1);  // the same face, seen from the other cell
      if (s != 0) return s;
    }
    return 0;
  }

  void sign_zero_regions() {
    for (int level = 1;; ++level) {
      bool reached = false;
      for_each_cell([&](const Lattice& at) {
        Cell& here = cell(at);
        if (here.kind != CellKind::all_zero || here.level != 0) return;
        const int sign = first_sign(at, [&](const Cell& other, Face its_face) {
          if (level == 1) {
            if (other.kind != CellKind::solved) return 0;
            return other.solution.region_sign[its_face];
          }
          return other.level == level - 1 ? other.zero_sign : 0;
        });
        if (sign == 0) return;
        here.level = level;
        here.zero_sign = sign;
        reached = true;
      });
      if (!reached) return;
    }
  }

  int sign_at(const Cell& c, Face face) const {
    return c.kind == CellKind::all_zero ? c.zero_sign : c.solution.region_sign[face];
  }

  /// The faces between each cell and its neighbour along +axis.
  void insert_faces(int axis) {
    const Face up = 2 * axis + 1, down = 2 * axis;
    for_each_cell([&](const Lattice& at) {
      const std::optional<Lattice> above = neighbour(at, up);
      if (!above) return;
      const Cell &low = cell(at), &high = cell(*above);
      if (low.kind == CellKind::masked || high.kind == CellKind::masked) return;
      const std::array<Corner, 4> corners = corners_of(up);  // counter-clockwise seen from +axis
      std::vector<LocalVertex> polygon;
      const auto is_zero = [&](Corner c) { return volume_.samples[sample_number(at, c)] == 0.0; };
      bool quad = false;
      if (std::all_of(corners.begin(), corners.end(), is_zero)) {
        quad = true;
        for (const Corner c : corners) polygon.push_back(zero_vertex(c));
      } else if (low.solution.face_case[up] == 11) {
        // The two zero vertices and the crossing, in the order round the face.
        for (std::size_t n = 0; n < 4; ++n) {
          const Corner c = corners[n], next = corners[(n + 1) % 4];
          if (is_zero(c)) polygon.push_back(zero_vertex(c));
          if (!is_zero(c) && !is_zero(next)) polygon.push_back(crossing(c, next));
        }
      } else {
        return;
      }
      const int below_sign = sign_at(low, up), above_sign = sign_at(high, down);
      if (!options_.sign_all_zero_cells && below_sign * above_sign == 0) return;
      if (below_sign == above_sign) {
        const bool both_zero = low.kind == CellKind::all_zero && high.kind == CellKind::all_zero;
        if (!options_.mating || !quad || both_zero) return;
        if (below_sign == 0) throw std::logic_error("a solved cell without a sign at a zero face");
      }
      const bool along_axis = below_sign != above_sign ? below_sign < 0 : below_sign > 0;
      if (!along_axis) std::reverse(polygon.begin(), polygon.end());
      (quad ? result_.surface.zero_faces : result_.surface.closing).push_back(global(at, polygon));
    });
  }

  const Volume& volume_;
  Options options_;
  Lattice cells_;
  std::vector<Cell> all_;
  Result result_;
};

void reverse_all(std::vector<Cycle>& cycles) {
  for (Cycle& cycle : cycles) {
    std::reverse(cycle.begin(), cycle.end());
    cycle = canonical(std::move(cycle));
  }
  std::sort(cycles.begin(), cycles.end());
}

}  // namespace

Cycle canonical(Cycle cycle) {
  std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
  return cycle;
}

SurfaceSet SurfaceSet::reversed() const {
  SurfaceSet result = *this;
  for (Patch& patch : result.patches) {
    std::reverse(patch.cycle.begin(), patch.cycle.end());
    patch.cycle = canonical(std::move(patch.cycle));
  }
  std::sort(result.patches.begin(), result.patches.end());
  reverse_all(result.zero_faces);
  reverse_all(result.closing);
  return result;
}

Result extract(const Volume& volume, const Options& options) {
  return Extractor(volume, options).run();
}

std::array<double, 3> position(const Volume& volume, const Vertex& vertex) {
  const auto lattice = [&](std::int64_t n) {
    return Lattice{n % volume.dims[0], n / volume.dims[0] % volume.dims[1],
                   n / (volume.dims[0] * volume.dims[1])};
  };
  const Lattice low = lattice(vertex.a), high = lattice(vertex.b);
  std::array<double, 3> result{};
  double t = 0.0;
  if (vertex.a != vertex.b) {
    const double a = std::abs(volume.samples[vertex.a]);
    const double b = std::abs(volume.samples[vertex.b]);
    const double margin = std::ldexp(1.0, -20);
    t = std::clamp(a / (a + b), margin, 1.0 - margin);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result[axis] = static_cast<double>(low[axis]);
    if (high[axis] != low[axis]) result[axis] += t;
  }
  return result;
}

Volume negated(Volume volume) {
  for (double& s : volume.samples) s = -s;
  return volume;
}

Volume padded(const Volume& volume, double value) {
  Volume result;
  result.dims = {volume.dims[0] + 2, volume.dims[1] + 2, volume.dims[2] + 2};
  result.samples.assign(result.dims[0] * result.dims[1] * result.dims[2], value);
  for (std::int64_t k = 0; k < volume.dims[2]; ++k) {
    for (std::int64_t j = 0; j < volume.dims[1]; ++j) {
      for (std::int64_t i = 0; i < volume.dims[0]; ++i) {
        result.at(i + 1, j + 1, k + 1) = volume.at(i, j, k);
      }
    }
  }
  return result;
}

}  // namespace shape3d::test::reference
