#include "zmc_case.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "byte_reader.hpp"

namespace shape3d::fuzz {
namespace {

using zmc::SampleType;

template <class Visitor>
void visit(SampleType type, Visitor&& visitor) {
  switch (type) {
    case SampleType::int8:
      return visitor(std::int8_t{});
    case SampleType::uint8:
      return visitor(std::uint8_t{});
    case SampleType::int16:
      return visitor(std::int16_t{});
    case SampleType::uint16:
      return visitor(std::uint16_t{});
    case SampleType::int32:
      return visitor(std::int32_t{});
    case SampleType::float32:
      return visitor(float{});
    case SampleType::float64:
      return visitor(double{});
  }
}

/// The nearest value of a type.
template <class T>
T nearest(double value) {
  if constexpr (std::is_integral_v<T>) {
    return static_cast<T>(std::clamp(std::floor(value),
                                     static_cast<double>(std::numeric_limits<T>::min()),
                                     static_cast<double>(std::numeric_limits<T>::max())));
  } else {
    // Conversion to float is not defined beyond its range.
    return static_cast<T>(std::clamp(value, static_cast<double>(std::numeric_limits<T>::lowest()),
                                     static_cast<double>(std::numeric_limits<T>::max())));
  }
}

/// Values at the ends of a type, and at and beside the isovalue.
template <class T>
T special(int number, double isovalue) {
  using Limits = std::numeric_limits<T>;
  const T near_isovalue = nearest<T>(isovalue);
  switch (number) {
    case 0:
      return near_isovalue;
    case 1:
      return Limits::lowest();
    case 2:
      return Limits::max();
    case 3:
      return T{0};
    case 4:
      return T{1};
    default:
      break;
  }
  if constexpr (std::is_integral_v<T>) {
    const int step = number % 2 == 0 ? 1 : -1;
    return nearest<T>(static_cast<double>(near_isovalue) + step);
  } else {
    switch (number) {
      case 5:
        return std::nextafter(near_isovalue, Limits::lowest());
      case 6:
        return std::nextafter(near_isovalue, Limits::max());
      case 7:
        return Limits::denorm_min();
      case 8:
        return -Limits::denorm_min();
      case 9:
        return Limits::quiet_NaN();
      case 10:
        return Limits::infinity();
      case 11:
        return -Limits::infinity();
      case 12:
        return -T{0};
      case 13:
        return near_isovalue - T{1};
      case 14:
        return near_isovalue + T{1};
      default:
        return Limits::min();
    }
  }
}

/// How bytes become samples.
enum class Alphabet {
  signs,    ///< Two bits a sample: isovalue − 1, isovalue, isovalue + 1, isovalue.
  small,    ///< A byte a sample: isovalue − 8 … isovalue + 7.
  raw,      ///< The bytes of the type.
  specials  ///< Ends of the type, neighbours of the isovalue, NaN, infinities.
};

template <class T>
void fill(ByteReader& bytes, Alphabet alphabet, ZmcCase& one) {
  const auto count = static_cast<std::size_t>(one.dims[0] * one.dims[1] * one.dims[2]);
  one.samples.resize(count * sizeof(T));
  one.values.resize(count);
  unsigned packed = 0;
  for (std::size_t n = 0; n < count; ++n) {
    T sample{};
    switch (alphabet) {
      case Alphabet::signs:
        packed = n % 4 == 0 ? bytes.byte() : packed >> 2;
        sample = nearest<T>(one.isovalue + ((packed & 1) == 0 ? 0 : (packed & 2) == 0 ? -1 : 1));
        break;
      case Alphabet::small:
        sample = nearest<T>(one.isovalue + bytes.byte() % 16 - 8);
        break;
      case Alphabet::raw:
        sample = bytes.raw<T>();
        break;
      case Alphabet::specials:
        sample = special<T>(bytes.byte() % 16, one.isovalue);
        break;
    }
    std::memcpy(one.samples.data() + n * sizeof(T), &sample, sizeof(T));
    one.values[n] = static_cast<double>(sample);
  }
}

double finite_or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

double decode_isovalue(ByteReader& bytes) {
  switch (bytes.below(6)) {
    case 0:
      return 0.0;
    case 1:
      return 64.0 + bytes.below(64);
    case 2:
      return 64.5 + bytes.below(64);
    case 3:
      return bytes.raw<std::int8_t>();
    case 4:
      return finite_or_zero(bytes.raw<float>());
    default:
      return finite_or_zero(bytes.raw<double>());
  }
}

void decode_dims(ByteReader& bytes, ZmcCase& one) {
  // Rows round the widths of words; other axes short, so that a case takes milliseconds.
  one.dims = {2 + bytes.below(140), 2 + bytes.below(12), 2 + bytes.below(12)};
  // More samples, rarely: with fewer than 4096 the library does not share the work.
  const int size = bytes.below(64);
  const std::int64_t most = size == 0 ? 4500 : size < 8 ? 800 : 200;
  while (one.dims[0] * one.dims[1] * one.dims[2] > most) {
    auto& longest = one.dims[1] >= one.dims[2] ? one.dims[1] : one.dims[2];
    if (longest > 2) {
      --longest;
    } else {
      one.dims[0] -= 1;
    }
  }
}

}  // namespace

ZmcCase decode_zmc_case(const std::uint8_t* data, std::size_t size) {
  ByteReader bytes(data, size);
  ZmcCase one;
  decode_dims(bytes, one);
  one.type = static_cast<SampleType>(bytes.below(7));
  const auto alphabet = static_cast<Alphabet>(bytes.below(4));
  zmc::Options& options = one.options;
  const unsigned choices = bytes.byte();
  options.inside = (choices & 1) != 0 ? zmc::Inside::above : zmc::Inside::below;
  options.ties = (choices & 2) != 0 ? zmc::TieRule::positive : zmc::TieRule::neutral;
  options.triangulation =
      (choices & 4) != 0 ? zmc::Triangulation::centroid : zmc::Triangulation::compact;
  options.zero_faces = (choices & 8) != 0 ? zmc::ZeroFaces::mating : zmc::ZeroFaces::boundary;
  options.border = (choices & 16) != 0 ? zmc::Border::capped : zmc::Border::open;
  options.non_finite = (choices & 32) != 0 ? zmc::NonFinite::error : zmc::NonFinite::mask;
  one.mirrored = (choices & 64) != 0;
  options.count_nonmanifold = (choices & 128) != 0;
  options.threads = 1 + bytes.below(3);
  one.instruction_set = static_cast<zmc::InstructionSet>(bytes.below(3));
  one.planes_per_slab = bytes.below(8);
  one.layout = bytes.below(48);
  one.gap = static_cast<std::size_t>(bytes.below(3));
  one.contour_axis = bytes.below(3);
  one.contour_slice = bytes.byte() % one.dims[static_cast<std::size_t>(one.contour_axis)];
  one.isovalue = decode_isovalue(bytes);
  one.second_isovalue = decode_isovalue(bytes);
  bytes.mark();
  visit(one.type, [&](auto sample) { fill<decltype(sample)>(bytes, alphabet, one); });
  return one;
}

zmc::VolumeView ZmcCase::view() const {
  zmc::VolumeView view;
  view.data = samples.data();
  view.type = type;
  view.dims = dims;
  return view;
}

bool ZmcCase::finite() const {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool ZmcCase::ordinary() const {
  return std::all_of(values.begin(), values.end(), [&](double v) {
    const double distance = std::abs(v - isovalue);
    return !std::isfinite(v) || distance == 0.0 || (distance > 0x1p-400 && distance < 0x1p400);
  });
}

std::string ZmcCase::text() const {
  std::string text;
  for (const std::int64_t n : dims) text += (text.empty() ? "" : " x ") + std::to_string(n);
  text += " " + std::string(zmc::to_string(type)) + ", isovalue " + std::to_string(isovalue);
  text += options.inside == zmc::Inside::below ? ", below" : ", above";
  text += options.ties == zmc::TieRule::neutral ? ", neutral" : ", positive";
  text += options.triangulation == zmc::Triangulation::compact ? ", compact" : ", centroid";
  text += options.zero_faces == zmc::ZeroFaces::boundary ? ", boundary" : ", mating";
  text += options.border == zmc::Border::open ? ", open" : ", capped";
  text += options.non_finite == zmc::NonFinite::error ? ", error" : ", mask";
  text += ", threads " + std::to_string(options.threads);
  text += ", " + std::string(zmc::to_string(instruction_set));
  text += ", planes " + std::to_string(planes_per_slab);
  return text;
}

Strided strided(const ZmcCase& one) {
  // Permutation of the axes from the layout's first part, directions from its last three bits.
  static constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  const auto& order = kOrders[static_cast<std::size_t>(one.layout / 8)];
  Strided result;
  result.view = one.view();
  std::int64_t step = 1 + static_cast<std::int64_t>(one.gap);
  std::int64_t first = 0;
  for (const std::size_t axis : order) {
    const bool backwards = (one.layout >> axis & 1) != 0;
    result.view.strides[axis] = backwards ? -step : step;
    if (backwards) first += step * (one.dims[axis] - 1);
    step *= one.dims[axis];
  }
  const std::size_t width = zmc::sample_size(one.type);
  // Foreign samples are not finite, or at the end of their type.
  result.memory.assign(static_cast<std::size_t>(step) * width, std::byte{0xff});
  std::size_t from = 0;
  for (std::int64_t k = 0; k < one.dims[2]; ++k) {
    for (std::int64_t j = 0; j < one.dims[1]; ++j) {
      for (std::int64_t i = 0; i < one.dims[0]; ++i, ++from) {
        const std::int64_t to = first + i * result.view.strides[0] + j * result.view.strides[1] +
                                k * result.view.strides[2];
        std::memcpy(result.memory.data() + static_cast<std::size_t>(to) * width,
                    one.samples.data() + from * width, width);
      }
    }
  }
  result.view.data = result.memory.data() + static_cast<std::size_t>(first) * width;
  return result;
}

}  // namespace shape3d::fuzz
