#include "dicom_fragments.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "byte_source.hpp"

namespace shape3d::apps {
namespace {

constexpr const char* kRle = "1.2.840.10008.1.2.5";
constexpr std::size_t kRleHeader = 64;
constexpr std::size_t kMostSegments = 15;

std::uint32_t little_endian(const unsigned char* bytes) {
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8 |
         static_cast<std::uint32_t>(bytes[2]) << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

std::string read_bytes(const std::filesystem::path& path, std::uint64_t offset,
                       std::uint64_t count) {
  FileSource source(path, offset);
  std::string bytes(count, '\0');
  bytes.resize(source.read(bytes.data(), bytes.size()));
  return bytes;
}

// Bytes that a segment decodes to, at most `wanted`: runs and literals, as annex G.3 has them.
std::uint64_t decoded_length(std::string_view segment, std::uint64_t wanted) {
  std::uint64_t length = 0;
  std::size_t at = 0;
  while (at < segment.size() && length < wanted) {
    const auto code = static_cast<signed char>(segment[at++]);
    if (code == -128) continue;
    const std::size_t used = code >= 0 ? static_cast<std::size_t>(code) + 1 : 1;
    if (segment.size() - at < used) break;
    at += used;
    length += code >= 0 ? used : static_cast<std::size_t>(1 - code);
  }
  return length;
}

// A fragment is a frame: number of segments, their offsets, the segments.
std::string check_rle(std::string_view frame, const FrameSize& size) {
  if (frame.size() < kRleHeader)
    return "an RLE frame of " + std::to_string(frame.size()) + " bytes";
  const auto word = [&](std::size_t n) {
    std::array<unsigned char, 4> bytes{};
    std::copy_n(frame.begin() + static_cast<std::ptrdiff_t>(4 * n), 4, bytes.begin());
    return little_endian(bytes.data());
  };
  const std::uint32_t segments = word(0);
  if (segments != size.bytes_per_pixel || segments > kMostSegments) {
    return std::to_string(segments) + " RLE segments; expected " +
           std::to_string(size.bytes_per_pixel);
  }
  for (std::uint32_t n = 0; n < segments; ++n) {
    const std::uint64_t begin = word(n + 1);
    const std::uint64_t end = n + 1 < segments ? word(n + 2) : frame.size();
    if (begin < kRleHeader || begin > end || end > frame.size()) {
      return "an RLE segment from byte " + std::to_string(begin) + " to " + std::to_string(end) +
             " of " + std::to_string(frame.size());
    }
    const std::uint64_t length = decoded_length(frame.substr(begin, end - begin), size.pixels);
    if (length != size.pixels) {
      return "an RLE segment of " + std::to_string(length) + " bytes; expected " +
             std::to_string(size.pixels);
    }
  }
  return {};
}

bool begins_like_jpeg(std::string_view bytes) {
  // JPEG and JPEG-LS, a JPEG 2000 code stream, one in its file format.
  return bytes.substr(0, 2) == "\xff\xd8" || bytes.substr(0, 4) == "\xff\x4f\xff\x51" ||
         bytes.substr(4, 4) == "jP  ";
}

}  // namespace

std::optional<std::vector<Fragment>> find_fragments(const std::filesystem::path& path,
                                                    std::uint64_t offset) {
  const std::uint64_t size = readable_size(path);
  std::vector<Fragment> fragments;
  bool table = true;
  while (offset + 8 <= size) {
    FileSource source(path, offset);
    std::array<unsigned char, 8> item{};
    if (source.read(item.data(), item.size()) < item.size()) return std::nullopt;
    const std::uint32_t tag = little_endian(item.data());
    const std::uint64_t length = little_endian(item.data() + 4);
    offset += item.size();
    constexpr std::uint32_t kItem = 0xe000fffe;
    constexpr std::uint32_t kEnd = 0xe0ddfffe;
    if (tag == kEnd) return fragments;
    if (tag != kItem || length > size - offset) return std::nullopt;
    if (!table) fragments.push_back({offset, length});
    table = false;
    offset += length;
  }
  return std::nullopt;
}

std::string check_fragments(const std::filesystem::path& path, const std::string& transfer_syntax,
                            const std::vector<Fragment>& fragments, const FrameSize& size) {
  if (fragments.size() < size.frames) {
    return "holds " + std::to_string(fragments.size()) +
           " fragments of compressed pixel data; expected at "
           "least " +
           std::to_string(size.frames) + ", one for each frame";
  }
  if (transfer_syntax == kRle) {
    for (std::uint64_t n = 0; n < size.frames; ++n) {
      const std::string problem =
          check_rle(read_bytes(path, fragments[n].offset, fragments[n].size), size);
      if (!problem.empty()) return "its pixel data are damaged: they hold " + problem;
    }
  } else if (!begins_like_jpeg(read_bytes(path, fragments[0].offset,
                                          std::min<std::uint64_t>(fragments[0].size, 12)))) {
    return "its pixel data are damaged: they do not begin like JPEG";
  }
  return {};
}

}  // namespace shape3d::apps
