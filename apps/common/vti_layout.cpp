#include "vti_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "error.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

// Longest tag that is read.
constexpr std::size_t kLongestTag = 1 << 16;

struct Tag {
  std::string name;  ///< "/Piece" for an end tag.
  std::map<std::string, std::string, std::less<>> attributes;
  bool closed = false;  ///< <Name … />
};

std::string decoded(std::string_view text) {
  static constexpr std::pair<std::string_view, char> kEntities[] = {
      {"&quot;", '"'}, {"&apos;", '\''}, {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}};
  std::string result;
  while (!text.empty()) {
    const auto* entity =
        std::find_if(std::begin(kEntities), std::end(kEntities),
                     [&](const auto& e) { return text.substr(0, e.first.size()) == e.first; });
    if (entity != std::end(kEntities)) {
      result += entity->second;
      text.remove_prefix(entity->first.size());
    } else {
      result += text[0];
      text.remove_prefix(1);
    }
  }
  return result;
}

// The tags of an XML text, one by one; text between them is skipped.
class Tags {
 public:
  Tags(ByteSource& source, const std::filesystem::path& path) : source_(source), path_(path) {}

  std::optional<Tag> next() {
    while (true) {
      std::optional<char> c = get();
      while (c && *c != '<') c = get();
      if (!c) return std::nullopt;
      const std::string text = inside();
      if (text.empty() || text[0] == '?' || text[0] == '!') continue;
      return parse(text);
    }
  }

  /// Bytes read so far.
  [[nodiscard]] std::uint64_t position() const { return position_; }

  std::optional<char> get() {
    if (next_ == filled_) {
      filled_ = source_.read(buffer_.data(), buffer_.size());
      next_ = 0;
      if (filled_ == 0) return std::nullopt;
    }
    ++position_;
    return buffer_[next_++];
  }

 private:
  // Up to the '>' that ends the tag or comment.
  std::string inside() {
    std::string text;
    char quote = 0;
    while (const std::optional<char> c = get()) {
      const bool comment = text.substr(0, 3) == "!--";
      if (comment) {
        if (*c == '>' && text.size() >= 5 && text.substr(text.size() - 2) == "--") return text;
        // Only the end of a comment matters.
        if (text.size() > 64) text.erase(3, 32);
      } else if (quote != 0) {
        if (*c == quote) quote = 0;
      } else if (*c == '"' || *c == '\'') {
        quote = *c;
      } else if (*c == '>') {
        return text;
      }
      text += *c;
      if (text.size() > kLongestTag) throw FileError(path_, "has an XML tag of more than 64 KiB");
    }
    throw FileError(path_, "ends inside an XML tag");
  }

  Tag parse(std::string_view text) {
    Tag tag;
    const std::string whole(text);
    if (text.back() == '/') {
      tag.closed = true;
      text.remove_suffix(1);
    }
    const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
    tag.name = text.substr(0, end);
    text = trim(text.substr(end));
    while (!text.empty()) {
      const std::size_t equals = text.find('=');
      const std::string_view value =
          equals == std::string_view::npos ? std::string_view() : trim(text.substr(equals + 1));
      const std::size_t close = value.empty() || (value[0] != '"' && value[0] != '\'')
                                    ? std::string_view::npos
                                    : value.find(value[0], 1);
      if (close == std::string_view::npos) {
        throw FileError(path_, "XML tag " + in_quotes(whole) + "; expected name=\"value\" pairs");
      }
      tag.attributes[std::string(trim(text.substr(0, equals)))] =
          decoded(value.substr(1, close - 1));
      text = trim(value.substr(close + 1));
    }
    return tag;
  }

  ByteSource& source_;
  const std::filesystem::path& path_;
  std::array<char, 1 << 16> buffer_{};
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
  std::uint64_t position_ = 0;
};

class Reader {
 public:
  Reader(ByteSource& source, const std::filesystem::path& path)
      : path_(path), tags_(source, path) {}

  VtiLayout read() {
    bool in_points = false;
    bool ended = false;
    while (const std::optional<Tag> tag = tags_.next()) {
      if (!seen_file_ && tag->name != "VTKFile") {
        throw FileError(path_,
                        "begins with the XML tag " + in_quotes(tag->name) + "; expected VTKFile");
      }
      if (tag->name == "VTKFile") read_file(*tag);
      if (tag->name == "ImageData") read_image(*tag);
      if (tag->name == "Piece") read_piece(*tag);
      if (tag->name == "PointData" && !tag->closed) {
        in_points = true;
        if (layout_.scalars.empty()) layout_.scalars = get(*tag, "Scalars");
      }
      if (tag->name == "/PointData") in_points = false;
      if (tag->name == "DataArray" && in_points) read_array(*tag);
      if (tag->name == "/VTKFile") ended = true;
      if (tag->name == "AppendedData") {
        read_appended(*tag);
        ended = true;
        break;
      }
    }
    if (!seen_image_) throw FileError(path_, "holds no ImageData tag");
    if (!ended) throw FileError(path_, "is cut off: it ends before its last tag");
    check_header(layout_.header, path_);
    check_pieces();
    choose_array();
    check_header(layout_.header, path_);
    return std::move(layout_);
  }

