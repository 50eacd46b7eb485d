#include "surface.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace shape3d::mapping {
namespace {

using std::to_string;

/// A half-edge with its ends in increasing order.
struct Side {
  std::int32_t low, high, half_edge;
  bool forward;
};

/// Half-edges sorted by edge: a counting sort by the lower end, then each short list by the higher.
std::vector<Side> sorted_sides(const ConstTriangles& F, Eigen::Index vertex_count) {
  std::vector<std::int64_t> begin(static_cast<std::size_t>(vertex_count) + 1, 0);
  const auto corner = [&](std::int64_t h) { return F(h / 3, h % 3); };
  const auto count = static_cast<std::int64_t>(3 * F.rows());
  for (std::int64_t h = 0; h < count; ++h) {
    const auto n = static_cast<std::int64_t>(next_half_edge(static_cast<std::int32_t>(h)));
    ++begin[std::min(corner(h), corner(n)) + 1];
  }
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<Side> sides(static_cast<std::size_t>(count));
  std::vector<std::int64_t> place(begin.begin(), begin.end() - 1);
  for (std::int64_t h = 0; h < count; ++h) {
    const std::int32_t a = corner(h), b = corner(next_half_edge(static_cast<std::int32_t>(h)));
    sides[place[std::min(a, b)]++] = {std::min(a, b), std::max(a, b), static_cast<std::int32_t>(h),
                                      a < b};
  }
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    std::sort(sides.begin() + begin[v], sides.begin() + begin[v + 1],
              [](const Side& l, const Side& r) {
                return l.high != r.high ? l.high < r.high : l.half_edge < r.half_edge;
              });
  }
  return sides;
}

Twins edge_twins(const ConstTriangles& F, Eigen::Index vertex_count) {
  const std::vector<Side> sides = sorted_sides(F, vertex_count);
  Twins twins(sides.size(), -1);
  std::int64_t open = 0, crowded = 0, misoriented = 0;
  for (auto begin = sides.begin(); begin != sides.end();) {
    auto end = begin;
    while (end != sides.end() && end->low == begin->low && end->high == begin->high) ++end;
    if (end - begin == 1) {
      ++open;
    } else if (end - begin > 2) {
      ++crowded;
    } else if (begin->forward == (begin + 1)->forward) {
      ++misoriented;
    } else {
      twins[begin->half_edge] = (begin + 1)->half_edge;
      twins[(begin + 1)->half_edge] = begin->half_edge;
    }
    begin = end;
  }
  if (crowded > 0) {
    throw std::invalid_argument("F: " + to_string(crowded) +
                                " edges belong to more than two triangles; expected a manifold");
  }
  if (open > 0) {
    throw std::invalid_argument("F: " + to_string(open) +
                                " edges belong to one triangle only; expected a closed surface");
  }
  if (misoriented > 0) {
    throw std::invalid_argument(
        "F: " + to_string(misoriented) +
        " edges are run the same way by both triangles; expected one orientation");
  }
  return twins;
}

/// Vertices with one fan of triangles around each; counts those with more or none.
void require_fans(const ConstTriangles& F, const Twins& twins, Eigen::Index vertex_count) {
  std::vector<std::int32_t> degree(static_cast<std::size_t>(vertex_count), 0), any(degree);
  for (std::int32_t h = 0; h < static_cast<std::int32_t>(twins.size()); ++h) {
    ++degree[F(h / 3, h % 3)];
    any[F(h / 3, h % 3)] = h;
  }
  std::int64_t unused = 0, split = 0;
  for (std::size_t v = 0; v < degree.size(); ++v) {
    if (degree[v] == 0) {
      ++unused;
      continue;
    }
    std::int32_t around = 0, h = any[v];
    do {
      ++around;
      h = twins[previous_half_edge(h)];
    } while (h != any[v]);
    if (around != degree[v]) ++split;
  }
  if (unused > 0) {
    throw std::invalid_argument("F: " + to_string(unused) +
                                " vertices belong to no triangle; expected all to be used");
  }
  if (split > 0) {
    throw std::invalid_argument(
        "F: " + to_string(split) +
        " vertices join several fans of triangles; expected one fan at each");
  }
}

std::int64_t component_count(const Twins& twins) {
  std::vector<char> seen(twins.size() / 3, 0);
  std::vector<std::int32_t> stack;
  std::int64_t components = 0;
  for (std::size_t start = 0; start < seen.size(); ++start) {
    if (seen[start]) continue;
    ++components;
    seen[start] = 1;
    stack.push_back(static_cast<std::int32_t>(start));
    while (!stack.empty()) {
      const std::int32_t t = stack.back();
      stack.pop_back();
      for (int k = 0; k < 3; ++k) {
        const std::int32_t other = twins[3 * t + k] / 3;
        if (!seen[other]) {
          seen[other] = 1;
          stack.push_back(other);
        }
      }
    }
  }
  return components;
}

}  // namespace

void require_finite(const ConstPoints& P, std::string_view name) {
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (!std::isfinite(P(i, k))) {
        throw std::invalid_argument(std::string(name) + ": row " + to_string(i) + " holds " +
                                    to_string(P(i, k)) + "; expected finite coordinates");
      }
    }
  }
}

void require_indices(const ConstTriangles& F, Eigen::Index vertex_count) {
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (F(t, k) < 0 || F(t, k) >= vertex_count) {
        throw std::invalid_argument("F: row " + to_string(t) + " names vertex " +
                                    to_string(F(t, k)) + "; expected 0 to " +
                                    to_string(vertex_count - 1));
      }
    }
  }
}

Twins genus_zero_twins(const ConstTriangles& F, Eigen::Index vertex_count) {
  if (F.rows() < 4) {
    throw std::invalid_argument("F: " + to_string(F.rows()) +
                                " triangles; expected at least 4, a tetrahedron");
  }
  require_indices(F, vertex_count);
  std::int64_t repeated = 0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    if (F(t, 0) == F(t, 1) || F(t, 1) == F(t, 2) || F(t, 2) == F(t, 0)) ++repeated;
  }
  if (repeated > 0) {
    throw std::invalid_argument("F: " + to_string(repeated) +
                                " triangles repeat a vertex; expected three different ones");
  }
  Twins twins = edge_twins(F, vertex_count);
  require_fans(F, twins, vertex_count);
  const std::int64_t components = component_count(twins);
  if (components > 1) {
    throw std::invalid_argument("F: " + to_string(components) +
                                " connected components; expected one");
  }
  const std::int64_t euler = vertex_count - F.rows() / 2;
  if (euler != 2) {
    throw std::invalid_argument("F: genus " + to_string((2 - euler) / 2) +
                                " (Euler characteristic " + to_string(euler) +
                                "); expected genus 0, no handles");
  }
  return twins;
}

}  // namespace shape3d::mapping
