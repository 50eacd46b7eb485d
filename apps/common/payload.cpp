#include "payload.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "error.hpp"
#include "memory_limit.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

constexpr bool kHostIsBigEndian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

// Deflate codes at most 258 bytes in two bits: no stream holds more than this many times its size.
constexpr std::uint64_t kMostExpansion = 1032;

std::string count_text(std::uint64_t bytes) {
  return std::to_string(bytes) + (bytes == 1 ? " byte" : " bytes");
}

// Byte behind `lines` line ends.
std::uint64_t skip_lines(const std::filesystem::path& path, std::uint64_t offset,
                         std::int64_t lines) {
  FileSource source(path, offset);
  std::array<char, 4096> buffer{};
  std::uint64_t position = offset;
  while (lines > 0) {
    const std::size_t got = source.read(buffer.data(), buffer.size());
    for (std::size_t index = 0; index < got && lines > 0; ++index) {
      ++position;
      if (buffer[index] == '\n') --lines;
    }
    if (got < buffer.size() && lines > 0) {
      throw FileError(path, "ends inside the lines before the data; the header skips " +
                                std::to_string(lines) + " more");
    }
  }
  return position;
}

// One data file: its place and what it must hold.
struct Part {
  std::filesystem::path path;
  std::uint64_t offset = 0;  ///< First byte of the data as stored.
  std::uint64_t size = 0;    ///< Bytes of the file.
  std::uint64_t bytes = 0;   ///< Decoded bytes it must hold.
};

Part make_part(const Payload& payload, const std::filesystem::path& path, std::uint64_t bytes) {
  Part part;
  part.path = path;
  part.size = readable_size(path);
  part.bytes = bytes;
  if (payload.byte_skip == Payload::kAtEnd) {
    if (part.size < bytes) {
      throw FileError(path, "is " + count_text(part.size) + " long; the header needs " +
                                count_text(bytes) + " of data at its end");
    }
    part.offset = part.size - bytes;
    return part;
  }
  part.offset = skip_lines(path, 0, payload.line_skip);
  const auto skip = static_cast<std::uint64_t>(payload.byte_skip);
  if (skip > part.size - std::min(part.size, part.offset)) {
    throw FileError(path, "is " + count_text(part.size) + " long; its data begin at byte " +
                              std::to_string(part.offset + skip) + ", says the header");
  }
  part.offset += skip;
  return part;
}

// Whether the file can hold the data, as far as its length tells.
void check_length(const Part& part, const Payload& payload, StoredType type) {
  const std::uint64_t held = part.size - part.offset;
  const std::string found = "holds " + count_text(held) + " of ";
  switch (payload.encoding) {
    case Encoding::raw:
      if (held == part.bytes) return;
      throw FileError(part.path,
                      found + "data; expected " + count_text(part.bytes) + ", says the header");
    case Encoding::compressed:
      if ((part.bytes + static_cast<std::uint64_t>(payload.stream_skip)) / kMostExpansion <= held)
        return;
      throw FileError(part.path, found + "compressed data; they cannot hold the " +
                                     count_text(part.bytes) + " the header says");
    case Encoding::text: {
      // A digit each and a separator between two.
      const std::uint64_t values = part.bytes / sample_size(type);
      if (held / 2 + 1 >= values) return;
      throw FileError(part.path, found + "text; expected " + std::to_string(values) +
                                     " numbers, says the header");
    }
  }
}

void read_compressed(const Part& part, std::int64_t skip, std::byte* out) {
  InflateSource source(std::make_unique<FileSource>(part.path, part.offset), part.path);
  const auto fail = [&](std::uint64_t found) {
    const std::string cause = source.truncated() ? "compressed data are cut off: " : "";
    throw FileError(part.path, cause + "found " + count_text(found) + " of data; expected " +
                                   count_text(part.bytes) + ", says the header");
  };
  std::array<char, 4096> skipped{};
  for (auto left = static_cast<std::uint64_t>(skip); left > 0;) {
    const std::size_t wanted = std::min<std::uint64_t>(left, skipped.size());
    if (source.read(skipped.data(), wanted) < wanted) fail(0);
    left -= wanted;
  }
  const std::size_t got = source.read(out, part.bytes);
  if (got < part.bytes) fail(got);
  // Reaching the end also checks the stream's sum.
  if (source.read(skipped.data(), 1) > 0) {
    throw FileError(part.path, "compressed data hold more than the " + count_text(part.bytes) +
                                   " the header says");
  }
  if (source.truncated()) throw FileError(part.path, "compressed data are cut off at their end");
}

void read_part(const Part& part, const Payload& payload, StoredType type, std::byte* out) {
  if (payload.encoding == Encoding::compressed) {
    read_compressed(part, payload.stream_skip, out);
    return;
  }
  FileSource source(part.path, part.offset);
  if (payload.encoding == Encoding::text) {
    read_text_samples(source, type, part.bytes / sample_size(type), out, part.path);
  } else if (source.read(out, part.bytes) < part.bytes) {
    throw FileError(part.path, "became shorter while it was read");
  }
}

// Words of a text, one by one, in a bounded buffer.
class Words {
 public:
  explicit Words(ByteSource& source) : source_(source) {}

