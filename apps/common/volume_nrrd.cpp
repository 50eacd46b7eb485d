#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "data_files.hpp"
#include "error.hpp"
#include "text.hpp"
#include "volume_header.hpp"

namespace shape3d::apps {
namespace {

using Fields = std::map<std::string, std::string, std::less<>>;

// The parts of a NRRD header.
struct Nrrd {
  Fields fields;                ///< Lower-case name without spaces → value.
  std::string_view after_list;  ///< What follows "data file: LIST".
  std::size_t size = 0;         ///< Bytes up to and with the empty line.
  bool ended = false;           ///< The empty line was there.
};

std::string field_name(std::string_view text) {
  std::string name = lower_case(trim(text));
  name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
  return name == "centers" ? "centerings" : name;
}

// A field name as the format's definition spells it.
std::string spelled(std::string_view name) {
  for (const std::string_view word : {"space", "axis", "line", "byte", "data"}) {
    if (name.size() > word.size() && name.substr(0, word.size()) == word && name != "spacings") {
      return std::string(word) + " " + std::string(name.substr(word.size()));
    }
  }
  return std::string(name);
}

Nrrd split(std::string_view bytes, const std::filesystem::path& path) {
  const std::string_view magic = bytes.substr(0, 8);
  if (magic.size() < 8 || magic.substr(0, 7) != "NRRD000" || magic[7] < '1' || magic[7] > '5') {
    throw FileError(path,
                    "begins with " + in_quotes(magic) + "; expected \"NRRD0001\" to \"NRRD0005\"");
  }
  Nrrd nrrd;
  bool first = true;
  while (nrrd.size < bytes.size()) {
    const std::size_t end = std::min(bytes.find('\n', nrrd.size), bytes.size());
    const std::string_view line = trim(bytes.substr(nrrd.size, end - nrrd.size));
    nrrd.size = std::min(end + 1, bytes.size());
    if (std::exchange(first, false)) continue;
    if (line.empty()) {
      nrrd.ended = true;
      break;
    }
    if (line[0] == '#') continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) {
      throw FileError(path, "header line " + in_quotes(line) + "; expected \"field: value\"");
    }
    // "key:=value" is free text.
    if (colon + 1 < line.size() && line[colon + 1] == '=') continue;
    const std::string name = field_name(line.substr(0, colon));
    const std::string_view value = trim(line.substr(colon + 1));
    if (!nrrd.fields.emplace(name, value).second) {
      throw FileError(path, "header has two fields " + in_quotes(name));
    }
    if (name == "datafile" && value.substr(0, 4) == "LIST") {
      nrrd.after_list = bytes.substr(nrrd.size);
      nrrd.ended = true;
      break;
    }
  }
  return nrrd;
}

// Reads the fields of one header.
class Reader {
 public:
  Reader(const Nrrd& nrrd, const std::filesystem::path& path) : nrrd_(nrrd), path_(path) {}

  VolumeHeader read() {
    header_.format = "NRRD";
    read_type();
    read_axes();
    read_place();
    read_payload();
    return std::move(header_);
  }

 private:
  [[nodiscard]] bool has(std::string_view name) const {
    return nrrd_.fields.find(name) != nrrd_.fields.end();
  }

  // Empty when the field is not there.
  [[nodiscard]] std::string_view get(std::string_view name) const {
    const auto found = nrrd_.fields.find(name);
    return found == nrrd_.fields.end() ? std::string_view() : std::string_view(found->second);
  }

  [[nodiscard]] FileError bad(std::string_view name, const std::string& expected) const {
    const std::string field = "field \"" + spelled(name) + "\"";
    if (!has(name)) return FileError(path_, "header has no " + field + "; expected " + expected);
    return FileError(path_, field + " is " + in_quotes(get(name)) + "; expected " + expected);
  }

  [[nodiscard]] std::int64_t integer(std::string_view name, std::int64_t otherwise) const {
    if (!has(name)) return otherwise;
    const auto value = parse_integer(get(name));
    if (!value) throw bad(name, "an integer");
    return *value;
  }

