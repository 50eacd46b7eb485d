#include "shape3d/learning/nearest_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "parallel.hpp"
#include "text.hpp"

namespace shape3d::learning {
namespace {

using Singles = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr Eigen::Index kPart = 16384;      // rows that one task looks at
constexpr Eigen::Index kBlock = 1024;      // rows of one product
constexpr Eigen::Index kGroup = 16;        // queries of one product
constexpr Eigen::Index kBatch = 256;       // queries whose candidates are in memory together
constexpr double kUnit = 1.0 / (1 << 24);  // rounding to single precision

void require_finite(const FeaturesView& X, const char* name) {
  for (Eigen::Index row = 0; row < X.rows(); ++row) {
    if (X.row(row).allFinite()) continue;
    throw std::invalid_argument(std::string("row ") + std::to_string(row) + " of " + name +
                                " has a number that is not finite");
  }
}

double exact_distance(const Features& X, Eigen::Index row, const FeaturesView& Q,
                      Eigen::Index query, Norm norm) {
  const double* x = X.data() + row * X.cols();
  double sum = 0.0;  // in the order of coordinates, whatever the processor
  for (Eigen::Index i = 0; i < X.cols(); ++i) {
    const double difference = x[i] - Q(query, i);
    sum += norm == Norm::L1 ? std::abs(difference) : difference * difference;
  }
  return norm == Norm::L1 ? sum : std::sqrt(sum);
}

struct Candidate {
  double score = 0.0;
  Eigen::Index row = 0;
};

// What is known of the scores of one query: by how much they may be wrong.
//
// Scores are in the unit of the library (State::scale). L1: the score is the distance. L2: it is
// the distance squared less |q|², which is the same for all items.
struct ScoreBound {
  Norm norm = Norm::L2;
  double offset = 0.0;    // |q|² for L2
  double error = 0.0;     // of a score, as the distance (squared) of the rounded points
  double movement = 0.0;  // of the distance by rounding the points
  bool usable = true;     // the query is within the range of single precision

  // The largest score an item may have whose distance is not above that of one with this score.
  [[nodiscard]] double limit(double score) const {
    if (norm == Norm::L1) return score + 2.0 * (error + movement);
    const double upper = std::sqrt(std::max(0.0, score + offset + error)) + movement;
    return (upper + movement) * (upper + movement) + error - offset;
  }
};

// The candidates of one query in a part of the library: all that may be among the k nearest.
class Candidates {
 public:
  Candidates(Eigen::Index k, const ScoreBound& bound)
      : k_(static_cast<std::size_t>(k)), bound_(&bound) {
    if (!bound.usable) limit_ = std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] double limit() const { return limit_; }

  void add(double score, Eigen::Index row) {
    list_.push_back({score, row});
    if (!bound_->usable) return;
    if (best_.size() < k_) {
      best_.push_back(score);
      std::push_heap(best_.begin(), best_.end());
      if (best_.size() == k_) limit_ = bound_->limit(best_.front());
    } else if (score < best_.front()) {
      std::pop_heap(best_.begin(), best_.end());
      best_.back() = score;
      std::push_heap(best_.begin(), best_.end());
      limit_ = bound_->limit(best_.front());
    }
    if (list_.size() >= next_prune_) prune();
  }

  void prune() {
    const auto beyond = [this](const Candidate& c) { return c.score > limit_; };
    list_.erase(std::remove_if(list_.begin(), list_.end(), beyond), list_.end());
    next_prune_ = 2 * list_.size() + 4 * k_ + 64;
  }

  [[nodiscard]] const std::vector<Candidate>& list() const { return list_; }

 private:
  std::size_t k_;
  const ScoreBound* bound_;
  double limit_ = std::numeric_limits<double>::infinity();
  std::vector<double> best_;  // a heap of the k smallest scores, the largest in front
  std::vector<Candidate> list_;
  std::size_t next_prune_ = 256;
};

}  // namespace

struct ExactNeighbours::State {
  Features X;
  Norm norm = Norm::L2;
  Eigen::RowVectorXd mean;
  double scale = 1.0;     // a power of 2: (x − mean) · scale is within [−1, 1]
  Singles Y;              // (x − mean) · scale, rounded
  Eigen::VectorXf sizes;  // |y|² for L2
  double largest = 0.0;   // of the norms of Y

