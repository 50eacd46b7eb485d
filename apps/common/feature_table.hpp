#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "output_file.hpp"

namespace shape3d::apps {

/// Vectors of one descriptor, a row for each file of the table.
struct FeatureSet {
  using Vectors = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  std::string spec;  ///< What they are made by, Descriptor::to_string().
  Vectors vectors;
};

/// Which file a row is of, and the state it was in.
struct FeatureFile {
  std::string path;
  std::uint64_t size = 0;  ///< Bytes.
  std::int64_t time = 0;   ///< Of the last modification, nanoseconds since 1970.

  friend bool operator==(const FeatureFile& a, const FeatureFile& b) {
    return a.path == b.path && a.size == b.size && a.time == b.time;
  }
};

/// Feature vectors of files, by one or several descriptors.
struct FeatureTable {
  std::vector<FeatureFile> files;
  std::vector<std::string> classes = {};  ///< Of the files, "" where unknown; or none.
  std::vector<FeatureSet> sets;           ///< At least one, no two specs equal.
  std::vector<std::pair<std::string, std::string>> failed;  ///< Files without vectors, and why.
};

enum class FeatureFormat { csv, npy, h5 };

/// By the extension .csv, .npy, .h5 or .hdf5, in any case of letters; empty for another one.
[[nodiscard]] std::optional<FeatureFormat> feature_format(const std::string& path);
inline constexpr std::string_view kFeatureExtensions = ".csv, .npy or .h5";

/// A name for each set: the kind of its descriptor, "hsh", with "_2", "_3" … where it occurs again.
[[nodiscard]] std::vector<std::string> feature_names(const FeatureTable& table);

/// Writes a table; does not commit the file. Numbers are exact in all formats.
///
/// Classes, when there are some, stand after mtime under the name `class`.
///
/// csv: lines of comment with the specs, one line of column names (file, size, mtime, hsh_0 …), a
/// line for each file. npy: one structured array with the fields file, size, mtime, and for each
/// set a field of vectors whose name is the spec. h5: datasets /file, /size, /mtime, for each set
/// /vectors/NAME with the attribute `spec`, and /failed/file, /failed/reason. (npy does not hold
/// `failed`.)
/// @throws FileError  writing failed.
void write_features(OutputFile& file, FeatureFormat format, const FeatureTable& table);

/// Reads what write_features() wrote.
/// @throws FileError  the extension is unknown; the file cannot be read or is not such a table.
[[nodiscard]] FeatureTable read_features(const std::string& path);

}  // namespace shape3d::apps
