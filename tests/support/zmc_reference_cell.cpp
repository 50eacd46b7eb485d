#include "zmc_reference_cell.hpp"

#include <algorithm>
#include <stdexcept>

namespace shape3d::test::reference {
namespace {

// 113 bits of mantissa hold the product of two doubles exactly.
__extension__ typedef __float128 Exact;

using Corners = std::vector<Corner>;

int sign_of(double value) { return value > 0.0 ? 1 : (value < 0.0 ? -1 : 0); }

/// What a face shows to a zero edge of it: the signs of its other two corners.
enum class Look { zero, positive, negative, mixed };

/// A cell edge by its ends.
struct CellEdge {
  Corner p, q;
};

class Solver {
 public:
  Solver(const std::array<double, 8>& samples, Ties ties) : samples_(samples), ties_(ties) {
    for (Corner c = 0; c < 8; ++c) sign_[c] = sign_of(samples[c]);
  }

  CellSolution solve() {
    for (Face f = 0; f < 6; ++f) solution_.face_case[f] = face_case(f);
    for (Face f = 0; f < 6; ++f) solve_face(f);
    for (int axis = 0; axis < 3; ++axis) {
      for (Corner p = 0; p < 8; ++p) {
        if ((p >> axis & 1) == 0) solve_zero_edge({p, p | 1 << axis});
      }
    }
    return solution_;
  }

 private:
  // --- signs and cases -------------------------------------------------------------------------

  int face_case(Face f) const {
    const std::array<Corner, 4> c = corners_of(f);
    int zeros = 0, positives = 0, negatives = 0;
    for (const Corner corner : c) {
      zeros += sign_[corner] == 0;
      positives += sign_[corner] > 0;
      negatives += sign_[corner] < 0;
    }
    const bool one_sign = positives == 0 || negatives == 0;
    // First corner of the wanted sign, for arrangement.
    const auto at = [&](int sign) {
      int k = 0;
      while (sign_[c[k]] != sign) ++k;
      return k;
    };
    const auto label = [&](int k) { return sign_[c[k % 4]]; };
    switch (zeros) {
      case 0:
        if (one_sign) return 1;
        if (positives != 2) return 3;
        return label(0) == label(2) ? 13 : 6;
      case 1: {
        if (one_sign) return 2;
        const int k = at(0);
        return label(k + 1) == label(k + 3) ? 10 : 5;
      }
      case 2: {
        const bool diagonal = label(at(0) + 2) == 0;
        if (diagonal) return one_sign ? 7 : 9;
        return one_sign ? 4 : 11;
      }
      case 3:
        return 8;
      default:
        return 12;
    }
  }

  static bool contains(Face f, Corner c) { return (c >> (f / 2) & 1) == f % 2; }
  static bool contains(Face f, CellEdge e) { return contains(f, e.p) && contains(f, e.q); }

  /// The other face of the cell on an edge of f.
  static Face across(Face f, CellEdge e) {
    for (Face g = 0; g < 6; ++g) {
      if (g != f && contains(g, e)) return g;
    }
    throw std::logic_error("not an edge of the face");
  }

  /// The edge of f opposite to e.
  static CellEdge opposite(Face f, CellEdge e) {
    // In f the ends of e are flipped along the axis that is neither e's nor the normal of f.
    const int flip = 7 ^ (e.p ^ e.q) ^ (1 << (f / 2));
    return {e.p ^ flip, e.q ^ flip};
  }

  Look look(Face f, CellEdge e) const {
    const CellEdge d = opposite(f, e);
    const int x = sign_[d.p], y = sign_[d.q];
    if (x == 0 && y == 0) return Look::zero;
    if (x * y < 0) return Look::mixed;
    return x + y > 0 ? Look::positive : Look::negative;
  }

  // --- comparisons -----------------------------------------------------------------------------

  Exact product(const Corners& corners) const {
    Exact result = 1;
    for (const Corner c : corners) {
      const Exact value = samples_[c];
      result *= value < 0 ? -value : value;
    }
    return result;
  }

  /// Is the product of the positive corners the larger?
  bool positive_prevails(const Corners& positive, const Corners& negative,
                         bool case_13 = false) const {
    const Exact p = product(positive), n = product(negative);
    if (p != n) return p > n;
    const Corner first_positive = *std::min_element(positive.begin(), positive.end());
    const Corner first_negative = *std::min_element(negative.begin(), negative.end());
    switch (ties_) {
      case Ties::neutral:
        return first_positive < first_negative;
      case Ties::positive:
        return true;
      case Ties::signless_13:
        // f00 is the first corner. Positive f00: a tie is not "greater", so separated; negative
        // f00: the negative product is not greater, so positive connected.
        return !case_13 || first_negative < first_positive;
      case Ties::separated_13:
        return !case_13;
    }
    throw std::logic_error("unknown tie rule");
  }