  // One word for each axis of the file; nothing when the field is not there.
  [[nodiscard]] std::vector<std::string_view> axis_words(std::string_view name) const {
    if (!has(name)) return {};
    std::vector<std::string_view> words = split_words(get(name));
    if (words.size() != rank_)
      throw bad(name, std::to_string(rank_) + " entries, one for each axis");
    return words;
  }

  void read_type() {
    static const std::map<std::string_view, StoredType> kTypes{
        {"signed char", StoredType::int8},
        {"int8", StoredType::int8},
        {"int8_t", StoredType::int8},
        {"uchar", StoredType::uint8},
        {"unsigned char", StoredType::uint8},
        {"uint8", StoredType::uint8},
        {"uint8_t", StoredType::uint8},
        {"short", StoredType::int16},
        {"short int", StoredType::int16},
        {"signed short", StoredType::int16},
        {"signed short int", StoredType::int16},
        {"int16", StoredType::int16},
        {"int16_t", StoredType::int16},
        {"ushort", StoredType::uint16},
        {"unsigned short", StoredType::uint16},
        {"unsigned short int", StoredType::uint16},
        {"uint16", StoredType::uint16},
        {"uint16_t", StoredType::uint16},
        {"int", StoredType::int32},
        {"signed int", StoredType::int32},
        {"int32", StoredType::int32},
        {"int32_t", StoredType::int32},
        {"uint", StoredType::uint32},
        {"unsigned int", StoredType::uint32},
        {"uint32", StoredType::uint32},
        {"uint32_t", StoredType::uint32},
        {"longlong", StoredType::int64},
        {"long long", StoredType::int64},
        {"long long int", StoredType::int64},
        {"signed long long", StoredType::int64},
        {"signed long long int", StoredType::int64},
        {"int64", StoredType::int64},
        {"int64_t", StoredType::int64},
        {"ulonglong", StoredType::uint64},
        {"unsigned long long", StoredType::uint64},
        {"unsigned long long int", StoredType::uint64},
        {"uint64", StoredType::uint64},
        {"uint64_t", StoredType::uint64},
        {"float", StoredType::float32},
        {"double", StoredType::float64},
    };
    const auto type = kTypes.find(lower_case(get("type")));
    if (type == kTypes.end()) throw bad("type", "a number type of 8 to 64 bits");
    header_.type = type->second;
  }

  // Which three axes of the file are those of space; the others must have length 1.
  void read_axes() {
    const std::int64_t rank = integer("dimension", 0);
    if (rank < 1 || rank > 16) throw bad("dimension", "3 or 4");
    rank_ = static_cast<std::size_t>(rank);
    std::vector<std::int64_t> sizes;
    for (const std::string_view word : axis_words("sizes")) {
      const auto size = parse_integer(word);
      if (!size) throw bad("sizes", "integers");
      sizes.push_back(*size);
    }
    if (sizes.empty()) throw bad("sizes", std::to_string(rank_) + " integers");

    const auto kinds = axis_words("kinds");
    read_directions();
    std::vector<bool> spatial(rank_, true);
    for (std::size_t axis = 0; axis < rank_; ++axis) {
      if (!directions_.empty()) {
        spatial[axis] = directions_[axis].has_value();
      } else if (!kinds.empty()) {
        const std::string kind = lower_case(kinds[axis]);
        spatial[axis] = kind == "domain" || kind == "space" || kind == "???" || kind == "none";
      }
    }
    // Axes of length 1 beyond the three say nothing.
    for (std::size_t axis = rank_; axis-- > 0;) {
      if (std::count(spatial.begin(), spatial.end(), true) <= 3) break;
      if (spatial[axis] && sizes[axis] == 1) spatial[axis] = false;
    }
    for (std::size_t axis = 0; axis < rank_; ++axis) {
      if (spatial[axis]) {
        axes_.push_back(axis);
      } else if (sizes[axis] != 1) {
        const std::string kind = kinds.empty() ? "" : lower_case(kinds[axis]);
        const bool frames = kind == "time" || kind == "list" || (axis > 0 && axis + 1 == rank_);
        throw FileError(path_, "holds " + std::to_string(sizes[axis]) +
                                   (frames ? " frames (4-D)" : " components a voxel") +
                                   "; expected one");
      }
    }
    if (axes_.size() > 3) {
      throw FileError(path_, "holds " + std::to_string(sizes[axes_[3]]) + " frames (" +
                                 std::to_string(axes_.size()) + "-D); expected one");
    }
    if (axes_.size() < 3) {
      throw FileError(path_,
                      "has " + std::to_string(axes_.size()) + " axes in space; a volume has three");
    }
    for (std::size_t n = 0; n < 3; ++n) header_.dims[n] = sizes[axes_[n]];
  }

