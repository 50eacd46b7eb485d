#include "vti_arrays.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "byte_source.hpp"
#include "error.hpp"
#include "payload.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

// The text of a file from a position to the next tag.
class TextSource final : public ByteSource {
 public:
  TextSource(const std::filesystem::path& path, std::uint64_t position) : file_(path, position) {}

  std::size_t read(void* out, std::size_t count) override {
    if (ended_) return 0;
    const std::size_t got = file_.read(out, count);
    const std::string_view text(static_cast<const char*>(out), got);
    const std::size_t tag = text.find('<');
    ended_ = got < count || tag != std::string_view::npos;
    return std::min(tag, got);
  }

 private:
  FileSource file_;
  bool ended_ = false;
};

// Six bits of a base64 digit; −1 for other characters.
int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

// What base64 text stands for, up to its padding or the first character that is no digit.
class Base64Source final : public ByteSource {
 public:
  explicit Base64Source(std::unique_ptr<ByteSource> text) : text_(std::move(text)) {}

  std::size_t read(void* out, std::size_t count) override {
    auto* bytes = static_cast<unsigned char*>(out);
    std::size_t done = 0;
    while (done < count) {
      char c = 0;
      if (ended_ || text_->read(&c, 1) == 0) break;
      if (is_blank(c)) continue;
      const int digit = base64_digit(c);
      ended_ = digit < 0;
      if (ended_) break;
      bits_ = (bits_ << 6 | static_cast<unsigned>(digit)) & 0xffffU;
      filled_ += 6;
      if (filled_ < 8) continue;
      filled_ -= 8;
      bytes[done++] = static_cast<unsigned char>(bits_ >> filled_ & 0xffU);
    }
    return done;
  }

 private:
  std::unique_ptr<ByteSource> text_;
  unsigned bits_ = 0;
  unsigned filled_ = 0;
  bool ended_ = false;
};

std::uint64_t base64_digits(std::uint64_t bytes) { return (bytes + 2) / 3 * 4; }

// One array of one piece.
class ArrayCheck {
 public:
  ArrayCheck(const VtiLayout& layout, const VtiPiece& piece, const VtiArray& array,
             const std::filesystem::path& path)
      : layout_(layout), array_(array), path_(path), file_bytes_(readable_size(path)) {
    expected_ = sample_size(layout.header.type);
    for (std::size_t n = 0; n < 3; ++n) {
      expected_ *= static_cast<std::uint64_t>(piece.extent[2 * n + 1] - piece.extent[2 * n] + 1);
    }
    appended_ = array.form == VtiForm::appended;
    base64_ = !appended_ || !layout.appended_raw;
    if (array.position > file_bytes_) throw cut_off();
    start_ = array.position + (appended_ ? layout.appended_at : 0);
    if (start_ > file_bytes_) throw cut_off();
  }

  void run() {
    if (array_.form == VtiForm::text) {
      check_text();
    } else {
      check_binary();
    }
  }

 private:
  [[nodiscard]] std::string name() const { return "array " + in_quotes(array_.name); }

  [[nodiscard]] FileError cut_off() const {
    return FileError(path_, "is cut off: " + name() + " begins at byte " +
                                std::to_string(layout_.appended_at + array_.position) + " of " +
                                std::to_string(file_bytes_));
  }

  void check_text() {
    const std::uint64_t count = expected_ / sample_size(layout_.header.type);
    if ((file_bytes_ - start_) / 2 + 1 < count) throw cut_off();
    std::vector<std::byte> scratch(expected_);
    TextSource text(path_, start_);
    read_text_samples(text, layout_.header.type, count, scratch.data(), path_);
  }

  std::unique_ptr<ByteSource> open() const {
    if (!base64_) return std::make_unique<FileSource>(path_, start_);
    return std::make_unique<Base64Source>(std::make_unique<TextSource>(path_, start_));
  }

  std::uint64_t next_word(ByteSource& source) const {
    std::array<unsigned char, 8> bytes{};
    if (source.read(bytes.data(), layout_.word) < layout_.word) throw cut_off();
    std::uint64_t word = 0;
    for (std::size_t n = 0; n < layout_.word; ++n) {
      word = word << 8 | bytes[layout_.big_endian ? n : layout_.word - 1 - n];
    }
    return word;
  }

  // The length words: of the data, or number of blocks, size of a block, size of the last (0 when
  // it is full) and compressed size of each.
  void check_binary() {
    const std::unique_ptr<ByteSource> source = open();
    const std::uint64_t first = next_word(*source);
    if (!layout_.compressed) {
      check_decoded(first);
      // Base64 runs through from the length to the data.
      check_stored(base64_ ? base64_digits(layout_.word + first) : layout_.word + first);
      return;
    }
    const std::uint64_t block = next_word(*source);
    const std::uint64_t last = next_word(*source);
    if (first > (file_bytes_ - start_) / layout_.word) throw cut_off();
    std::uint64_t decoded = 0;
    if (__builtin_mul_overflow(first, block, &decoded) ||
        (last > 0 && (first == 0 || last > block))) {
      throw FileError(path_, name() + " has impossible block lengths");
    }
    check_decoded(last > 0 ? decoded - (block - last) : decoded);
    std::uint64_t stored = 0;
    for (std::uint64_t n = 0; n < first; ++n) {
      const std::uint64_t size = next_word(*source);
      if (size > file_bytes_) throw cut_off();
      stored += size;
    }
    // Base64 begins anew after the lengths.
    const std::uint64_t lengths = (3 + first) * layout_.word;
    check_stored(base64_ ? base64_digits(lengths) + base64_digits(stored) : lengths + stored);
  }

  void check_decoded(std::uint64_t decoded) const {
    if (decoded == expected_) return;
    throw FileError(path_, name() + " holds " + std::to_string(decoded) + " bytes; expected " +
                               std::to_string(expected_) + ", says the extent");
  }

  void check_stored(std::uint64_t needed) const {
    std::uint64_t found = file_bytes_ - start_;
    if (base64_) {
      TextSource text(path_, start_);
      std::array<char, 1 << 14> buffer{};
      std::uint64_t digits = 0;
      for (std::size_t got = 1; got > 0 && digits < needed;) {
        got = text.read(buffer.data(), buffer.size());
        digits += static_cast<std::uint64_t>(
            std::count_if(buffer.data(), buffer.data() + got,
                          [](char c) { return base64_digit(c) >= 0 || c == '='; }));
      }
      found = digits;
    }
    if (found >= needed) return;
    throw FileError(path_, "is cut off: " + name() + " has " + std::to_string(found) +
                               (base64_ ? " base64 digits" : " bytes") + " in the file; expected " +
                               std::to_string(needed));
  }

  const VtiLayout& layout_;
  const VtiArray& array_;
  const std::filesystem::path& path_;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t expected_ = 0;  ///< Decoded bytes.
  std::uint64_t start_ = 0;
  bool appended_ = false;
  bool base64_ = false;
};

}  // namespace

void check_vti_arrays(const VtiLayout& layout, const std::filesystem::path& path) {
  for (const VtiPiece& piece : layout.pieces) {
    for (const VtiArray& array : piece.arrays) {
      if (array.name == layout.scalars) ArrayCheck(layout, piece, array, path).run();
    }
  }
}

}  // namespace shape3d::apps
