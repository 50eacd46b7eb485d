#include "samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "error.hpp"
#include "memory_limit.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

using zmc::SampleType;

template <class T>
struct Type {
  using type = T;
};

template <class F>
auto visit(StoredType type, F&& f) {
  switch (type) {
    case StoredType::int8:
      return f(Type<std::int8_t>{});
    case StoredType::uint8:
      return f(Type<std::uint8_t>{});
    case StoredType::int16:
      return f(Type<std::int16_t>{});
    case StoredType::uint16:
      return f(Type<std::uint16_t>{});
    case StoredType::int32:
      return f(Type<std::int32_t>{});
    case StoredType::uint32:
      return f(Type<std::uint32_t>{});
    case StoredType::int64:
      return f(Type<std::int64_t>{});
    case StoredType::uint64:
      return f(Type<std::uint64_t>{});
    case StoredType::float32:
      return f(Type<float>{});
    case StoredType::float64:
      break;
  }
  return f(Type<double>{});
}

template <class F>
auto visit(SampleType type, F&& f) {
  switch (type) {
    case SampleType::int8:
      return f(Type<std::int8_t>{});
    case SampleType::uint8:
      return f(Type<std::uint8_t>{});
    case SampleType::int16:
      return f(Type<std::int16_t>{});
    case SampleType::uint16:
      return f(Type<std::uint16_t>{});
    case SampleType::int32:
      return f(Type<std::int32_t>{});
    case SampleType::float32:
      return f(Type<float>{});
    case SampleType::float64:
      break;
  }
  return f(Type<double>{});
}

std::optional<SampleType> direct_type(StoredType type) {
  switch (type) {
    case StoredType::int8:
      return SampleType::int8;
    case StoredType::uint8:
      return SampleType::uint8;
    case StoredType::int16:
      return SampleType::int16;
    case StoredType::uint16:
      return SampleType::uint16;
    case StoredType::int32:
      return SampleType::int32;
    case StoredType::float32:
      return SampleType::float32;
    case StoredType::float64:
      return SampleType::float64;
    case StoredType::uint32:
    case StoredType::int64:
    case StoredType::uint64:
      break;
  }
  return std::nullopt;
}

bool is_real(StoredType type) { return type == StoredType::float32 || type == StoredType::float64; }

std::size_t size_of(SampleType type) {
  return visit(type, [](auto tag) { return sizeof(typename decltype(tag)::type); });
}

template <class T>
T load(const std::byte* bytes, std::size_t index) {
  T value;
  std::memcpy(&value, bytes + index * sizeof(T), sizeof(T));
  return value;
}

// Range of the finite samples of a block; lower > upper when there are none.
template <class T>
struct Range {
  T lower = std::numeric_limits<T>::max();
  T upper = std::numeric_limits<T>::lowest();
};

template <class T>
Range<T> range_of(const std::byte* bytes, std::size_t first, std::size_t count) {
  Range<T> range;
  for (std::size_t index = first; index < first + count; ++index) {
    const T value = load<T>(bytes, index);
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(value)) continue;
    }
    range.lower = std::min(range.lower, value);
    range.upper = std::max(range.upper, value);
  }
  return range;
}

bool integral(const Scale& scale) {
  return std::trunc(scale.slope) == scale.slope && std::trunc(scale.intercept) == scale.intercept;
}

bool fits(SampleType type, double lower, double upper) {
  return visit(type, [&](auto tag) {
    using T = typename decltype(tag)::type;
    return lower >= static_cast<double>(std::numeric_limits<T>::lowest()) &&
           upper <= static_cast<double>(std::numeric_limits<T>::max());
  });
}

// Range of all scaled values.
Range<double> scaled_range(const std::vector<std::byte>& bytes, StoredType stored,
                           const std::vector<Scale>& scales) {
  Range<double> result;
  visit(stored, [&](auto tag) {
    using T = typename decltype(tag)::type;
    const std::size_t block = bytes.size() / sizeof(T) / scales.size();
    for (std::size_t b = 0; b < scales.size(); ++b) {
      const Range<T> range = range_of<T>(bytes.data(), b * block, block);
      if (range.lower > range.upper) continue;
      for (const T value : {range.lower, range.upper}) {
        const double scaled = static_cast<double>(value) * scales[b].slope + scales[b].intercept;
        result.lower = std::min(result.lower, scaled);
        result.upper = std::max(result.upper, scaled);
      }
    }
  });
  return result;
}

SampleType scaled_type(const std::vector<std::byte>& bytes, StoredType stored,
                       const std::vector<Scale>& scales) {
  const Range<double> range = scaled_range(bytes, stored, scales);
  if (!is_real(stored) && std::all_of(scales.begin(), scales.end(), integral)) {
    const std::optional<SampleType> own = direct_type(stored);
    if (own && fits(*own, range.lower, range.upper)) return *own;
    for (const SampleType type : {SampleType::int16, SampleType::uint16, SampleType::int32}) {
      if (fits(type, range.lower, range.upper)) return type;
    }
    return SampleType::float64;
  }
  const bool narrow = stored == StoredType::float32 || sample_size(stored) <= 2;
  const bool overflows =
      range.lower <= range.upper && !fits(SampleType::float32, range.lower, range.upper);
  return narrow && !overflows ? SampleType::float32 : SampleType::float64;
}