  // "(1,0,0)".
  [[nodiscard]] std::optional<Eigen::Vector3d> vector(std::string_view text) const {
    text = trim(text);
    if (text.size() < 2 || text.front() != '(' || text.back() != ')') return std::nullopt;
    text = text.substr(1, text.size() - 2);
    Eigen::Vector3d result;
    for (int n = 0; n < 3; ++n) {
      const std::size_t comma = n < 2 ? text.find(',') : text.size();
      if (comma == std::string_view::npos) return std::nullopt;
      const auto number = parse_real(trim(text.substr(0, comma)));
      if (!number) return std::nullopt;
      result[n] = *number;
      text.remove_prefix(std::min(comma + 1, text.size()));
    }
    return result;
  }

  // A vector or "none" for each axis; blanks inside the parentheses are allowed.
  void read_directions() {
    if (!has("spacedirections")) return;
    std::string_view text = get("spacedirections");
    while (!(text = trim(text)).empty()) {
      if (text.substr(0, 4) == "none") {
        directions_.emplace_back(std::nullopt);
        text.remove_prefix(4);
        continue;
      }
      const std::size_t end = text.find(')');
      const auto direction =
          end == std::string_view::npos ? std::nullopt : vector(text.substr(0, end + 1));
      if (!direction) throw bad("spacedirections", "vectors of three numbers or \"none\"");
      directions_.emplace_back(direction);
      text.remove_prefix(end + 1);
    }
    if (directions_.size() != rank_) {
      throw bad("spacedirections", std::to_string(rank_) + " entries, one for each axis");
    }
  }

  // Signs that turn the file's world into LPS.
  Eigen::Vector3d world_signs() {
    std::string space = lower_case(get("space"));
    std::replace(space.begin(), space.end(), '_', '-');
    if (space.size() > 5 && space.substr(space.size() - 5) == "-time")
      space.resize(space.size() - 5);
    if (space == "right-anterior-superior" || space == "ras" || space == "rast")
      return {-1.0, -1.0, 1.0};
    if (space == "left-anterior-superior" || space == "las" || space == "last")
      return {1.0, -1.0, 1.0};
    if (space == "left-posterior-superior" || space == "lps" || space == "lpst")
      return {1.0, 1.0, 1.0};
    if (space == "scanner-xyz" || space == "3d-right-handed" || space == "3d-left-handed") {
      header_.warnings.push_back("space " + in_quotes(get("space")) +
                                 " does not say where the patient's left is: taken for LPS");
    } else if (!space.empty()) {
      throw bad("space", "LPS, RAS or LAS");
    } else if (has("spacedimension") && integer("spacedimension", 3) != 3) {
      throw bad("spacedimension", "3");
    }
    return {1.0, 1.0, 1.0};
  }

