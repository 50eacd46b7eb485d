#include "cell_rules.hpp"

#include <algorithm>
#include <cassert>

namespace shape3d::zmc::detail {
namespace {

int edge_between(int v, int w) {
  for (int e = 0; e < 12; ++e) {
    const auto& edge = kCellEdges[e];
    if ((edge[0] == v && edge[1] == w) || (edge[0] == w && edge[1] == v)) return e;
  }
  return -1;
}

/// Incidences of the cube, derived from the public numbering.
struct Cube {
  std::array<std::array<int, 4>, 6>
      face_edges{};  ///< [f][k]: the edge between corners k and k + 1 of face f.
  std::array<std::array<int, 2>, 12> edge_faces{};

  Cube() {
    std::array<int, 12> seen{};
    for (int f = 0; f < 6; ++f) {
      for (int k = 0; k < 4; ++k) {
        const int e = edge_between(kCellFaces[f][k], kCellFaces[f][(k + 1) % 4]);
        face_edges[f][k] = e;
        edge_faces[e][seen[e]++] = f;
      }
    }
  }
  int other_face(int edge, int face) const {
    return edge_faces[edge][0] == face ? edge_faces[edge][1] : edge_faces[edge][0];
  }
  /// Index k of an edge in a face.
  int place(int edge, int face) const {
    int k = 0;
    while (face_edges[face][k] != edge) ++k;
    return k;
  }
  int opposite_edge(int edge, int face) const {
    return face_edges[face][(place(edge, face) + 2) % 4];
  }
};

const Cube& cube() {
  static const Cube instance;
  return instance;
}

int classify_face(const std::array<int, 4>& s) {
  const int zeros = static_cast<int>(std::count(s.begin(), s.end(), 0));
  const int positives = static_cast<int>(std::count(s.begin(), s.end(), 1));
  if (zeros == 0) {
    if (positives == 0 || positives == 4) return 1;
    if (positives != 2) return 3;
    return s[0] == s[2] ? 13 : 6;
  }
  if (zeros == 4) return 12;
  if (zeros == 3) return 8;
  const int q = static_cast<int>(std::find(s.begin(), s.end(), 0) - s.begin());
  if (zeros == 1) {
    const int next = s[(q + 1) % 4], opposite = s[(q + 2) % 4], previous = s[(q + 3) % 4];
    if (next != previous) return 5;
    return next == opposite ? 2 : 10;
  }
  const bool zeros_opposite = (s[0] == 0 && s[2] == 0) || (s[1] == 0 && s[3] == 0);
  if (zeros_opposite) return positives == 1 ? 9 : 7;
  return positives == 1 ? 11 : 4;
}

/// One application of the rules to one cell.
class Solver {
 public:
  Solver(const CellSigns& signs, std::vector<Comparison>& comparisons,
         const std::vector<bool>& answers)
      : signs_(signs), comparisons_(comparisons), answers_(answers) {
    for (int f = 0; f < 6; ++f) {
      for (int k = 0; k < 4; ++k) face_signs_[f][k] = signs[kCellFaces[f][k]];
      graph_.face_case[f] = classify_face(face_signs_[f]);
    }
  }

  CellGraph solve() {
    for (int f = 0; f < 6; ++f) {
      switch (graph_.face_case[f]) {
        case 4:
        case 8:
          break;  // only zero edges
        case 11:
          bent_line(f);
          break;
        case 12:
          zero_face(f);
          break;
        case 13:
          saddle(f);
          break;
        default:
          bilinear(f);
      }
    }
    zero_edges();
    return std::move(graph_);
  }

 private:
  bool ask(int face, std::array<int, 2> positive, std::array<int, 2> negative) {
    Comparison c;
    const auto pack = [](std::array<int, 2> v) {
      if (v[1] >= 0 && v[1] < v[0]) std::swap(v[0], v[1]);
      return std::array<std::int8_t, 2>{static_cast<std::int8_t>(v[0]),
                                        static_cast<std::int8_t>(v[1])};
    };
    c.positive = pack(positive);
    c.negative = pack(negative);
    const auto first = [](const std::array<std::int8_t, 2>& v) {
      int rank = 8;
      for (const int corner : v) {
        if (corner < 0) continue;
        const auto& p = kCellVertices[corner];
        rank = std::min(rank, 4 * p[2] + 2 * p[1] + p[0]);
      }
      return rank;
    };
    c.first_is_positive = first(c.positive) < first(c.negative);
    const auto found = std::find(comparisons_.begin(), comparisons_.end(), c);
    const auto index = static_cast<std::size_t>(found - comparisons_.begin());
    if (found == comparisons_.end()) comparisons_.push_back(c);
    const bool answer = index < answers_.size() && answers_[index];
    if (answer) graph_.resolution |= 1u << face;
    return answer;
  }