  void split(CellEdge d, Corners& positive, Corners& negative) const {
    for (const Corner c : {d.p, d.q}) {
      if (sign_[c] > 0) positive.push_back(c);
      if (sign_[c] < 0) negative.push_back(c);
    }
  }

  // --- zero edges and zero faces ---------------------------------------------------------------

  /// Case-11 face f with zero edge e: +1 for gamma, -1 for beta.
  int bend(Face f, CellEdge e, bool* compared = nullptr) const {
    Face g = across(f, e);
    CellEdge from = e;
    while (look(g, from) == Look::zero) {
      from = opposite(g, from);
      g = across(g, from);
    }
    switch (look(g, from)) {
      case Look::negative:
        return -1;
      case Look::positive:
        return +1;
      default: {
        if (compared != nullptr) *compared = true;
        Corners positive, negative;
        split(opposite(f, e), positive, negative);
        split(opposite(g, from), positive, negative);
        return positive_prevails(positive, negative) ? +1 : -1;
      }
    }
  }

  /// The sign that faces a and c, definite and opposite, give to the zero face between their zero
  /// edges: that of the stronger.
  int stronger(Face a, CellEdge ea, Face c, CellEdge ec, bool* compared = nullptr) const {
    const int sign_a = look(a, ea) == Look::positive ? +1 : -1;
    const bool four_a = solution_.face_case[a] == 4, four_c = solution_.face_case[c] == 4;
    if (four_a != four_c) return four_a ? sign_a : -sign_a;
    if (compared != nullptr) *compared = true;
    Corners positive, negative;
    split(opposite(a, ea), positive, negative);
    split(opposite(c, ec), positive, negative);
    return positive_prevails(positive, negative) ? +1 : -1;
  }

  static bool definite(Look l) { return l == Look::positive || l == Look::negative; }

  /// Sign of the region of the cell at the zero face f, judged from its opposite edges e and d;
  /// 0 when both neighbours are zero.
  int zero_face_sign(Face f, CellEdge e, bool* compared) const {
    const CellEdge d = opposite(f, e);
    const Face a = across(f, e), c = across(f, d);
    const Look la = look(a, e), lc = look(c, d);
    const auto alone = [&](Face g, CellEdge edge, Look l) {
      if (l == Look::zero) return 0;
      if (l == Look::mixed) return bend(g, edge, compared);
      return l == Look::positive ? +1 : -1;
    };
    if (la == Look::zero) return alone(c, d, lc);
    if (lc == Look::zero) return alone(a, e, la);
    if (la == Look::mixed && lc == Look::mixed) return bend(a, e, compared);
    if (la == Look::mixed) return alone(c, d, lc);
    if (lc == Look::mixed || la == lc) return alone(a, e, la);
    return stronger(a, e, c, d, compared);
  }

  bool carries_patch_edge(CellEdge e, Face f, Face g) const {
    const Look lf = look(f, e), lg = look(g, e);
    if (definite(lf) && definite(lg)) return lf != lg;
    if (lf == Look::zero) return at_zero_face(f, g, e);
    if (lg == Look::zero) return at_zero_face(g, f, e);
    return false;
  }

  /// Edge e between the zero face b and the face a: does it carry a patch edge?
  bool at_zero_face(Face b, Face a, CellEdge e) const {
    const CellEdge d = opposite(b, e);
    const Face c = across(b, d);
    const Look la = look(a, e), lc = look(c, d);
    if (!definite(la) || !definite(lc) || la == lc) return false;
    const int sign_a = la == Look::positive ? +1 : -1;
    return stronger(a, e, c, d) != sign_a;
  }

  void solve_zero_edge(CellEdge e) {
    if (sign_[e.p] != 0 || sign_[e.q] != 0) return;
    Face f = 0;
    while (!contains(f, e)) ++f;
    const Face g = across(f, e);
    if (!carries_patch_edge(e, f, g)) return;
    // In a definite face the corners off the edge lie on the left of the direction in which the
    // boundary of the face runs counter-clockwise.
    const Face a = definite(look(f, e)) ? f : g;
    const std::array<Corner, 4> c = corners_of(a);
    int k = 0;
    while (c[k] != e.p) ++k;
    const bool counter_clockwise = c[(k + 1) % 4] == e.q;
    const bool forward = counter_clockwise == (look(a, e) == Look::positive);
    const LocalVertex p = zero_vertex(e.p), q = zero_vertex(e.q);
    solution_.edges.push_back({forward ? p : q, forward ? q : p, f});
  }

  // --- faces -----------------------------------------------------------------------------------