  // Factors that turn the file's units into millimetres: "space units" has one for each axis of
  // space, "units" one for each axis of the file.
  Eigen::Vector3d unit_factors() {
    static const std::map<std::string_view, double> kUnits{
        {"mm", 1.0},   {"millimeter", 1.0}, {"millimeters", 1.0},
        {"um", 1e-3},  {"\xc2\xb5m", 1e-3}, {"cm", 10.0},
        {"m", 1000.0}, {"", 1.0},           {"???", 1.0}};
    const bool of_space = !directions_.empty();
    const std::string_view name = of_space ? "spaceunits" : "units";
    std::vector<std::string_view> units;
    for (std::string_view text = get(name); units.size() < rank_;) {
      const std::size_t first = text.find('"');
      const std::size_t second =
          first == std::string_view::npos ? first : text.find('"', first + 1);
      if (second == std::string_view::npos) break;
      units.push_back(trim(text.substr(first + 1, second - first - 1)));
      text.remove_prefix(second + 1);
    }
    Eigen::Vector3d factors = Eigen::Vector3d::Ones();
    for (std::size_t n = 0; n < 3; ++n) {
      const std::size_t index = of_space ? n : axes_[n];
      if (index >= units.size()) continue;
      const auto unit = kUnits.find(units[index]);
      if (unit == kUnits.end()) {
        header_.warnings.push_back("unit " + in_quotes(units[index]) +
                                   " is not known: taken for millimetres");
      } else {
        factors[static_cast<int>(n)] = unit->second;
      }
    }
    return factors;
  }

  void read_place() {
    const Eigen::Vector3d signs = world_signs();
    Eigen::Matrix3d columns = Eigen::Matrix3d::Identity();
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    if (directions_.empty()) {
      read_spacings(columns, origin);
    } else {
      for (int n = 0; n < 3; ++n) columns.col(n) = *directions_[axes_[static_cast<std::size_t>(n)]];
    }
    if (has("spaceorigin")) {
      const auto place = vector(get("spaceorigin"));
      if (!place) throw bad("spaceorigin", "a vector of three numbers");
      origin = *place;
    }
    const Eigen::Vector3d factors = signs.cwiseProduct(unit_factors());
    set_affine(header_, factors.asDiagonal() * columns, factors.cwiseProduct(origin), path_);
  }

  // The number an axis field has for space axis n; nothing when absent or nan.
  [[nodiscard]] std::optional<double> axis_number(std::string_view name, int n) const {
    const auto words = axis_words(name);
    if (words.empty()) return std::nullopt;
    const auto value = parse_real(words[axes_[static_cast<std::size_t>(n)]]);
    if (!value) throw bad(name, "numbers");
    if (std::isnan(*value)) return std::nullopt;
    return value;
  }

  // Axis-aligned volumes: "spacings", or "axis mins" and "axis maxs" of the samples' centres or
  // borders.
  void read_spacings(Eigen::Matrix3d& columns, Eigen::Vector3d& origin) {
    const auto centerings = axis_words("centerings");
    bool known = false;
    for (int n = 0; n < 3; ++n) {
      const std::size_t axis = axes_[static_cast<std::size_t>(n)];
      const bool node = !centerings.empty() && lower_case(centerings[axis]) == "node";
      const auto lower = axis_number("axismins", n);
      const auto upper = axis_number("axismaxs", n);
      auto spacing = axis_number("spacings", n);
      if (!spacing && lower && upper) {
        const auto size = static_cast<double>(header_.dims[static_cast<std::size_t>(n)]);
        spacing = (*upper - *lower) / std::max(node ? size - 1.0 : size, 1.0);
      }
      known = known || spacing.has_value();
      if (spacing && !(std::isfinite(*spacing) && *spacing > 0.0)) {
        throw FileError(path_, "spacing " + to_text(*spacing) + " along axis " +
                                   std::to_string(axis + 1) +
                                   "; expected a finite positive number");
      }
      columns(n, n) = spacing.value_or(1.0);
      if (lower) origin[n] = *lower + (node ? 0.0 : 0.5 * columns(n, n));
    }
    if (!known) header_.warnings.push_back("has no spacing: taken for 1 mm along each axis");
  }