  /// Patch edge in face f between boundary places s and t (2k: corner k, 2k + 1: edge k), such that
  /// the corners met counter-clockwise from t to s have this sign.
  void add_edge(int f, int s, int t, int sign) {
    const auto vertex = [&](int place) {
      place &= 7;
      return place % 2 == 0 ? 12 + kCellFaces[f][place / 2] : cube().face_edges[f][place / 2];
    };
    if (sign < 0) std::swap(s, t);
    graph_.edges.push_back({vertex(s), vertex(t), f});
  }

  /// Cases 1, 2, 3, 5, 6, 7, 9, 10: the line joins the two places where the boundary changes sign.
  void bilinear(int f) {
    const auto& s = face_signs_[f];
    std::array<int, 2> place{};
    int n = 0;
    for (int k = 0; k < 4; ++k) {
      const int next = s[(k + 1) % 4];
      if (s[k] == 0 && s[(k + 3) % 4] * next < 0) place[n++] = 2 * k;
      if (s[k] * next < 0) place[n++] = 2 * k + 1;
    }
    if (n == 0) return;
    assert(n == 2);
    const int corner =
        (place[0] / 2 + 1) % 4;  // first corner after place[0]; never zero between the two places
    add_edge(f, place[1], place[0], s[corner]);
  }

  /// Case 13: the asymptotic decider.
  void saddle(int f) {
    const auto& s = face_signs_[f];
    const auto& corner = kCellFaces[f];
    const int k = s[0] > 0 ? 0 : 1;
    const bool positive_joined = ask(f, {corner[k], corner[k + 2]}, {corner[1 - k], corner[3 - k]});
    const int cut = positive_joined ? -1 : 1;
    for (int c = 0; c < 4; ++c) {
      if (s[c] == cut) add_edge(f, 2 * c + 1, 2 * c + 7, cut);
    }
  }

  struct Others {
    int positive = -1,
        negative = -1;  ///< Cell vertices of a face off its zero edge, by sign; −1: none.
    int zero_count = 0;
    int count_positive = 0, count_negative = 0;
    std::array<int, 2> all{};
  };
  Others others(int f, int edge) const {
    Others o;
    const int k = cube().place(edge, f);
    for (int n = 0; n < 2; ++n) {
      const int v = kCellFaces[f][(k + 2 + n) % 4];
      o.all[n] = v;
      if (signs_[v] > 0) {
        o.positive = v;
        ++o.count_positive;
      } else if (signs_[v] < 0) {
        o.negative = v;
        ++o.count_negative;
      } else {
        ++o.zero_count;
      }
    }
    return o;
  }
  /// Sign of a definite face (case 4 or 8) seen from a zero edge, 0 for cases 11 and 12.
  int definite_sign(int f, int edge) const {
    if (graph_.face_case[f] != 4 && graph_.face_case[f] != 8) return 0;
    return others(f, edge).count_positive > 0 ? 1 : -1;
  }

  /// Positive against negative samples of two mixed faces; the same pair twice is compared once.
  bool ask_mixed(int face, const Others& a, const Others& b) {
    if (a.positive == b.positive) return ask(face, {a.positive, -1}, {a.negative, -1});
    return ask(face, {a.positive, b.positive}, {a.negative, b.negative});
  }

  /// Case 11: the line from the crossing bends to the zero vertex beside the positive sample (β) or
  /// the negative one (γ), equations A.6 and A.7.
  void bent_line(int f) {
    const auto& s = face_signs_[f];
    int q = 0;
    while (s[q] != 0 || s[(q + 1) % 4] != 0) ++q;
    const int edge = cube().face_edges[f][q];
    int deciding = cube().other_face(edge, f);
    int e = edge;
    while (graph_.face_case[deciding] == 12) {
      e = cube().opposite_edge(e, deciding);
      deciding = cube().other_face(e, deciding);
    }
    bool positive_side = false;  // the strip beyond the line belongs to the positive side (γ)
    if (graph_.face_case[deciding] == 11) {
      positive_side = ask_mixed(f, others(f, edge), others(deciding, e));
    } else {
      positive_side = definite_sign(deciding, e) > 0;
    }
    graph_.zero_face_sign[f] = positive_side ? 1 : -1;
    const int separated = positive_side ? -1 : 1;
    const int crossing = 2 * (q + 2) + 1;
    if (s[(q + 2) % 4] == separated) {
      add_edge(f, crossing, 2 * (q + 1), separated);
    } else {
      add_edge(f, 2 * q, crossing, separated);
    }
  }

