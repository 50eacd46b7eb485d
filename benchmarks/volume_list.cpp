#include "volume_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>

#include "common/error.hpp"
#include "common/volume_info.hpp"
#include "common/volume_io.hpp"

namespace shape3d::bench {
namespace {

namespace fs = std::filesystem;

struct Customary {
  std::string_view name;
  double isovalue;
};
constexpr Customary kCustomary[] = {{"engine", 128}, {"bonsai", 40}, {"tooth", 150}};

double usual_isovalue(const std::string& name, const apps::Volume& volume) {
  for (const Customary& customary : kCustomary) {
    if (name.rfind(customary.name, 0) == 0) return customary.isovalue;
  }
  const apps::VolumeDescription description = apps::describe_volume(volume);
  if (description.minimum <= -900) return -400;
  return std::floor(0.5 * (description.minimum + description.maximum));
}

ListedVolume listed(const fs::path& path, std::optional<double> isovalue) {
  return {nullptr, [path, isovalue] {
            apps::Volume volume = apps::read_volume(path);
            LoadedVolume result;
            result.name = fs::is_directory(path) ? path.filename() : path.stem();
            result.isovalue = isovalue ? *isovalue : usual_isovalue(result.name, volume);
            result.view = volume.view;
            result.view.spacing = Eigen::Vector3d::Ones();
            result.view.origin = Eigen::Vector3d::Zero();
            result.view.direction = Eigen::Matrix3d::Identity();
            result.samples = std::move(volume.samples);
            result.view.data = result.samples.data();
            return result;
          }};
}

/// MetaImages, and folders that hold DICOM files.
std::set<fs::path> volumes_below(const fs::path& folder) {
  std::set<fs::path> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const fs::path& path = entry.path();
    const std::string extension = path.extension();
    if (extension == ".mhd" || extension == ".mha") {
      found.insert(path);
    } else if ((extension == ".dcm" || extension.empty()) && found.count(path.parent_path()) == 0 &&
               apps::detect_volume_format(path) == apps::VolumeFormat::dicom) {
      found.insert(path.parent_path());
    }
  }
  return found;
}

}  // namespace

std::vector<ListedVolume> generated_volumes() {
  std::vector<ListedVolume> list;
  for (const CtSize& size : kCtSizes) {
    list.push_back({&size, [&size] {
                      const std::vector<std::int16_t> samples =
                          make_ct_volume(size.dims, size.wavelength);
                      LoadedVolume result;
                      result.name = "generated " + std::string(size.name);
                      result.samples.resize(samples.size() * sizeof samples[0]);
                      std::memcpy(result.samples.data(), samples.data(), result.samples.size());
                      result.view.type = zmc::SampleType::int16;
                      result.view.dims = size.dims;
                      result.view.data = result.samples.data();
                      result.isovalue = kCtIsovalue;
                      return result;
                    }});
  }
  return list;
}

std::vector<ListedVolume> volumes_at(const std::string& argument) {
  std::string name = argument;
  std::optional<double> isovalue;
  const std::size_t at = argument.rfind('@');
  if (at != std::string::npos && !fs::exists(argument)) {
    name = argument.substr(0, at);
    const std::string text = argument.substr(at + 1);
    std::size_t used = 0;
    try {
      isovalue = std::stod(text, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || used != text.size() || !std::isfinite(*isovalue)) {
      throw std::invalid_argument("isovalue is '" + text + "' in '" + argument +
                                  "'; expected a finite number after @");
    }
  }
  const fs::path path = name;
  if (!fs::exists(path)) throw apps::FileError(path, "there is no such file or folder");
  if (!fs::is_directory(path)) return {listed(path, isovalue)};
  std::vector<fs::path> folders;
  for (const char* part : {"table31", "classic"}) {
    if (fs::is_directory(path / part)) folders.push_back(path / part);
  }
  if (folders.empty()) folders.push_back(path);
  std::vector<ListedVolume> list;
  for (const fs::path& folder : folders) {
    for (const fs::path& volume : volumes_below(folder)) list.push_back(listed(volume, isovalue));
  }
  if (list.empty()) throw apps::FileError(path, "holds no MetaImage and no DICOM series");
  return list;
}

}  // namespace shape3d::bench