  void read_payload() {
    Payload& payload = header_.payload;
    const std::string encoding = lower_case(get("encoding"));
    if (encoding == "raw") {
      payload.encoding = Encoding::raw;
    } else if (encoding == "gzip" || encoding == "gz") {
      payload.encoding = Encoding::compressed;
    } else if (encoding == "txt" || encoding == "text" || encoding == "ascii") {
      payload.encoding = Encoding::text;
    } else {
      throw bad("encoding", "raw, gzip or ascii");
    }
    const std::string endian = lower_case(get("endian"));
    if (endian == "big") {
      payload.big_endian = true;
    } else if (endian != "little" && (!endian.empty() || (sample_size(header_.type) > 1 &&
                                                          payload.encoding != Encoding::text))) {
      throw bad("endian", "\"little\" or \"big\"");
    }
    payload.line_skip = integer("lineskip", 0);
    if (payload.line_skip < 0) throw bad("lineskip", "a number that is not negative");
    const std::int64_t byte_skip = integer("byteskip", 0);
    const bool at_end = byte_skip == -1 && payload.encoding == Encoding::raw;
    if (byte_skip < 0 && !at_end) {
      throw bad("byteskip", "a number that is not negative, or -1 for raw data at the end");
    }
    if (payload.encoding == Encoding::compressed) {
      payload.stream_skip = byte_skip;
    } else {
      payload.byte_skip = at_end ? Payload::kAtEnd : byte_skip;
    }
    read_data_files();
  }

  void read_data_files() {
    Payload& payload = header_.payload;
    if (!has("datafile")) {
      if (!nrrd_.ended) {
        throw FileError(path_,
                        "its NRRD header has no end: neither an empty line nor a \"data file\"");
      }
      // Skips count from the end of the header.
      if (payload.byte_skip == Payload::kAtEnd) return;
      if (payload.line_skip > 0) throw bad("lineskip", "0 in a header that its data follow");
      if (payload.byte_skip > std::numeric_limits<std::int64_t>::max() / 2) {
        throw bad("byteskip", "a position inside the file");
      }
      payload.byte_skip += static_cast<std::int64_t>(nrrd_.size);
      return;
    }
    const std::string_view value = get("datafile");
    const auto words = split_words(value);
    if (!words.empty() && words[0] == "LIST") {
      check_slab_rank(words, 1);
      payload.files = listed_names(nrrd_.after_list, path_);
    } else if (words.size() >= 4 && value.find('%') != std::string_view::npos) {
      const std::size_t numbers =
          words.size() > 4 && parse_integer(words[words.size() - 4]) ? 4 : 3;
      const auto number = [&](std::size_t n) {
        return parse_integer(words[words.size() - numbers + n]);
      };
      if (!number(0) || !number(1) || !number(2))
        throw bad("datafile", "a pattern, first, last and step");
      if (numbers == 4) check_slab_rank(words, words.size() - 1);
      // The pattern may contain blanks.
      const std::string_view last_word = words[words.size() - numbers - 1];
      const auto length =
          static_cast<std::size_t>(last_word.data() + last_word.size() - value.data());
      payload.files =
          numbered_names(value.substr(0, length), *number(0), *number(1), *number(2), path_);
    } else if (value.empty()) {
      throw bad("datafile", "a file name");
    } else {
      payload.files = {std::string(value)};
    }
  }

  // Files of several slices each are still equal shares in order, unless they are interleaved.
  void check_slab_rank(const std::vector<std::string_view>& words, std::size_t index) const {
    if (index >= words.size()) return;
    const auto slab = parse_integer(words[index]);
    if (!slab || *slab < 1 || *slab > static_cast<std::int64_t>(rank_)) {
      throw bad("datafile", "a number of axes of 1 to " + std::to_string(rank_));
    }
  }

  const Nrrd& nrrd_;
  const std::filesystem::path& path_;
  VolumeHeader header_;
  std::size_t rank_ = 0;
  std::vector<std::optional<Eigen::Vector3d>>
      directions_;                 ///< For each axis of the file, or empty.
  std::vector<std::size_t> axes_;  ///< The three axes of space.
};

}  // namespace

VolumeHeader parse_nrrd_header(std::string_view bytes, const std::filesystem::path& path) {
  const Nrrd nrrd = split(bytes, path);
  return Reader(nrrd, path).read();
}

}  // namespace shape3d::apps
