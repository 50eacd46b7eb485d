#include "shape3d/learning/approximate_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <unordered_set>
#include <utility>
#include <vector>

// hnswlib prefetches by the entry behind the last of a list, whose value does not matter, and reads
// up to three bytes behind the list for it. The sanitizer is right to say so; without SSE it is
// left out.
#if defined(__SANITIZE_ADDRESS__) && !defined(NO_MANUAL_VECTORIZATION)
#define NO_MANUAL_VECTORIZATION
#endif
#include <hnswlib/hnswlib.h>  // in this file alone: it defines functions

#include "parallel.hpp"
#include "text.hpp"

namespace shape3d::learning {
namespace {

using Graph = hnswlib::HierarchicalNSW<float>;

constexpr char kMagic[8] = {'S', '3', 'D', 'H', 'N', 'S', 'W', '\0'};
constexpr std::uint32_t kVersion = 1;
constexpr double kLargest = 1e15;  // whose square, times many coordinates, is a float

// Coordinates are filled up with zeros to a length that hnswlib takes 16 at a time.
std::size_t padded(Eigen::Index dimension) {
  return (static_cast<std::size_t>(std::max<Eigen::Index>(dimension, 1)) + 15) / 16 * 16;
}

std::vector<float> floats_of(const FeaturesView& rows, Eigen::Index row, std::size_t size) {
  std::vector<float> values(size, 0.0F);
  for (Eigen::Index i = 0; i < rows.cols(); ++i) {
    values[static_cast<std::size_t>(i)] = static_cast<float>(rows(row, i));
  }
  return values;
}

void require_range(const FeaturesView& X, const char* name) {
  for (Eigen::Index row = 0; row < X.rows(); ++row) {
    for (Eigen::Index i = 0; i < X.cols(); ++i) {
      if (std::abs(X(row, i)) <= kLargest) continue;
      throw std::invalid_argument(std::string("row ") + std::to_string(row) + " of " + name +
                                  " has the number " + detail::number(X(row, i)) +
                                  ", expected at most 1e15 in magnitude");
    }
  }
}

void check(const ApproximateNeighboursOptions& options) {
  detail::require_between("links", options.links, 2, 128);
  detail::require_between("build_effort", options.build_effort, options.links, 10000);
  detail::require_between("search_effort", options.search_effort, 1, 100000);
}

// FNV-1a.
std::uint64_t check_sum(std::string_view bytes) {
  std::uint64_t sum = 14695981039346656037U;
  for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return sum;
}

class Writer {
 public:
  template <class Number>
  void number(Number value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void raw(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("the bytes are not a graph of neighbours: " + what);
}

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}
  template <class Number>
  Number number() {
    Number value{};
    raw(&value, sizeof value);
    return value;
  }
  void raw(void* data, std::size_t size) {
    if (rest_.size() < size) refuse("they end early");
    std::memcpy(data, rest_.data(), size);
    rest_.remove_prefix(size);
  }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

}  // namespace

struct ApproximateNeighbours::State {
  State(Eigen::Index count, Eigen::Index columns, const ApproximateNeighboursOptions& chosen)
      : dimension(columns),
        options(chosen),
        space(padded(columns)),
        graph(&space, static_cast<std::size_t>(std::max<Eigen::Index>(count, 1)),
              static_cast<std::size_t>(chosen.links), static_cast<std::size_t>(chosen.build_effort),
              chosen.seed) {
    graph.setEf(1);  // query() asks for as many as it takes
  }

  [[nodiscard]] std::size_t size() const { return graph.cur_element_count; }

  // Links of an item in one level, after whose count they stand.
  [[nodiscard]] bool links_are_sound(const hnswlib::linklistsizeint* list, int level) const {
    const std::size_t most = level == 0 ? graph.maxM0_ : graph.maxM_;
    if (*list > most) return false;  // also where the mark of deletion is set
    const auto* ids = reinterpret_cast<const hnswlib::tableint*>(list + 1);
    return std::all_of(ids, ids + *list, [&](hnswlib::tableint id) {
      return id < size() && graph.element_levels_[id] >= level;
    });
  }

