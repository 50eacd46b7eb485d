#include "shape3d/levelset/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <tbb/combinable.h>

#include "message.hpp"
#include "parallel.hpp"
#include "samples.hpp"

namespace shape3d::levelset {
namespace {

using detail::parallel_for;
using Counts = std::vector<std::int64_t>;

/// Calls visit(value) for each sample of slice k.
template <class T, class Visit>
void for_slice(const ImageView& image, std::int64_t k, const Visit& visit) {
  const detail::Rows<T> rows(image);
  for (std::int64_t j = 0; j < image.dims[1]; ++j) {
    const T* row = rows.row(j, k);
    for (std::int64_t i = 0; i < image.dims[0]; ++i) visit(row[i * rows.stride()]);
  }
}

/// Counts of bin_of(value); negative bins are left out. Whole numbers: the order does not matter.
template <class T, class BinOf>
Counts count(const ImageView& image, std::size_t bins, int threads, const BinOf& bin_of) {
  tbb::combinable<Counts> parts([&] { return Counts(bins, 0); });
  parallel_for(image.dims[2], threads, [&](std::int64_t k) {
    Counts& counts = parts.local();
    for_slice<T>(image, k, [&](T value) {
      const std::int64_t bin = bin_of(value);
      if (bin >= 0) ++counts[static_cast<std::size_t>(bin)];
    });
  });
  Counts sum(bins, 0);
  parts.combine_each([&](const Counts& part) {
    for (std::size_t b = 0; b < bins; ++b) sum[b] += part[b];
  });
  return sum;
}

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();
  [[nodiscard]] bool empty() const { return least > greatest; }
};

/// Range of the samples other than `left_out`.
template <class T>
Range range(const ImageView& image, std::optional<double> left_out, int threads) {
  std::vector<Range> slices(static_cast<std::size_t>(image.dims[2]));
  const double skip = left_out.value_or(std::numeric_limits<double>::quiet_NaN());
  parallel_for(image.dims[2], threads, [&](std::int64_t k) {
    Range found;
    for_slice<T>(image, k, [&](T sample) {
      const auto value = static_cast<double>(sample);
      if (value == skip) return;
      found.least = std::min(found.least, value);
      found.greatest = std::max(found.greatest, value);
    });
    slices[static_cast<std::size_t>(k)] = found;
  });
  Range all;
  for (const Range& slice : slices) {
    all.least = std::min(all.least, slice.least);
    all.greatest = std::max(all.greatest, slice.greatest);
  }
  return all;
}

struct Bins {
  double lower = 0.0, width = 1.0;
  int count = 1;
};

template <class T>
Bins choose_bins(const Range& range, int max_bins) {
  const double span = range.greatest - range.least;
  if constexpr (std::is_integral_v<T>) {
    const double width = std::floor(span / max_bins) + 1.0;  // values 0 … span: span + 1 of them
    return {range.least - 0.5, width, static_cast<int>(std::floor(span / width)) + 1};
  } else {
    if (span == 0.0) return {range.least - 0.5, 1.0, 1};
    return {range.least, span / max_bins, max_bins};
  }
}

/// The samples of an image, to be gone through several times. Whole numbers of up to 16 bits are
/// counted by value first, and then only the values are gone through.
template <class T>
class Samples {
 public:
  Samples(const ImageView& image, int threads) : image_(image), threads_(threads) {
    if constexpr (kByValue) {
      by_value_ =
          count<T>(image, kValues, threads, [](T value) { return std::int64_t{value} - kLeast; });
    }
  }

  [[nodiscard]] Range range_without(std::optional<double> left_out) const {
    if constexpr (!kByValue) return range<T>(image_, left_out, threads_);
    Range found;
    for_values([&](double value, std::int64_t /*times*/) {
      if (left_out && value == *left_out) return;
      found.least = std::min(found.least, value);
      found.greatest = std::max(found.greatest, value);
    });
    return found;
  }

  [[nodiscard]] std::int64_t count_of(double wanted) const {
    if constexpr (kByValue) {
      return by_value_[static_cast<std::size_t>(static_cast<std::int64_t>(wanted) - kLeast)];
    } else {
      return count<T>(image_, 1, threads_, [&](T sample) {
        return static_cast<double>(sample) == wanted ? std::int64_t{0} : std::int64_t{-1};
      })[0];
    }
  }