  /// Case 12: sign of the face as seen from this cell, and the zero edge at the weaker side (A.8,
  /// A.9).
  void zero_face(int f) {
    int sign = 0;
    for (int k = 0; k < 2; ++k) {
      const std::array<int, 2> edge{cube().face_edges[f][k], cube().face_edges[f][k + 2]};
      const std::array<int, 2> side{cube().other_face(edge[0], f), cube().other_face(edge[1], f)};
      std::array<Others, 2> o{others(side[0], edge[0]), others(side[1], edge[1])};
      std::array<int, 2> definite{definite_sign(side[0], edge[0]), definite_sign(side[1], edge[1])};
      if (definite[0] * definite[1] < 0) {
        const int p = definite[0] > 0 ? 0 : 1;
        const int n = 1 - p;
        bool positive_stronger = false;
        if (o[p].zero_count == o[n].zero_count) {
          if (o[p].zero_count == 0) {
            positive_stronger = ask(f, o[p].all, o[n].all);
          } else {
            positive_stronger = ask(f, {o[p].positive, -1}, {o[n].negative, -1});
          }
        } else {
          positive_stronger = o[p].zero_count == 0;
        }
        sign = positive_stronger ? 1 : -1;
        const int weaker = positive_stronger ? n : p;
        carry_zero_edge(edge[weaker], side[weaker], definite[weaker]);
      } else if (definite[0] != 0) {
        sign = definite[0];
      } else if (definite[1] != 0) {
        sign = definite[1];
      } else if (o[0].zero_count == 0 && o[1].zero_count == 0) {
        sign = ask_mixed(f, o[0], o[1]) ? 1 : -1;
      }
    }
    graph_.zero_face_sign[f] = sign;
  }

  /// Directs a zero edge along the boundary of the face beside it, whose sign is given.
  void carry_zero_edge(int edge, int face, int sign) {
    const int k = cube().place(edge, face);
    graph_.zero_edges |= 1u << edge;
    int from = 12 + kCellFaces[face][k], to = 12 + kCellFaces[face][(k + 1) % 4];
    if (sign < 0) std::swap(from, to);
    graph_.edges.push_back({from, to, std::min(face, cube().other_face(edge, face))});
  }

  /// Zero edges between two definite faces of opposite signs (A.5).
  void zero_edges() {
    for (int e = 0; e < 12; ++e) {
      if (signs_[kCellEdges[e][0]] != 0 || signs_[kCellEdges[e][1]] != 0) continue;
      const auto& f = cube().edge_faces[e];
      const int sign = definite_sign(f[0], e);
      if (sign * definite_sign(f[1], e) < 0) carry_zero_edge(e, f[0], sign);
    }
  }

  const CellSigns& signs_;
  std::vector<Comparison>& comparisons_;
  const std::vector<bool>& answers_;
  std::array<std::array<int, 4>, 6> face_signs_{};
  CellGraph graph_;
};

}  // namespace

CellGraph apply_rules(const CellSigns& signs, std::vector<Comparison>& comparisons,
                      const std::vector<bool>& answers) {
  return Solver(signs, comparisons, answers).solve();
}

std::vector<Comparison> required_comparisons(const CellSigns& signs) {
  std::vector<Comparison> comparisons;
  apply_rules(signs, comparisons, {});
  return comparisons;
}

std::vector<std::vector<CellSurfaceVertex>> find_cycles(const CellGraph& graph) {
  std::array<int, 20> next{};
  next.fill(-1);
  for (const PatchEdge& edge : graph.edges) next[edge.from] = edge.to;
  std::vector<std::vector<CellSurfaceVertex>> cycles;
  for (int start = 0; start < 20; ++start) {
    if (next[start] < 0) continue;
    auto& cycle = cycles.emplace_back();
    int v = start;
    while (v >= 0 && next[v] >= 0) {
      cycle.push_back(v);
      const int following = next[v];
      next[v] = -1;
      v = following;
    }
    assert(v == start && cycle.size() >= 3);
  }
  return cycles;
}

int case_index(const CellSigns& signs) {
  int index = 0;
  for (int v = 7; v >= 0; --v) index = 3 * index + (signs[v] == 0 ? 0 : signs[v] > 0 ? 1 : 2);
  return index;
}

}  // namespace shape3d::zmc::detail