  // Empty at the end. The view is good until the next call.
  std::string_view next() {
    word_.clear();
    while (true) {
      if (position_ == filled_) {
        filled_ = source_.read(buffer_.data(), buffer_.size());
        position_ = 0;
        if (filled_ == 0) return word_;
      }
      const char c = buffer_[position_++];
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',') {
        if (!word_.empty()) return word_;
      } else if (word_.size() < kLongest) {
        word_ += c;
      } else {
        return word_;
      }
    }
  }

 private:
  static constexpr std::size_t kLongest = 400;
  ByteSource& source_;
  std::array<char, 1 << 16> buffer_{};
  std::size_t position_ = 0;
  std::size_t filled_ = 0;
  std::string word_;
};

template <class T>
void store(T value, std::byte* out) {
  std::memcpy(out, &value, sizeof(T));
}

// False when the text is no number of this type.
template <class T>
bool store_text(std::string_view word, std::byte* out) {
  if constexpr (std::is_floating_point_v<T>) {
    const std::optional<double> value = parse_real(word);
    if (!value) return false;
    if (std::isfinite(*value) &&
        std::abs(*value) > static_cast<double>(std::numeric_limits<T>::max())) {
      return false;
    }
    store(static_cast<T>(*value), out);
    return true;
  } else if constexpr (std::is_same_v<T, std::uint64_t>) {
    const std::optional<std::uint64_t> value = parse_unsigned(word);
    if (value) store(*value, out);
    return value.has_value();
  } else {
    const std::optional<std::int64_t> value = parse_integer(word);
    if (!value || *value < static_cast<std::int64_t>(std::numeric_limits<T>::min()) ||
        *value > static_cast<std::int64_t>(std::numeric_limits<T>::max())) {
      return false;
    }
    store(static_cast<T>(*value), out);
    return true;
  }
}

using StoreText = bool (*)(std::string_view, std::byte*);

StoreText text_store(StoredType type) {
  switch (type) {
    case StoredType::int8:
      return store_text<std::int8_t>;
    case StoredType::uint8:
      return store_text<std::uint8_t>;
    case StoredType::int16:
      return store_text<std::int16_t>;
    case StoredType::uint16:
      return store_text<std::uint16_t>;
    case StoredType::int32:
      return store_text<std::int32_t>;
    case StoredType::uint32:
      return store_text<std::uint32_t>;
    case StoredType::int64:
      return store_text<std::int64_t>;
    case StoredType::uint64:
      return store_text<std::uint64_t>;
    case StoredType::float32:
      return store_text<float>;
    case StoredType::float64:
      break;
  }
  return store_text<double>;
}

}  // namespace

void read_text_samples(ByteSource& source, StoredType type, std::uint64_t count, std::byte* out,
                       const std::filesystem::path& path) {
  Words words(source);
  const StoreText store_word = text_store(type);
  const std::size_t size = sample_size(type);
  for (std::uint64_t index = 0; index < count; ++index) {
    const std::string_view word = words.next();
    if (word.empty()) {
      throw FileError(path, "holds " + std::to_string(index) + " numbers; expected " +
                                std::to_string(count) + ", says the header");
    }
    if (!store_word(word, out + index * size)) {
      throw FileError(path, "number " + std::to_string(index + 1) + " is " + in_quotes(word) +
                                "; expected " + std::string(to_string(type)));
    }
  }
  const std::string_view more = words.next();
  if (!more.empty()) {
    throw FileError(path, "goes on with " + in_quotes(more) + " after the " +
                              std::to_string(count) + " numbers the header says");
  }
}

std::vector<std::byte> read_payload(const VolumeHeader& header,
                                    const std::filesystem::path& header_path,
                                    std::uint64_t memory_limit) {
  const Payload& payload = header.payload;
  const std::uint64_t bytes = payload_bytes(header);
  std::vector<std::filesystem::path> files;
  for (const std::string& name : payload.files) files.push_back(header_path.parent_path() / name);
  if (files.empty()) files.push_back(header_path);
  const std::uint64_t samples = bytes / sample_size(header.type);
  if (samples % files.size() != 0) {
    throw FileError(header_path, std::to_string(files.size()) + " data files cannot share " +
                                     std::to_string(samples) + " samples equally");
  }
  std::vector<Part> parts;
  for (const std::filesystem::path& file : files) {
    parts.push_back(make_part(payload, file, bytes / files.size()));
    check_length(parts.back(), payload, header.type);
  }
  require_memory(header_path, bytes, memory_limit, samples_text(header.dims, header.type));
  std::vector<std::byte> result(bytes);
  std::byte* out = result.data();
  for (const Part& part : parts) {
    read_part(part, payload, header.type, out);
    out += part.bytes;
  }
  if (payload.encoding != Encoding::text && payload.big_endian != kHostIsBigEndian) {
    swap_bytes(result, sample_size(header.type));
  }
  return result;
}

Volume make_volume(VolumeHeader header, TypedSamples samples) {
  Volume volume;
  volume.samples = std::move(samples.bytes);
  volume.view.data = volume.samples.data();
  volume.view.type = samples.type;
  volume.view.dims = header.dims;
  volume.view.spacing = header.spacing;
  volume.view.origin = header.origin;
  volume.view.direction = header.direction;
  volume.format = std::move(header.format);
  volume.warnings = std::move(header.warnings);
  return volume;
}

Volume load_volume(VolumeHeader header, const std::filesystem::path& header_path,
                   std::uint64_t memory_limit) {
  check_header(header, header_path);
  TypedSamples samples =
      convert_samples(read_payload(header, header_path, memory_limit), header.type,
                      {{header.slope, header.intercept}}, header_path, memory_limit);
  return make_volume(std::move(header), std::move(samples));
}

}  // namespace shape3d::apps
