#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <utility>

#include "data_files.hpp"
#include "error.hpp"
#include "text.hpp"
#include "volume_header.hpp"

namespace shape3d::apps {
namespace {

constexpr std::size_t kMostAxes = 10;

// Reads "Key = value" lines up to and with ElementDataFile.
class Reader {
 public:
  Reader(std::string_view bytes, const std::filesystem::path& path) : path_(path) { split(bytes); }

  VolumeHeader read() {
    header_.format = "MetaImage";
    read_dims();
    read_type();
    read_place();
    read_payload();
    return std::move(header_);
  }

 private:
  void split(std::string_view bytes) {
    std::size_t position = 0;
    while (position < bytes.size()) {
      const std::size_t end = std::min(bytes.find('\n', position), bytes.size());
      const std::string_view line = trim(bytes.substr(position, end - position));
      position = std::min(end + 1, bytes.size());
      if (line.empty()) continue;
      const std::size_t equals = line.find('=');
      if (equals == std::string_view::npos) {
        throw FileError(path_, "header line " + in_quotes(line) + "; expected \"Key = value\"");
      }
      const std::string key(trim(line.substr(0, equals)));
      if (!fields_.emplace(key, trim(line.substr(equals + 1))).second && key != "Comment") {
        throw FileError(path_, "header has two fields " + in_quotes(key));
      }
      if (key == "ElementDataFile") {
        size_ = position;
        rest_ = bytes.substr(position);
        return;
      }
    }
    throw FileError(path_, "its MetaImage header has no field \"ElementDataFile\"");
  }

  [[nodiscard]] bool has(std::string_view key) const { return fields_.find(key) != fields_.end(); }

  [[nodiscard]] std::string_view get(std::string_view key) const {
    const auto found = fields_.find(key);
    return found == fields_.end() ? std::string_view() : found->second;
  }

  [[nodiscard]] FileError bad(std::string_view key, const std::string& expected) const {
    const std::string field = "field \"" + std::string(key) + "\"";
    if (!has(key)) return FileError(path_, "header has no " + field + "; expected " + expected);
    return FileError(path_, field + " is " + in_quotes(get(key)) + "; expected " + expected);
  }

  [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t otherwise) const {
    if (!has(key)) return otherwise;
    const auto value = parse_integer(get(key));
    if (!value) throw bad(key, "an integer");
    return *value;
  }

  [[nodiscard]] bool boolean(std::string_view key) const {
    const std::string value = lower_case(get(key));
    if (value.empty() || value == "false" || value == "f" || value == "0" || value == "no")
      return false;
    if (value == "true" || value == "t" || value == "1" || value == "yes") return true;
    throw bad(key, "True or False");
  }

  // `count` numbers; nothing when the key is not there.
  [[nodiscard]] std::optional<std::vector<double>> reals(std::string_view key,
                                                         std::size_t count) const {
    if (!has(key)) return std::nullopt;
    std::vector<double> values;
    for (const std::string_view word : split_words(get(key))) {
      const auto value = parse_real(word);
      if (!value) throw bad(key, "numbers");
      values.push_back(*value);
    }
    if (values.size() != count) throw bad(key, std::to_string(count) + " numbers");
    return values;
  }

  // The key among synonyms that the header uses; the first when none.
  [[nodiscard]] std::string_view either(std::initializer_list<std::string_view> keys) const {
    for (const std::string_view key : keys) {
      if (has(key)) return key;
    }
    return *keys.begin();
  }

  void read_dims() {
    if (has("ObjectType") && get("ObjectType") != "Image") throw bad("ObjectType", "Image");
    const std::int64_t rank = integer("NDims", 0);
    if (rank < 1 || rank > static_cast<std::int64_t>(kMostAxes)) throw bad("NDims", "3");
    rank_ = static_cast<std::size_t>(rank);
    std::vector<std::int64_t> sizes;
    for (const std::string_view word : split_words(get("DimSize"))) {
      const auto size = parse_integer(word);
      if (!size) throw bad("DimSize", "integers");
      sizes.push_back(*size);
    }
    if (sizes.size() != rank_) throw bad("DimSize", std::to_string(rank_) + " integers");
    if (rank_ < 3) {
      throw FileError(path_, "has " + std::to_string(rank_) + " axes; a volume has three");
    }
    for (std::size_t axis = 0; axis < rank_; ++axis) {
      if (axis < 3) {
        header_.dims[axis] = sizes[axis];
      } else if (sizes[axis] != 1) {
        throw FileError(path_, "holds " + std::to_string(sizes[axis]) + " frames (" +
                                   std::to_string(axis + 1) + "-D); expected one");
      }
    }
  }

  void read_type() {
    static const std::map<std::string_view, StoredType> kTypes{
        {"MET_CHAR", StoredType::int8},       {"MET_UCHAR", StoredType::uint8},
        {"MET_SHORT", StoredType::int16},     {"MET_USHORT", StoredType::uint16},
        {"MET_INT", StoredType::int32},       {"MET_UINT", StoredType::uint32},
        {"MET_LONG", StoredType::int32},      {"MET_ULONG", StoredType::uint32},
        {"MET_LONG_LONG", StoredType::int64}, {"MET_ULONG_LONG", StoredType::uint64},
        {"MET_FLOAT", StoredType::float32},   {"MET_DOUBLE", StoredType::float64},
    };
    const std::int64_t channels = integer("ElementNumberOfChannels", 1);
    if (channels != 1) {
      throw FileError(path_,
                      "holds " + std::to_string(channels) + " components a voxel; expected one");
    }
    const auto type = kTypes.find(get("ElementType"));
    if (type == kTypes.end()) throw bad("ElementType", "a number type, MET_CHAR to MET_DOUBLE");
    header_.type = type->second;
  }