 private:
  [[nodiscard]] static std::string get(const Tag& tag, std::string_view name) {
    const auto found = tag.attributes.find(name);
    return found == tag.attributes.end() ? std::string() : found->second;
  }

  [[nodiscard]] FileError bad(const Tag& tag, std::string_view name,
                              const std::string& expected) const {
    return FileError(path_, "attribute " + std::string(name) + " of " + tag.name + " is " +
                                in_quotes(get(tag, name)) + "; expected " + expected);
  }

  [[nodiscard]] std::vector<double> reals(const Tag& tag, std::string_view name, std::size_t count,
                                          const std::vector<double>& otherwise) const {
    if (tag.attributes.find(name) == tag.attributes.end()) return otherwise;
    const std::string text = get(tag, name);
    std::vector<double> values;
    for (const std::string_view word : split_words(text)) {
      const auto value = parse_real(word);
      if (!value) throw bad(tag, name, "numbers");
      values.push_back(*value);
    }
    if (values.size() != count) throw bad(tag, name, std::to_string(count) + " numbers");
    return values;
  }

  [[nodiscard]] Extent extent(const Tag& tag, std::string_view name) const {
    Extent result{};
    const std::string text = get(tag, name);
    const auto words = split_words(text);
    constexpr auto kMost = std::numeric_limits<std::int32_t>::max();
    for (std::size_t n = 0; n < 6; ++n) {
      const auto value = words.size() == 6 ? parse_integer(words[n]) : std::nullopt;
      if (!value || *value < -kMost || *value > kMost) throw bad(tag, name, "six 32-bit integers");
      result[n] = *value;
    }
    return result;
  }

  void read_file(const Tag& tag) {
    seen_file_ = true;
    if (get(tag, "type") != "ImageData") throw bad(tag, "type", "ImageData");
    const std::string order = get(tag, "byte_order");
    if (order != "LittleEndian" && order != "BigEndian" && !order.empty()) {
      throw bad(tag, "byte_order", "LittleEndian or BigEndian");
    }
    layout_.big_endian = order == "BigEndian";
    const std::string word = get(tag, "header_type");
    if (!word.empty() && word != "UInt32" && word != "UInt64") {
      throw bad(tag, "header_type", "UInt32 or UInt64");
    }
    layout_.word = word == "UInt64" ? 8 : 4;
    layout_.compressed = !get(tag, "compressor").empty();
  }

