#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "error.hpp"
#include "feature_formats.hpp"
#include "text.hpp"

// NumPy's format: magic, version, length of the header, the header (a Python literal), the rows.
// Numbers are little endian.
namespace shape3d::apps::formats {
namespace {

constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);

// Python keeps bytes of a path that are no UTF-8 as these code points.
constexpr std::uint32_t kEscape = 0xDC00;

std::vector<std::uint32_t> code_points(const std::string& text) {
  std::vector<std::uint32_t> points;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80   ? 1
                               : lead < 0xC2 ? 0
                               : lead < 0xE0 ? 2
                               : lead < 0xF0 ? 3
                               : lead < 0xF5 ? 4
                                             : 0;
    std::uint32_t point = length == 1 ? lead : lead & (0x7Fu >> length);
    bool good = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; good && k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      good = (next & 0xC0u) == 0x80u;
      point = (point << 6) | (next & 0x3Fu);
    }
    good = good && (length < 3 || point >= (length == 3 ? 0x800u : 0x10000u)) &&
           point <= 0x10FFFF && (point < 0xD800 || point > 0xDFFF);
    points.push_back(good ? point : kEscape + lead);
    i += good ? length : 1;
  }
  return points;
}

void append_utf8(std::string& text, std::uint32_t point) {
  if (point >= kEscape + 0x80 && point <= kEscape + 0xFF) {
    text += static_cast<char>(point - kEscape);
  } else if (point < 0x80) {
    text += static_cast<char>(point);
  } else if (point < 0x800) {
    text += static_cast<char>(0xC0 | (point >> 6));
    text += static_cast<char>(0x80 | (point & 0x3F));
  } else if (point < 0x10000) {
    text += static_cast<char>(0xE0 | (point >> 12));
    text += static_cast<char>(0x80 | ((point >> 6) & 0x3F));
    text += static_cast<char>(0x80 | (point & 0x3F));
  } else {
    text += static_cast<char>(0xF0 | (point >> 18));
    text += static_cast<char>(0x80 | ((point >> 12) & 0x3F));
    text += static_cast<char>(0x80 | ((point >> 6) & 0x3F));
    text += static_cast<char>(0x80 | (point & 0x3F));
  }
}

// Texts of one length, the longest.
struct TextColumn {
  std::vector<std::vector<std::uint32_t>> texts;
  std::size_t longest = 1;

  void add(const std::string& text) {
    texts.push_back(code_points(text));
    longest = std::max(longest, texts.back().size());
  }
  void write(OutputFile& file, std::size_t row) {
    texts[row].resize(longest, 0);
    file.write(texts[row].data(), longest * sizeof(std::uint32_t));
  }
};

// The words of the header: quoted texts and numbers.
std::vector<std::string_view> words_of(std::string_view header) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < header.size(); ++i) {
    std::size_t end = i;
    if (header[i] == '\'') {
      end = std::min(header.find('\'', i + 1), header.size());
      words.push_back(header.substr(i + 1, end - i - 1));
      i = end;
    } else if (header[i] >= '0' && header[i] <= '9') {
      while (end < header.size() && header[end] >= '0' && header[end] <= '9') ++end;
      words.push_back(header.substr(i, end - i));
      i = end - 1;
    }
  }
  return words;
}

template <class Number>
Number number_at(const char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

std::string take_text(const char*& at, std::uint64_t characters) {
  std::string text;
  for (std::uint64_t i = 0; i < characters; ++i, at += 4) {
    const auto point = number_at<std::uint32_t>(at);
    if (point != 0) append_utf8(text, point);
  }
  return text;
}

[[noreturn]] void refuse(const std::string& path) {
  throw FileError(
      path,
      "is not a table of 'shape3d describe': expected a structured NumPy array with the "
      "fields file, size, mtime and vectors");
}

}  // namespace