  [[nodiscard]] Singles rounded(const FeaturesView& rows) const {
    return ((rows.rowwise() - mean) * scale).cast<float>();
  }

  // Single precision has the unit u = 2⁻²⁴. A sum of d products or differences, in any order, is
  // within (d + 1) u Σ |terms|; Σ |x_i q_i| ≤ |x| |q| ≤ (|x|² + |q|²) / 2. Adding |x|², rounded,
  // adds 3 u |x|² + u |q|². Rounding a point moves it by u of its norm; the double precision of
  // mean and scale is far below. Twice that covers terms of second order, and 1e-30 what is lost
  // below the range of floats.
  [[nodiscard]] ScoreBound bound_of(const Singles& queries, Eigen::Index query) const {
    ScoreBound bound;
    bound.norm = norm;
    const Eigen::RowVectorXd q = queries.row(query).cast<double>();
    const auto terms = static_cast<double>(X.cols()) + 6.0;
    if (norm == Norm::L1) {
      const double sum = largest + q.lpNorm<1>();
      bound.error = 2.0 * terms * kUnit * sum + 1e-30;
      bound.movement = 2.0 * kUnit * sum;
      bound.usable = sum < 1e30;
    } else {
      const double squares = largest * largest + q.squaredNorm();
      bound.offset = q.squaredNorm();
      bound.error = 2.0 * terms * kUnit * squares + 1e-30;
      bound.movement = 2.0 * kUnit * (largest + q.norm()) + 1e-15;
      bound.usable = squares < 1e30;
    }
    return bound;
  }

  // Scores of rows [first, last) for queries [from, from + count), in `scores` (rows by queries).
  void score(const Singles& queries, Eigen::Index from, Eigen::Index count, Eigen::Index first,
             Eigen::Index last, Eigen::MatrixXf& scores) const {
    const auto rows = Y.middleRows(first, last - first);
    if (norm == Norm::L1) {
      for (Eigen::Index q = 0; q < count; ++q) {
        for (Eigen::Index row = 0; row < last - first; ++row) {
          scores(row, q) = (rows.row(row) - queries.row(from + q)).lpNorm<1>();
        }
      }
      return;
    }
    auto block = scores.topLeftCorner(last - first, count);
    if (count == 1) {
      block.col(0).noalias() = rows * queries.row(from).transpose();
    } else {
      block.noalias() = rows * queries.middleRows(from, count).transpose();
    }
    block = (-2.0F * block).colwise() + sizes.segment(first, last - first);
  }