  void read_image(const Tag& tag) {
    if (std::exchange(seen_image_, true)) throw FileError(path_, "holds two ImageData tags");
    layout_.header.format = "VTI";
    layout_.extent = extent(tag, "WholeExtent");
    Eigen::Vector3d first;
    for (int n = 0; n < 3; ++n) {
      const auto axis = static_cast<std::size_t>(n);
      layout_.header.dims[axis] = layout_.extent[2 * axis + 1] - layout_.extent[2 * axis] + 1;
      first[n] = static_cast<double>(layout_.extent[2 * axis]);
    }
    const auto spacing = reals(tag, "Spacing", 3, {1.0, 1.0, 1.0});
    const auto origin = reals(tag, "Origin", 3, {0.0, 0.0, 0.0});
    const auto direction =
        reals(tag, "Direction", 9, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
    for (int row = 0; row < 3; ++row) {
      const auto n = static_cast<std::size_t>(row);
      layout_.header.spacing[row] = spacing[n];
      for (int col = 0; col < 3; ++col) {
        layout_.header.direction(row, col) = direction[3 * n + static_cast<std::size_t>(col)];
      }
    }
    // Directions are of unit length up to rounding, or the lengths belong to the spacing.
    for (int n = 0; n < 3; ++n) {
      const double length = layout_.header.direction.col(n).stableNorm();
      constexpr double kRounding = 1e-12;
      if (std::isfinite(length) && length > 0.0 && std::abs(length - 1.0) > kRounding) {
        layout_.header.direction.col(n) /= length;
        layout_.header.spacing[n] *= length;
      }
    }
    // VTK places sample (0, 0, 0) at the origin, whatever the extent.
    layout_.header.origin = Eigen::Vector3d(origin[0], origin[1], origin[2]) +
                            layout_.header.direction * layout_.header.spacing.cwiseProduct(first);
  }

  void read_piece(const Tag& tag) {
    if (!seen_image_) throw FileError(path_, "holds a Piece outside ImageData");
    VtiPiece piece;
    piece.extent = extent(tag, "Extent");
    layout_.pieces.push_back(std::move(piece));
  }

  void read_array(const Tag& tag) {
    if (layout_.pieces.empty()) throw FileError(path_, "holds PointData outside a Piece");
    VtiArray array;
    array.name = get(tag, "Name");
    array.type = get(tag, "type");
    const std::string components = get(tag, "NumberOfComponents");
    if (!components.empty()) {
      const auto value = parse_integer(components);
      if (!value) throw bad(tag, "NumberOfComponents", "an integer");
      array.components = *value;
    }
    const std::string format = get(tag, "format");
    array.position = tags_.position();
    if (format == "appended") {
      array.form = VtiForm::appended;
      const auto offset = parse_integer(trim(get(tag, "offset")));
      if (!offset || *offset < 0) throw bad(tag, "offset", "a number of bytes");
      array.position = static_cast<std::uint64_t>(*offset);
    } else if (format == "binary") {
      array.form = VtiForm::base64;
    } else if (format != "ascii" && !format.empty()) {
      throw bad(tag, "format", "ascii, binary or appended");
    }
    layout_.pieces.back().arrays.push_back(std::move(array));
  }

  // Data begin behind an underscore.
  void read_appended(const Tag& tag) {
    layout_.appended_raw = get(tag, "encoding") == "raw";
    std::optional<char> c = tags_.get();
    while (c && *c != '_') {
      if (*c != ' ' && *c != '\t' && *c != '\r' && *c != '\n') break;
      c = tags_.get();
    }
    if (!c || *c != '_')
      throw FileError(path_, "its appended data do not begin with an underscore");
    layout_.appended_at = tags_.position();
  }

  // Neighbouring pieces share the samples of a border, so that cells add up.
  void check_pieces() const {
    const auto cells = [](const Extent& e) {
      double product = 1.0;
      for (std::size_t n = 0; n < 3; ++n) product *= static_cast<double>(e[2 * n + 1] - e[2 * n]);
      return product;
    };
    double sum = 0.0;
    for (const VtiPiece& piece : layout_.pieces) {
      for (std::size_t n = 0; n < 3; ++n) {
        const std::int64_t lower = piece.extent[2 * n];
        const std::int64_t upper = piece.extent[2 * n + 1];
        if (lower > upper || lower < layout_.extent[2 * n] || upper > layout_.extent[2 * n + 1]) {
          throw FileError(path_, "a piece has samples " + std::to_string(lower) + " to " +
                                     std::to_string(upper) + " along axis " +
                                     std::to_string(n + 1) + "; the whole image has " +
                                     std::to_string(layout_.extent[2 * n]) + " to " +
                                     std::to_string(layout_.extent[2 * n + 1]));
        }
      }
      sum += cells(piece.extent);
    }
    if (layout_.pieces.empty()) throw FileError(path_, "holds no Piece");
    if (sum < cells(layout_.extent))
      throw FileError(path_, "its pieces do not fill the whole image");
  }

  void choose_array() {
    static const std::map<std::string_view, StoredType> kTypes{
        {"Int8", StoredType::int8},       {"UInt8", StoredType::uint8},
        {"Int16", StoredType::int16},     {"UInt16", StoredType::uint16},
        {"Int32", StoredType::int32},     {"UInt32", StoredType::uint32},
        {"Int64", StoredType::int64},     {"UInt64", StoredType::uint64},
        {"Float32", StoredType::float32}, {"Float64", StoredType::float64},
    };
    const std::vector<VtiArray>& arrays = layout_.pieces.front().arrays;
    if (arrays.empty()) throw FileError(path_, "holds no point data; expected an array of samples");
    if (layout_.scalars.empty() && arrays.size() == 1) layout_.scalars = arrays.front().name;
    if (layout_.scalars.empty()) {
      std::string names;
      for (const VtiArray& array : arrays)
        names += (names.empty() ? "" : ", ") + in_quotes(array.name);
      throw FileError(path_, "holds several arrays (" + names +
                                 ") and PointData does not say which are its Scalars");
    }
    for (const VtiPiece& piece : layout_.pieces) {
      const auto array = std::find_if(piece.arrays.begin(), piece.arrays.end(),
                                      [&](const VtiArray& a) { return a.name == layout_.scalars; });
      if (array == piece.arrays.end()) {
        throw FileError(path_, "a piece has no array " + in_quotes(layout_.scalars));
      }
      const auto type = kTypes.find(array->type);
      if (type == kTypes.end()) {
        throw FileError(path_, "array " + in_quotes(array->name) + " has type " +
                                   in_quotes(array->type) + "; expected Int8 to Float64");
      }
      if (array->components != 1) {
        throw FileError(path_, "array " + in_quotes(array->name) + " holds " +
                                   std::to_string(array->components) +
                                   " components a voxel; expected one");
      }
      if (&piece != &layout_.pieces.front() && type->second != layout_.header.type) {
        throw FileError(path_,
                        "array " + in_quotes(array->name) + " has different types in its pieces");
      }
      layout_.header.type = type->second;
    }
  }

  const std::filesystem::path& path_;
  Tags tags_;
  VtiLayout layout_;
  bool seen_file_ = false;
  bool seen_image_ = false;
};

}  // namespace

VtiLayout parse_vti(ByteSource& source, const std::filesystem::path& path) {
  return Reader(source, path).read();
}

}  // namespace shape3d::apps
