#include "feature_table.hpp"

#include <filesystem>
#include <map>

#include "byte_source.hpp"
#include "error.hpp"
#include "feature_formats.hpp"
#include "text.hpp"

namespace shape3d::apps {

std::optional<FeatureFormat> feature_format(const std::string& path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  if (extension == ".csv") return FeatureFormat::csv;
  if (extension == ".npy") return FeatureFormat::npy;
  if (extension == ".h5" || extension == ".hdf5") return FeatureFormat::h5;
  return std::nullopt;
}

std::vector<std::string> feature_names(const FeatureTable& table) {
  std::map<std::string, int> times;
  std::vector<std::string> names;
  for (const FeatureSet& set : table.sets) {
    const std::string kind = set.spec.substr(0, set.spec.find(':'));
    const int time = ++times[kind];
    names.push_back(time == 1 ? kind : kind + "_" + std::to_string(time));
  }
  return names;
}

void write_features(OutputFile& file, FeatureFormat format, const FeatureTable& table) {
  switch (format) {
    case FeatureFormat::csv:
      formats::write_csv(file, table);
      return;
    case FeatureFormat::npy:
      formats::write_npy(file, table);
      return;
    case FeatureFormat::h5:
      formats::write_h5(file, table);
      return;
  }
}

FeatureTable read_features(const std::string& path) {
  const std::optional<FeatureFormat> format = feature_format(path);
  if (!format) {
    throw FileError(path, "unknown extension, expected " + std::string(kFeatureExtensions));
  }
  if (*format == FeatureFormat::h5) return formats::read_h5(path);
  const MappedFile file(path);
  return *format == FeatureFormat::csv ? formats::parse_csv(file.bytes(), path)
                                       : formats::parse_npy(file.bytes(), path);
}

}  // namespace shape3d::apps