  void read_place() {
    const std::string_view spacing_key = either({"ElementSpacing", "ElementSize"});
    const auto spacing = reals(spacing_key, rank_).value_or(std::vector<double>(rank_, 1.0));
    if (!has(spacing_key))
      header_.warnings.push_back("has no ElementSpacing: taken for 1 mm along each axis");
    const auto matrix =
        reals(either({"TransformMatrix", "Rotation", "Orientation"}), rank_ * rank_);
    const auto offset = reals(either({"Offset", "Position", "Origin"}), rank_)
                            .value_or(std::vector<double>(rank_, 0.0));
    double unit = 1.0;
    if (has("DistanceUnits")) {
      const std::string_view name = get("DistanceUnits");
      if (name == "um") {
        unit = 1e-3;
      } else if (name == "cm") {
        unit = 10.0;
      } else if (name != "mm" && name != "?" && !name.empty()) {
        throw bad("DistanceUnits", "um, mm or cm");
      }
    }
    Eigen::Matrix3d columns = Eigen::Matrix3d::Identity();
    Eigen::Vector3d origin;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto n = static_cast<int>(axis);
      // A zero or negative spacing would vanish in the affine.
      if (!(spacing[axis] > 0.0)) {
        throw FileError(path_, "spacing " + to_text(spacing[axis]) + " along axis " +
                                   std::to_string(axis + 1) +
                                   "; expected a finite positive number");
      }
      origin[n] = offset[axis] * unit;
      if (matrix) {
        for (std::size_t row = 0; row < 3; ++row) {
          columns(static_cast<int>(row), n) = (*matrix)[axis * rank_ + row];
        }
      }
      columns.col(n) *= spacing[axis] * unit;
    }
    set_affine(header_, columns, origin, path_);
    keep_axes(matrix, spacing, unit);
    // Intensities are slope · element + offset.
    if (const auto slope = reals("ElementToIntensityFunctionSlope", 1))
      header_.slope = slope->front();
    if (const auto intercept = reals("ElementToIntensityFunctionOffset", 1)) {
      header_.intercept = intercept->front();
    }
  }

  // Spacing and axes as written, where the axes have unit length but for rounding.
  void keep_axes(const std::optional<std::vector<double>>& matrix,
                 const std::vector<double>& spacing, double unit) {
    constexpr double kRounding = 1e-12;
    for (int n = 0; n < 3; ++n) {
      const double written = spacing[static_cast<std::size_t>(n)] * unit;
      if (std::abs(header_.spacing[n] / written - 1.0) > kRounding) continue;
      header_.spacing[n] = written;
      if (!matrix) continue;
      for (int row = 0; row < 3; ++row) {
        header_.direction(row, n) =
            (*matrix)[static_cast<std::size_t>(n) * rank_ + static_cast<std::size_t>(row)];
      }
    }
  }

  void read_payload() {
    Payload& payload = header_.payload;
    const bool text = has("BinaryData") && !boolean("BinaryData");
    const bool compressed = boolean("CompressedData");
    if (text && compressed) throw bad("CompressedData", "False for text data");
    payload.encoding = text ? Encoding::text : compressed ? Encoding::compressed : Encoding::raw;
    payload.big_endian = boolean(either({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}));
    const std::int64_t skip = integer("HeaderSize", 0);
    const bool at_end = skip == -1 && payload.encoding == Encoding::raw;
    if (skip < 0 && !at_end)
      throw bad("HeaderSize", "a number that is not negative, or -1 for raw data");

    const std::string_view name = get("ElementDataFile");
    const auto words = split_words(name);
    if (words.empty()) throw bad("ElementDataFile", "LOCAL, LIST or a file name");
    if (lower_case(name) == "local") {
      payload.byte_skip = static_cast<std::int64_t>(size_);
      return;
    }
    payload.byte_skip = at_end ? Payload::kAtEnd : skip;
    if (words[0] == "LIST") {
      payload.files = listed_names(rest_, path_);
    } else if (words.size() == 4 && name.find('%') != std::string_view::npos) {
      const auto first = parse_integer(words[1]);
      const auto last = parse_integer(words[2]);
      const auto step = parse_integer(words[3]);
      if (!first || !last || !step) throw bad("ElementDataFile", "a pattern, first, last and step");
      payload.files = numbered_names(words[0], *first, *last, *step, path_);
    } else {
      payload.files = {std::string(name)};
    }
  }

  const std::filesystem::path& path_;
  std::map<std::string, std::string_view, std::less<>> fields_;
  std::string_view rest_;  ///< What follows ElementDataFile.
  std::size_t size_ = 0;   ///< Bytes up to it.
  std::size_t rank_ = 0;
  VolumeHeader header_;
};

}  // namespace

VolumeHeader parse_metaimage_header(std::string_view bytes, const std::filesystem::path& path) {
  return Reader(bytes, path).read();
}

}  // namespace shape3d::apps