// Type for unscaled 32- and 64-bit integers that extraction does not read.
SampleType wide_type(const std::vector<std::byte>& bytes, StoredType stored,
                     const std::filesystem::path& path) {
  return visit(stored, [&](auto tag) {
    using T = typename decltype(tag)::type;
    if constexpr (std::is_integral_v<T> && sizeof(T) >= 4) {
      const std::size_t count = bytes.size() / sizeof(T);
      const Range<T> range = range_of<T>(bytes.data(), 0, count);
      constexpr auto kLargest = std::numeric_limits<std::int32_t>::max();
      const bool small = range.upper <= static_cast<T>(kLargest) &&
                         (std::is_unsigned_v<T> || static_cast<std::int64_t>(range.lower) >=
                                                       std::numeric_limits<std::int32_t>::min());
      if (small) return SampleType::int32;
      for (std::size_t index = 0; index < count; ++index) {
        const T value = load<T>(bytes.data(), index);
        // A double of 2^63 or more would overflow the cast back; it is never the value itself here.
        const auto real = static_cast<double>(value);
        const bool in_range = real < std::ldexp(1.0, std::numeric_limits<T>::digits);
        if (!in_range || static_cast<T>(real) != value) {
          throw FileError(path, std::string(to_string(stored)) + " value " + std::to_string(value) +
                                    " has no exact double; expected values that float64 can hold");
        }
      }
    }
    return SampleType::float64;
  });
}

// In place when the sizes agree: sample `index` is read before it is written.
void convert(const std::byte* in, StoredType stored, std::byte* out, SampleType type,
             const std::vector<Scale>& scales, std::size_t count) {
  const std::size_t block = count / scales.size();
  visit(stored, [&](auto in_tag) {
    using In = typename decltype(in_tag)::type;
    visit(type, [&](auto out_tag) {
      using Out = typename decltype(out_tag)::type;
      for (std::size_t b = 0; b < scales.size(); ++b) {
        const Scale scale = scales[b];
        for (std::size_t index = b * block; index < (b + 1) * block; ++index) {
          const double value =
              static_cast<double>(load<In>(in, index)) * scale.slope + scale.intercept;
          const Out result = static_cast<Out>(value);
          std::memcpy(out + index * sizeof(Out), &result, sizeof(Out));
        }
      }
    });
  });
}

}  // namespace

TypedSamples convert_samples(std::vector<std::byte> bytes, StoredType stored,
                             const std::vector<Scale>& scales, const std::filesystem::path& path,
                             std::uint64_t memory_limit) {
  for (const Scale& scale : scales) {
    if (!std::isfinite(scale.slope) || scale.slope == 0.0 || !std::isfinite(scale.intercept)) {
      throw FileError(path, "slope " + to_text(scale.slope) + " and intercept " +
                                to_text(scale.intercept) +
                                "; expected finite numbers, the slope not zero");
    }
  }
  const bool trivial =
      std::all_of(scales.begin(), scales.end(), [](const Scale& s) { return s.trivial(); });
  const std::optional<SampleType> direct = direct_type(stored);
  TypedSamples result;
  if (trivial && direct) {
    result.type = *direct;
    result.bytes = std::move(bytes);
    return result;
  }
  result.type = trivial ? wide_type(bytes, stored, path) : scaled_type(bytes, stored, scales);
  const std::size_t count = bytes.size() / sample_size(stored);
  if (size_of(result.type) == sample_size(stored)) {
    convert(bytes.data(), stored, bytes.data(), result.type, scales, count);
    result.bytes = std::move(bytes);
    return result;
  }
  require_memory(path, count * size_of(result.type), memory_limit,
                 std::to_string(count) + " samples as " + std::string(zmc::to_string(result.type)));
  result.bytes.resize(count * size_of(result.type));
  convert(bytes.data(), stored, result.bytes.data(), result.type, scales, count);
  return result;
}

void swap_bytes(std::vector<std::byte>& bytes, std::size_t sample_size) {
  const auto swap_all = [&bytes](auto zero, auto&& swapped) {
    using Word = decltype(zero);
    for (std::size_t index = 0; index < bytes.size() / sizeof(Word); ++index) {
      const Word word = swapped(load<Word>(bytes.data(), index));
      std::memcpy(bytes.data() + index * sizeof(Word), &word, sizeof(Word));
    }
  };
  if (sample_size == 2) {
    swap_all(std::uint16_t{0}, [](std::uint16_t word) { return __builtin_bswap16(word); });
  } else if (sample_size == 4) {
    swap_all(std::uint32_t{0}, [](std::uint32_t word) { return __builtin_bswap32(word); });
  } else if (sample_size == 8) {
    swap_all(std::uint64_t{0}, [](std::uint64_t word) { return __builtin_bswap64(word); });
  }
}

}  // namespace shape3d::apps