  void solve_face(Face f) {
    const std::array<Corner, 4> c = corners_of(f);
    std::array<int, 4> label{};
    for (int k = 0; k < 4; ++k) label[k] = sign_[c[k]];
    bool compared = false;
    int outcome = 0;
    switch (solution_.face_case[f]) {
      case 3:
      case 5:
      case 6:
      case 9:
      case 10:
        connect(f, label);
        break;
      case 11: {
        int k = 0;
        while (label[k] != 0 || label[(k + 1) % 4] != 0) ++k;
        outcome = bend(f, {c[k], c[(k + 1) % 4]}, &compared);
        solution_.region_sign[f] = outcome;
        // The zero vertex that the line misses goes with its neighbour: beta misses the one beside
        // the negative corner, gamma the one beside the positive corner.
        const int missed = label[(k + 3) % 4] == outcome ? k : (k + 1) % 4;
        label[missed] = outcome;
        connect(f, label);
        break;
      }
      case 12: {
        const int first = zero_face_sign(f, {c[0], c[1]}, &compared);
        const int second = zero_face_sign(f, {c[1], c[2]}, &compared);
        if (first * second < 0) throw std::logic_error("a zero face has two signs in one cell");
        outcome = first != 0 ? first : second;
        solution_.region_sign[f] = outcome;
        break;
      }
      case 13: {
        Corners positive, negative;
        split({c[0], c[2]}, positive, negative);
        split({c[1], c[3]}, positive, negative);
        compared = true;
        const bool connected = positive_prevails(positive, negative, true);
        outcome = connected ? +1 : -1;
        // Each corner of the weaker sign is cut off on its own.
        for (int k = 0; k < 4; ++k) {
          if (label[k] == outcome) continue;
          const LocalVertex before = crossing(c[(k + 3) % 4], c[k]);
          const LocalVertex after = crossing(c[k], c[(k + 1) % 4]);
          if (label[k] > 0) {
            solution_.edges.push_back({after, before, f});
          } else {
            solution_.edges.push_back({before, after, f});
          }
        }
        break;
      }
      default:  // 1, 2, 7: nothing; 4, 8: zero edges only.
        break;
    }
    if (compared) {
      solution_.prevails[f] = outcome > 0 ? Prevails::positive : Prevails::negative;
    }
  }

  /// The one line of a face whose boundary changes sign twice. Counter-clockwise round the face it
  /// starts where + turns to - (the positive side is then on its left) and ends where - turns to +;
  /// either place is a crossing, or a zero vertex between the two signs.
  void connect(Face f, const std::array<int, 4>& label) {
    const std::array<Corner, 4> c = corners_of(f);
    LocalVertex from = -1, to = -1;
    const auto turn = [&](int before, int after, LocalVertex v) {
      LocalVertex& end = before > after ? from : to;
      if (end >= 0) throw std::logic_error("a face changes sign more than twice");
      end = v;
    };
    for (int k = 0; k < 4; ++k) {
      const int here = label[k], next = label[(k + 1) % 4], previous = label[(k + 3) % 4];
      if (here * next < 0) turn(here, next, crossing(c[k], c[(k + 1) % 4]));
      if (here == 0 && previous * next < 0) turn(previous, next, zero_vertex(c[k]));
    }
    if (from < 0 || to < 0) throw std::logic_error("a face changes sign less than twice");
    solution_.edges.push_back({from, to, f});
  }

  std::array<double, 8> samples_;
  std::array<int, 8> sign_{};
  Ties ties_;
  CellSolution solution_;
};

}  // namespace

std::array<Corner, 4> corners_of(Face face) {
  const int axis = face / 2, side = face % 2;
  const int u = 1 << ((axis + 1) % 3), v = 1 << ((axis + 2) % 3), base = side << axis;
  // u, v and the axis are right-handed: this order is counter-clockwise seen from +axis.
  std::array<Corner, 4> result{base, base + u, base + u + v, base + v};
  if (side == 0) std::reverse(result.begin(), result.end());
  return result;
}

CellSolution solve_cell(const std::array<double, 8>& samples, Ties ties) {
  return Solver(samples, ties).solve();
}

std::vector<std::vector<LocalVertex>> cycles(const std::vector<LocalEdge>& edges) {
  std::array<int, 64> next{}, in{};
  next.fill(-1);
  for (const LocalEdge& e : edges) {
    if (next[e.from] >= 0) throw std::logic_error("two patch edges leave one vertex");
    next[e.from] = e.to;
    ++in[e.to];
  }
  for (LocalVertex v = 0; v < 64; ++v) {
    if (in[v] != (next[v] >= 0 ? 1 : 0)) throw std::logic_error("a patch does not close");
  }
  std::vector<std::vector<LocalVertex>> result;
  for (LocalVertex start = 0; start < 64; ++start) {
    if (next[start] < 0) continue;
    std::vector<LocalVertex> cycle;
    for (LocalVertex v = start; next[v] >= 0;) {
      cycle.push_back(v);
      const LocalVertex following = next[v];
      next[v] = -1;
      v = following;
    }
    result.push_back(std::move(cycle));
  }
  return result;
}

int case_index(const std::array<double, 8>& samples) {
  int result = 0, power = 1;
  for (int v = 0; v < 8; ++v, power *= 3) {
    const int s = sign_of(samples[lorensen(v)]);
    result += power * (s > 0 ? 1 : (s < 0 ? 2 : 0));
  }
  return result;
}

}  // namespace shape3d::test::reference