  [[nodiscard]] Counts fill(const Bins& bins, std::optional<double> left_out) const {
    const double skip = left_out.value_or(std::numeric_limits<double>::quiet_NaN());
    const double scale = 1.0 / bins.width;
    const auto bin_of = [&](double value) {
      if (value == skip) return std::int64_t{-1};
      return std::min<std::int64_t>(static_cast<std::int64_t>((value - bins.lower) * scale),
                                    bins.count - 1);
    };
    if constexpr (kByValue) {
      Counts counts(static_cast<std::size_t>(bins.count), 0);
      for_values([&](double value, std::int64_t times) {
        const std::int64_t bin = bin_of(value);
        if (bin >= 0) counts[static_cast<std::size_t>(bin)] += times;
      });
      return counts;
    } else {
      return count<T>(image_, static_cast<std::size_t>(bins.count), threads_,
                      [&](T sample) { return bin_of(static_cast<double>(sample)); });
    }
  }

 private:
  static constexpr bool kByValue = std::is_integral_v<T> && sizeof(T) <= 2;
  static constexpr std::int64_t kLeast =
      kByValue ? static_cast<std::int64_t>(std::numeric_limits<T>::min()) : 0;
  static constexpr std::size_t kValues = kByValue ? std::size_t{1} << (8 * sizeof(T)) : 0;

  template <class Visit>
  void for_values(const Visit& visit) const {
    for (std::size_t n = 0; n < by_value_.size(); ++n)
      if (by_value_[n] > 0)
        visit(static_cast<double>(static_cast<std::int64_t>(n) + kLeast), by_value_[n]);
  }

  const ImageView& image_;
  int threads_;
  Counts by_value_;
};

/// The least value is padding when it stands out as a peak: 1 in 1000 to 1 in 4 of the samples, and
/// more than 20 times as many as the bins in the 2 % of the range above it hold on average.
bool is_padding(std::int64_t at_least, std::int64_t total, const Counts& others) {
  if (1000 * at_least < total || 4 * at_least > total) return false;
  const std::size_t near = std::max<std::size_t>(1, others.size() / 50);
  std::int64_t sum = 0;
  for (std::size_t b = 1; b <= std::min(near, others.size() - 1); ++b) sum += others[b];
  return static_cast<double>(at_least) >
         20.0 * static_cast<double>(sum) / static_cast<double>(near);
}

template <class T>
Histogram compute(const ImageView& image, const HistogramOptions& options, int threads) {
  Histogram result;
  result.padding = options.padding;
  const Samples<T> samples(image, threads);
  Range found = samples.range_without(result.padding);
  Bins bins;
  Counts counts;
  if (!found.empty()) {
    bins = choose_bins<T>(found, options.max_bins);
    counts = samples.fill(bins, result.padding);
  }
  if (!options.padding && options.detect_padding && counts.size() > 1) {
    std::int64_t at_least = counts[0];
    if (!std::is_integral_v<T> || bins.width > 1.0) {
      at_least = samples.count_of(found.least);
    }
    if (is_padding(at_least, image.grid().size(), counts)) {
      const Range rest = samples.range_without(found.least);
      if (rest.least < rest.greatest) {
        result.padding = found.least;
        found = rest;
        bins = choose_bins<T>(found, options.max_bins);
        counts = samples.fill(bins, result.padding);
      }
    }
  }
  result.counts.resize(static_cast<Eigen::Index>(counts.size()));
  std::int64_t total = 0;
  for (std::size_t b = 0; b < counts.size(); ++b) {
    result.counts[static_cast<Eigen::Index>(b)] = static_cast<double>(counts[b]);
    total += counts[b];
  }
  result.lower = bins.lower;
  result.bin_width = bins.width;
  result.minimum = found.empty() ? 0.0 : found.least;
  result.maximum = found.empty() ? 0.0 : found.greatest;
  result.padding_samples = image.grid().size() - total;
  return result;
}

}  // namespace

Histogram histogram(const ImageView& image, const HistogramOptions& options) {
  validate(image);
  detail::require(options.max_bins >= 2, "max_bins", options.max_bins, "at least 2");
  const int threads = detail::resolve_threads(options.threads);
  detail::require_finite(image, threads);
  return detail::visit_sample_type(
      image.type, [&](auto sample) { return compute<decltype(sample)>(image, options, threads); });
}

}  // namespace shape3d::levelset