  Eigen::Index dimension;
  ApproximateNeighboursOptions options;
  hnswlib::L2Space space;
  Graph graph;
};

ApproximateNeighbours::ApproximateNeighbours(const FeaturesView& X,
                                             const ApproximateNeighboursOptions& options) {
  check(options);
  require_range(X, "X");
  state_ = std::make_unique<State>(X.rows(), X.cols(), options);
  for (Eigen::Index row = 0; row < X.rows(); ++row) {
    state_->graph.addPoint(floats_of(X, row, padded(X.cols())).data(),
                           static_cast<hnswlib::labeltype>(row));
  }
}

ApproximateNeighbours::ApproximateNeighbours(std::unique_ptr<State> state)
    : state_(std::move(state)) {}
ApproximateNeighbours::~ApproximateNeighbours() = default;
ApproximateNeighbours::ApproximateNeighbours(ApproximateNeighbours&&) noexcept = default;
ApproximateNeighbours& ApproximateNeighbours::operator=(ApproximateNeighbours&&) noexcept = default;

Eigen::Index ApproximateNeighbours::size() const {
  return static_cast<Eigen::Index>(state_->size());
}
Eigen::Index ApproximateNeighbours::dimension() const { return state_->dimension; }
const ApproximateNeighboursOptions& ApproximateNeighbours::options() const {
  return state_->options;
}

Neighbours ApproximateNeighbours::query(const FeaturesView& Q, Eigen::Index k, int effort,
                                        int threads) const {
  if (Q.cols() != dimension()) {
    throw std::invalid_argument("Q has " + std::to_string(Q.cols()) + " columns, expected " +
                                std::to_string(dimension()));
  }
  if (k < 1) throw std::invalid_argument("k is " + std::to_string(k) + ", expected 1 or more");
  if (effort == 0) effort = options().search_effort;
  detail::require_between("effort", effort, 1, 100000);
  require_range(Q, "Q");
  threads = detail::resolve_threads(threads);
  k = std::min(k, size());
  Neighbours result;
  result.rows = Neighbours::Rows::Constant(Q.rows(), k, -1);
  result.distances = Features::Constant(Q.rows(), k, std::numeric_limits<double>::infinity());
  if (k == 0) return result;
  const std::size_t asked = std::max(static_cast<std::size_t>(k), static_cast<std::size_t>(effort));
  detail::parallel_blocks(Q.rows(), 1, threads, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t q = first; q < last; ++q) {
      auto queue = state_->graph.searchKnn(floats_of(Q, q, padded(Q.cols())).data(), asked);
      std::vector<std::pair<float, hnswlib::labeltype>> found;
      for (; !queue.empty(); queue.pop()) found.push_back(queue.top());
      std::sort(found.begin(), found.end());
      const std::size_t count = std::min(found.size(), static_cast<std::size_t>(k));
      for (std::size_t i = 0; i < count; ++i) {
        const auto column = static_cast<Eigen::Index>(i);
        result.rows(q, column) = static_cast<std::int64_t>(found[i].second);
        result.distances(q, column) = std::sqrt(static_cast<double>(found[i].first));
      }
    }
  });
  return result;
}

std::string ApproximateNeighbours::serialize() const {
  const Graph& graph = state_->graph;
  Writer writer;
  writer.raw(kMagic, sizeof kMagic);
  writer.number(kVersion);
  writer.number(static_cast<std::uint32_t>(options().links));
  writer.number(static_cast<std::uint32_t>(options().build_effort));
  writer.number(static_cast<std::uint32_t>(options().search_effort));
  writer.number(static_cast<std::uint32_t>(options().seed));
  writer.number(static_cast<std::int32_t>(graph.maxlevel_));
  writer.number(static_cast<std::uint32_t>(graph.enterpoint_node_));
  writer.number(static_cast<std::uint64_t>(dimension()));
  writer.number(static_cast<std::uint64_t>(size()));
  for (std::size_t i = 0; i < state_->size(); ++i) {
    writer.number(static_cast<std::int32_t>(graph.element_levels_[i]));
  }
  writer.raw(graph.data_level0_memory_, state_->size() * graph.size_data_per_element_);
  for (std::size_t i = 0; i < state_->size(); ++i) {
    const auto levels = static_cast<std::size_t>(graph.element_levels_[i]);
    if (levels > 0) writer.raw(graph.linkLists_[i], levels * graph.size_links_per_element_);
  }
  writer.number(check_sum(writer.bytes()));
  return std::move(writer.bytes());
}