void write_npy(OutputFile& file, const FeatureTable& table) {
  TextColumn names, classes;
  for (const FeatureFile& entry : table.files) names.add(entry.path);
  for (const std::string& name : table.classes) classes.add(name);
  std::string header = "{'descr': [('file', '<U" + std::to_string(names.longest) +
                       "'), ('size', '<u8'), ('mtime', '<i8')";
  if (!table.classes.empty()) {
    header += ", ('class', '<U" + std::to_string(classes.longest) + "')";
  }
  for (const FeatureSet& set : table.sets) {
    header += ", ('" + set.spec + "', '<f8', (" + std::to_string(set.vectors.cols()) + ",))";
  }
  header += "], 'fortran_order': False, 'shape': (" + std::to_string(table.files.size()) + ",), }";
  // The rows begin at a multiple of 64; version 1 has two bytes for the length, version 2 four.
  const bool large = header.size() + 74 > 65535;
  const std::size_t before = large ? 12 : 10;
  header.append(63 - (before + header.size()) % 64, ' ');
  header += '\n';
  std::string magic(kMagic);
  magic[6] = large ? 2 : 1;
  file.write(magic);
  for (std::size_t i = 0; i < before - 8; ++i) {
    file.write_char(static_cast<char>((header.size() >> (8 * i)) & 0xFF));
  }
  file.write(header);
  for (std::size_t row = 0; row < table.files.size(); ++row) {
    names.write(file, row);
    file.write_binary(table.files[row].size);
    file.write_binary(table.files[row].time);
    if (!table.classes.empty()) classes.write(file, row);
    for (const FeatureSet& set : table.sets) {
      file.write(set.vectors.data() + static_cast<std::ptrdiff_t>(row) * set.vectors.cols(),
                 static_cast<std::size_t>(set.vectors.cols()) * sizeof(double));
    }
  }
}

FeatureTable parse_npy(std::string_view bytes, const std::string& path) {
  if (bytes.size() < 12 || bytes.substr(0, 6) != kMagic.substr(0, 6)) refuse(path);
  const std::size_t before = bytes[6] == 1 ? 10 : 12;
  std::size_t length = 0;
  for (std::size_t i = before; i-- > 8;) {
    length = (length << 8) | static_cast<unsigned char>(bytes[i]);
  }
  if (length > bytes.size() - before) refuse(path);
  const std::vector<std::string_view> words = words_of(bytes.substr(before, length));
  bytes.remove_prefix(before + length);

  // descr file <Un size <u8 mtime <i8 [SPEC <f8 length]… fortran_order shape rows
  if (words.size() < 10 || words[0] != "descr" || words[1] != "file" || words[2].size() < 3 ||
      words[2].substr(0, 2) != "<U" || words[3] != "size" || words[4] != "<u8" ||
      words[5] != "mtime" || words[6] != "<i8") {
    refuse(path);
  }
  // After mtime there may be class <Un.
  std::optional<std::uint64_t> class_characters;
  std::size_t first = 7;
  if (words[7] == "class" && words[8].substr(0, 2) == "<U") {
    class_characters = parse_unsigned(words[8].substr(2));
    if (!class_characters || *class_characters > 1u << 20) refuse(path);
    first = 9;
  }
  const std::size_t end = words.size() - 3;
  const auto characters = parse_unsigned(words[2].substr(2)), rows = parse_unsigned(words.back());
  if (words[end] != "fortran_order" || words[end + 1] != "shape" || end < first ||
      (end - first) % 3 != 0 || !characters || !rows || *characters > 1u << 20) {
    refuse(path);
  }
  FeatureTable table;
  std::vector<std::uint64_t> lengths;
  std::uint64_t stride = 4 * *characters + 16 + 4 * class_characters.value_or(0);
  for (std::size_t i = first; i < end; i += 3) {
    const auto numbers = parse_unsigned(words[i + 2]);
    if (words[i + 1] != "<f8" || !numbers || *numbers == 0 || *numbers > 1u << 24) refuse(path);
    table.sets.push_back({std::string(words[i]), {}});
    lengths.push_back(*numbers);
    stride += 8 * *numbers;
  }
  if (*rows > bytes.size() / stride || *rows * stride != bytes.size()) {
    throw FileError(path, "has " + std::to_string(bytes.size()) + " bytes of rows, expected " +
                              std::to_string(*rows) + " rows of " + std::to_string(stride));
  }
  for (std::size_t s = 0; s < lengths.size(); ++s) {
    table.sets[s].vectors.resize(static_cast<Eigen::Index>(*rows),
                                 static_cast<Eigen::Index>(lengths[s]));
  }
  const char* at = bytes.data();
  for (std::uint64_t row = 0; row < *rows; ++row) {
    FeatureFile entry;
    entry.path = take_text(at, *characters);
    entry.size = number_at<std::uint64_t>(at);
    entry.time = number_at<std::int64_t>(at + 8);
    at += 16;
    table.files.push_back(entry);
    if (class_characters) table.classes.push_back(take_text(at, *class_characters));
    for (std::size_t s = 0; s < lengths.size(); ++s) {
      const std::size_t size = static_cast<std::size_t>(lengths[s]) * sizeof(double);
      std::memcpy(table.sets[s].vectors.row(static_cast<Eigen::Index>(row)).data(), at, size);
      at += size;
    }
  }
  return table;
}

}  // namespace shape3d::apps::formats
