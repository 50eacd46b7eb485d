#include "zero_regions.hpp"

#include <array>
#include <vector>

namespace shape3d::zmc::detail {
namespace {

constexpr unsigned kAllZero = 0xFF00u;

struct Place {
  std::int64_t i, j, k;
};

/// Face neighbours in lattice order, and the face by which the neighbour touches the cell.
struct Step {
  int di, dj, dk, face_of_neighbour;
};
constexpr std::array<Step, 6> kSteps{
    {{0, 0, -1, 5}, {0, -1, 0, 3}, {-1, 0, 0, 1}, {1, 0, 0, 0}, {0, 1, 0, 2}, {0, 0, 1, 4}}};

/// Calls visit for each all-zero cell in lattice order.
template <class Visit>
void for_each_all_zero_cell(const SignLattice& lattice, Visit&& visit) {
  for (std::int64_t k = 0; k + 1 < lattice.nz; ++k) {
    for (std::int64_t j = 0; j + 1 < lattice.ny; ++j) {
      const std::int64_t r[4] = {lattice.row(j, k), lattice.row(j + 1, k), lattice.row(j, k + 1),
                                 lattice.row(j + 1, k + 1)};
      unsigned all = kRowZero;
      for (const std::int64_t row : r) all &= lattice.flags[static_cast<std::size_t>(row)];
      if (all == 0) continue;
      for (std::int64_t w = 0; w < lattice.words; ++w) {
        Word zero = below_mask(lattice.nx - 1, w);
        for (const std::int64_t row : r)
          zero &= load(lattice.z_row(row) + w) & load_next(lattice.z_row(row), w);
        if (lattice.masked)
          zero &= lattice.cell_bits[static_cast<std::size_t>(r[0] * lattice.words + w)];
        for (; zero != 0; zero &= zero - 1) visit(Place{64 * w + __builtin_ctzll(zero), j, k});
      }
    }
  }
}

}  // namespace

int face_sign(const LatticeCells& cells, const ZeroRegions& regions, std::int64_t i, std::int64_t j,
              std::int64_t k, int face) {
  const unsigned mask = cells.lattice().cell_mask(i, j, k);
  if ((mask & kAllZero) == kAllZero) return regions.sign(i, cells.lattice().row(j, k));
  const CellConfig& config = cells.config_of_mask(mask, i, j, k);
  return ((config.face_positive >> face) & 1) - ((config.face_negative >> face) & 1);
}

void ZeroRegions::solve(const LatticeCells& cells) {
  const SignLattice& lattice = cells.lattice();
  words_ = lattice.words;
  count_ = 0;
  uniform_ = true;
  uniform_sign_ = 0;

  const auto inside = [&](const Place& p) {
    return p.i >= 0 && p.j >= 0 && p.k >= 0 && p.i + 1 < lattice.nx && p.j + 1 < lattice.ny &&
           p.k + 1 < lattice.nz && lattice.cell_valid(p.i, p.j, p.k);
  };
  const auto all_zero = [&](const Place& p) {
    return (lattice.cell_mask(p.i, p.j, p.k) & kAllZero) == kAllZero;
  };
  const auto neighbour = [](const Place& p, const Step& s) {
    return Place{p.i + s.di, p.j + s.dj, p.k + s.dk};
  };

  // Distance 1: the signs of solved neighbours.
  struct Labelled {
    Place place;
    int sign;
  };
  std::vector<Labelled> frontier;
  bool seen_positive = false, seen_negative = false;
  for_each_all_zero_cell(lattice, [&](const Place& p) {
    ++count_;
    int sign = 0;
    for (const Step& step : kSteps) {
      const Place q = neighbour(p, step);
      if (!inside(q) || all_zero(q)) continue;
      const int seen = face_sign(cells, *this, q.i, q.j, q.k, step.face_of_neighbour);
      (seen > 0 ? seen_positive : seen_negative) = true;
      if (sign == 0) sign = seen;
    }
    if (sign != 0) frontier.push_back({p, sign});
  });
  if (!(seen_positive && seen_negative)) {
    uniform_sign_ = seen_positive ? 1 : seen_negative ? -1 : 0;
    return;
  }

  uniform_ = false;
  const auto size = static_cast<std::size_t>(lattice.rows() * lattice.words + 1);
  positive_.resize(size);
  negative_.resize(size);
  std::fill(positive_.begin(), positive_.end(), Word{0});
  std::fill(negative_.begin(), negative_.end(), Word{0});
  const auto sign_at = [&](const Place& p) { return sign(p.i, lattice.row(p.j, p.k)); };
  // Writes the signs of a level; keeps each of its cells once.
  const auto commit = [&](std::vector<Labelled>& labels) {
    std::size_t kept = 0;
    for (const Labelled& label : labels) {
      if (sign_at(label.place) != 0) continue;
      const auto word = static_cast<std::size_t>(
          lattice.row(label.place.j, label.place.k) * words_ + (label.place.i >> 6));
      (label.sign > 0 ? positive_ : negative_)[word] |= Word{1} << (label.place.i & 63);
      labels[kept++] = label;
    }
    labels.resize(kept);
  };
  commit(frontier);
  // Distance n + 1: cells without a sign beside the cells of distance n. All their neighbours that
  // have a sign before the level is committed are at distance n.
  std::vector<Labelled> next;
  while (!frontier.empty()) {
    next.clear();
    for (const Labelled& from : frontier) {
      for (const Step& step : kSteps) {
        const Place p = neighbour(from.place, step);
        if (!inside(p) || !all_zero(p) || sign_at(p) != 0) continue;
        int sign = 0;
        for (const Step& back : kSteps) {
          const Place q = neighbour(p, back);
          if (!inside(q) || !all_zero(q)) continue;
          sign = sign_at(q);
          if (sign != 0) break;
        }
        next.push_back({p, sign});  // more than once, with the same sign, where several lead here
      }
    }
    commit(next);
    std::swap(frontier, next);
  }
}

}  // namespace shape3d::zmc::detail