  void look(const Singles& queries, Eigen::Index from, Eigen::Index count, Eigen::Index part,
            std::vector<Candidates>& candidates, std::size_t stride) const {
    Eigen::MatrixXf scores(kBlock, count);
    const Eigen::Index end = std::min(X.rows(), (part + 1) * kPart);
    for (Eigen::Index first = part * kPart; first < end; first += kBlock) {
      const Eigen::Index last = std::min(end, first + kBlock);
      score(queries, from, count, first, last, scores);
      for (Eigen::Index q = 0; q < count; ++q) {
        Candidates& own = candidates[static_cast<std::size_t>(from + q) * stride +
                                     static_cast<std::size_t>(part)];
        const float* column = scores.data() + q * kBlock;
        double limit = own.limit();
        for (Eigen::Index row = 0; row < last - first; ++row) {
          if (column[row] > limit) continue;  // a score that is no number is none to leave out
          own.add(column[row], first + row);
          limit = own.limit();
        }
      }
    }
  }
};

ExactNeighbours::ExactNeighbours(Features X, Norm norm) {
  require_finite(X, "X");
  auto state = std::make_unique<State>();
  state->X = std::move(X);
  state->norm = norm;
  const Eigen::Index n = state->X.rows();
  state->mean = Eigen::RowVectorXd::Zero(state->X.cols());
  if (n > 0) {
    for (Eigen::Index row = 0; row < n; ++row) {
      state->mean += state->X.row(row) / static_cast<double>(n);
    }
    double range = 0.0;
    for (Eigen::Index row = 0; row < n; ++row) {
      range = std::max(range, (state->X.row(row) - state->mean).lpNorm<Eigen::Infinity>());
    }
    int exponent = 0;
    std::frexp(range, &exponent);
    if (range > 0.0) state->scale = std::ldexp(1.0, std::clamp(-exponent, -1000, 1000));
  }
  state->Y.resize(n, state->X.cols());
  state->sizes.resize(n);
  for (Eigen::Index row = 0; row < n; ++row) {
    state->Y.row(row) = ((state->X.row(row) - state->mean) * state->scale).cast<float>();
    const auto y = state->Y.row(row).cast<double>();
    state->sizes[row] = static_cast<float>(y.squaredNorm());
    state->largest = std::max(state->largest, norm == Norm::L1 ? y.lpNorm<1>() : y.norm());
  }
  state_ = std::move(state);
}

ExactNeighbours::~ExactNeighbours() = default;
ExactNeighbours::ExactNeighbours(ExactNeighbours&&) noexcept = default;
ExactNeighbours& ExactNeighbours::operator=(ExactNeighbours&&) noexcept = default;

const Features& ExactNeighbours::vectors() const { return state_->X; }

Neighbours ExactNeighbours::query(const FeaturesView& Q, Eigen::Index k, int threads) const {
  const State& state = *state_;
  const Eigen::Index n = state.X.rows();
  if (Q.cols() != state.X.cols()) {
    throw std::invalid_argument("Q has " + std::to_string(Q.cols()) + " columns, expected " +
                                std::to_string(state.X.cols()));
  }
  if (k < 1) throw std::invalid_argument("k is " + std::to_string(k) + ", expected 1 or more");
  require_finite(Q, "Q");
  threads = detail::resolve_threads(threads);
  k = std::min(k, n);
  Neighbours result;
  result.rows.resize(Q.rows(), k);
  result.distances.resize(Q.rows(), k);
  if (k == 0) return result;

  const Eigen::Index parts = (n + kPart - 1) / kPart;
  for (Eigen::Index begin = 0; begin < Q.rows(); begin += kBatch) {
    const Eigen::Index count = std::min(kBatch, Q.rows() - begin);
    const Singles queries = state.rounded(Q.middleRows(begin, count));
    std::vector<ScoreBound> bounds;
    for (Eigen::Index q = 0; q < count; ++q) bounds.push_back(state.bound_of(queries, q));
    std::vector<Candidates> candidates;  // by query, then part
    candidates.reserve(static_cast<std::size_t>(count * parts));
    for (Eigen::Index q = 0; q < count; ++q) {
      for (Eigen::Index part = 0; part < parts; ++part) {
        candidates.emplace_back(k, bounds[static_cast<std::size_t>(q)]);
      }
    }
    const Eigen::Index groups = (count + kGroup - 1) / kGroup;
    detail::parallel_blocks(groups * parts, 1, threads, [&](std::int64_t first, std::int64_t last) {
      for (std::int64_t task = first; task < last; ++task) {
        const Eigen::Index from = task / parts * kGroup;
        state.look(queries, from, std::min(kGroup, count - from), task % parts, candidates,
                   static_cast<std::size_t>(parts));
      }
    });
    detail::parallel_blocks(count, 1, threads, [&](std::int64_t first, std::int64_t last) {
      for (std::int64_t q = first; q < last; ++q) {
        Candidates all(k, bounds[static_cast<std::size_t>(q)]);
        for (Eigen::Index part = 0; part < parts; ++part) {
          for (const Candidate& c : candidates[static_cast<std::size_t>(q * parts + part)].list()) {
            all.add(c.score, c.row);
          }
        }
        all.prune();
        std::vector<std::pair<double, Eigen::Index>> found;
        for (const Candidate& c : all.list()) {
          found.emplace_back(exact_distance(state.X, c.row, Q, begin + q, state.norm), c.row);
        }
        std::partial_sort(found.begin(), found.begin() + k, found.end());
        for (Eigen::Index i = 0; i < k; ++i) {
          result.distances(begin + q, i) = found[static_cast<std::size_t>(i)].first;
          result.rows(begin + q, i) = found[static_cast<std::size_t>(i)].second;
        }
      }
    });
  }
  return result;
}

}  // namespace shape3d::learning
