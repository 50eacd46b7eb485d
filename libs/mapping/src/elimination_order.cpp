#include "elimination_order.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include <camd.h>
#include <cholmod.h>

namespace shape3d::mapping {
namespace {

/// Neighbours of each vertex, ascending, one list after the other.
struct Graph {
  std::vector<std::int32_t> begin, neighbour;

  Graph(const HalfEdges& edges, Eigen::Index vertices) : begin(vertices + 1, 0) {
    for (const auto& [from, to] : edges) ++begin[from + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    neighbour.resize(edges.size());
    std::vector<std::int32_t> place(begin.begin(), begin.end() - 1);
    for (const auto& [from, to] : edges) neighbour[place[from]++] = to;
    // Loops and repetitions are dropped while the lists move up.
    std::int32_t end = 0;
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(vertices); ++v) {
      const auto first = neighbour.begin() + begin[v], last = neighbour.begin() + begin[v + 1];
      std::sort(first, last);
      begin[v] = end;
      std::int32_t previous = v;
      for (auto at = first; at != last; ++at) {
        if (*at != v && *at != previous) neighbour[end++] = *at;
        previous = *at;
      }
    }
    begin[vertices] = end;
    neighbour.resize(end);
  }
};

class Dissection {
 public:
  Dissection(const ConstPoints& positions, const Graph& graph)
      : positions_(positions),
        graph_(graph),
        side_(positions.rows(), kElsewhere),
        depth_(positions.rows(), kInPart) {
    std::vector<std::int32_t> all(positions.rows());
    std::iota(all.begin(), all.end(), 0);
    dissect(std::move(all), 0);
  }

  /// Rank of each vertex's set: parts first, then the cuts, the first cut last.
  [[nodiscard]] std::vector<int> ranks() const {
    std::vector<int> ranks(depth_.size());
    for (std::size_t v = 0; v < ranks.size(); ++v) {
      ranks[v] = depth_[v] == kInPart ? 0 : deepest_ + 1 - depth_[v];
    }
    return ranks;
  }

 private:
  static constexpr char kElsewhere = 2;
  static constexpr int kInPart = -1;
  static constexpr std::size_t kSmallestPart = 50;
  using List = std::vector<std::int32_t>;

  [[nodiscard]] bool touches(std::int32_t v, char side) const {
    for (std::int32_t k = graph_.begin[v]; k < graph_.begin[v + 1]; ++k) {
      if (side_[graph_.neighbour[k]] == side) return true;
    }
    return false;
  }

  void mark(const List& halved) {
    for (std::size_t k = 0; k < halved.size(); ++k)
      side_[halved[k]] = 2 * k < halved.size() ? 0 : 1;
  }

  /// Vertices of a side that touch the other one.
  [[nodiscard]] std::size_t cut_size(const List& halved, char side) const {
    return static_cast<std::size_t>(
        std::count_if(halved.begin(), halved.end(), [this, side](std::int32_t v) {
          return side_[v] == side && touches(v, static_cast<char>(1 - side));
        }));
  }

  void dissect(List part, int depth) {
    if (part.size() <= kSmallestPart) return;
    deepest_ = std::max(deepest_, depth);
    List best;
    char cut_side = 0;
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (int axis = 0; axis < 3; ++axis) {
      List halved = part;
      std::nth_element(halved.begin(), halved.begin() + (halved.size() + 1) / 2, halved.end(),
                       [this, axis](std::int32_t l, std::int32_t r) {
                         const double x = positions_(l, axis), y = positions_(r, axis);
                         return x != y ? x < y : l < r;
                       });
      mark(halved);
      for (const char side : {char{0}, char{1}}) {
        const std::size_t size = cut_size(halved, side);
        if (size >= least) continue;
        least = size;
        best = halved;
        cut_side = side;
      }
    }
    mark(best);
    std::array<List, 2> halves;
    for (const std::int32_t v : best) {
      if (side_[v] == cut_side && touches(v, static_cast<char>(1 - cut_side))) {
        depth_[v] = depth;
      } else {
        halves[side_[v]].push_back(v);
      }
    }
    for (const std::int32_t v : best) side_[v] = kElsewhere;
    part = List();
    best = List();
    for (List& half : halves) dissect(std::move(half), depth + 1);
  }

  const ConstPoints& positions_;
  const Graph& graph_;
  std::vector<char> side_;
  std::vector<int> depth_;
  int deepest_ = 0;
};

/// The lower triangle of the graph with its diagonal, and CHOLMOD's view of it.
class Pattern {
 public:
  explicit Pattern(const Graph& graph) {
    const std::size_t n = graph.begin.size() - 1;
    begin_.push_back(0);
    for (std::size_t v = 0; v < n; ++v) {
      row_.push_back(static_cast<int>(v));
      for (std::int32_t k = graph.begin[v]; k < graph.begin[v + 1]; ++k) {
        if (graph.neighbour[k] > static_cast<std::int32_t>(v)) row_.push_back(graph.neighbour[k]);
      }
      begin_.push_back(static_cast<int>(row_.size()));
    }
    view_.nrow = view_.ncol = n;
    view_.nzmax = row_.size();
    view_.p = begin_.data();
    view_.i = row_.data();
    view_.stype = -1;
    view_.itype = CHOLMOD_INT;
    view_.xtype = CHOLMOD_PATTERN;
    view_.dtype = CHOLMOD_DOUBLE;
    view_.sorted = view_.packed = 1;
  }
  Pattern(const Pattern&) = delete;
  Pattern& operator=(const Pattern&) = delete;
  cholmod_sparse* view() { return &view_; }

 private:
  std::vector<int> begin_, row_;
  cholmod_sparse view_{};
};

}  // namespace

HalfEdges half_edges(const ConstTriangles& F) {
  HalfEdges edges;
  edges.reserve(3 * F.rows());
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) edges.push_back({F(t, k), F(t, (k + 1) % 3)});
  }
  return edges;
}

std::vector<std::int32_t> elimination_order(const ConstPoints& positions, const HalfEdges& edges) {
  const Graph graph(edges, positions.rows());
  std::vector<std::int32_t> order(positions.rows());
  std::iota(order.begin(), order.end(), 0);
  std::vector<int> ranks = Dissection(positions, graph).ranks();
  std::vector<int> dissected(order.begin(), order.end());
  camd_order(static_cast<int>(order.size()), graph.begin.data(), graph.neighbour.data(),
             dissected.data(), nullptr, nullptr, ranks.data());

  Pattern pattern(graph);
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  common.nmethods = 2;
  common.method[0].ordering = CHOLMOD_GIVEN;
  common.method[1].ordering = CHOLMOD_AMD;
  common.supernodal = CHOLMOD_SIMPLICIAL;  // nothing is factorised
  if (cholmod_factor* best =
          cholmod_analyze_p(pattern.view(), dissected.data(), nullptr, 0, &common)) {
    const auto* permutation = static_cast<const int*>(best->Perm);
    order.assign(permutation, permutation + order.size());
    cholmod_free_factor(&best, &common);
  }
  cholmod_finish(&common);
  return order;
}

}  // namespace shape3d::mapping