ApproximateNeighbours ApproximateNeighbours::deserialize(std::string_view bytes) {
  if (bytes.size() < sizeof kMagic + sizeof kVersion + sizeof(std::uint64_t) ||
      std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0) {
    refuse("they begin otherwise");
  }
  Reader reader(bytes.substr(sizeof kMagic, bytes.size() - sizeof kMagic - sizeof(std::uint64_t)));
  const auto version = reader.number<std::uint32_t>();
  if (version != kVersion) {
    refuse("their version is " + std::to_string(version) + ", expected " +
           std::to_string(kVersion));
  }
  std::uint64_t sum = 0;
  std::memcpy(&sum, bytes.data() + bytes.size() - sizeof sum, sizeof sum);
  if (sum != check_sum(bytes.substr(0, bytes.size() - sizeof sum))) {
    refuse("their check sum is wrong");
  }
  ApproximateNeighboursOptions options;
  options.links = static_cast<int>(reader.number<std::uint32_t>());
  options.build_effort = static_cast<int>(reader.number<std::uint32_t>());
  options.search_effort = static_cast<int>(reader.number<std::uint32_t>());
  options.seed = reader.number<std::uint32_t>();
  check(options);
  const auto top_level = reader.number<std::int32_t>();
  const auto entry = reader.number<std::uint32_t>();
  const auto columns = reader.number<std::uint64_t>();
  const auto count = reader.number<std::uint64_t>();
  // Each item has its level, at least one float for 16 coordinates, its links and its place.
  if (columns > reader.left() || count > reader.left() / 4 ||
      count * (4 * padded(static_cast<Eigen::Index>(columns)) + 4) > reader.left()) {
    if (count > 0) refuse("their counts do not fit their length");
  }
  auto state = std::make_unique<State>(static_cast<Eigen::Index>(count),
                                       static_cast<Eigen::Index>(columns), options);
  Graph& graph = state->graph;
  std::vector<int> levels(count);
  std::size_t upper = 0;
  for (std::size_t i = 0; i < count; ++i) {
    levels[i] = reader.number<std::int32_t>();
    if (levels[i] < 0 || levels[i] > top_level) refuse("a level is out of range");
    upper += static_cast<std::size_t>(levels[i]);
  }
  if (reader.left() !=
      count * graph.size_data_per_element_ + upper * graph.size_links_per_element_) {
    refuse("their counts do not fit their length");
  }
  if (count == 0) return ApproximateNeighbours(std::move(state));
  if (entry >= count || levels[entry] != top_level) refuse("the entry is out of range");
  reader.raw(graph.data_level0_memory_, count * graph.size_data_per_element_);
  for (std::size_t i = 0; i < count; ++i) {
    graph.linkLists_[i] = nullptr;
    if (levels[i] > 0) {
      const std::size_t size = static_cast<std::size_t>(levels[i]) * graph.size_links_per_element_;
      graph.linkLists_[i] = static_cast<char*>(std::malloc(size));  // which the graph frees
      if (graph.linkLists_[i] == nullptr) throw std::bad_alloc();
      reader.raw(graph.linkLists_[i], size);
    }
    graph.element_levels_[i] = levels[i];
    graph.cur_element_count = i + 1;
  }
  graph.maxlevel_ = top_level;
  graph.enterpoint_node_ = entry;
  for (std::size_t i = 0; i < count; ++i) {
    const auto id = static_cast<hnswlib::tableint>(i);
    if (graph.getExternalLabel(id) >= count) refuse("a place is out of range");
    for (int level = 0; level <= levels[i]; ++level) {
      if (!state->links_are_sound(graph.get_linklist_at_level(id, level), level)) {
        refuse("a link is out of range");
      }
    }
  }
  return ApproximateNeighbours(std::move(state));
}

double recall(const Neighbours& exact, const Neighbours& found) {
  if (exact.rows.rows() != found.rows.rows()) {
    throw std::invalid_argument("the neighbours are of " + std::to_string(exact.rows.rows()) +
                                " and " + std::to_string(found.rows.rows()) +
                                " queries, expected the same number");
  }
  if (exact.rows.size() == 0) return 1.0;
  std::int64_t hits = 0;
  for (Eigen::Index q = 0; q < exact.rows.rows(); ++q) {
    const std::unordered_set<std::int64_t> wanted(exact.rows.row(q).begin(),
                                                  exact.rows.row(q).end());
    hits += std::count_if(found.rows.row(q).begin(), found.rows.row(q).end(),
                          [&](std::int64_t row) { return wanted.count(row) > 0; });
  }
  return static_cast<double>(hits) / static_cast<double>(exact.rows.size());
}

}  // namespace shape3d::learning
