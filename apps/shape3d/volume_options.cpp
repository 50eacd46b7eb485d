#include "volume_options.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <CLI/CLI.hpp>

#include "common/error.hpp"
#include "common/text.hpp"
#include "common/volume_io.hpp"

namespace shape3d::apps {
namespace {

template <class T>
void include_samples(const zmc::VolumeView& view, std::optional<std::array<double, 2>>& range) {
  const std::array<std::int64_t, 3> strides = view.effective_strides();
  const T* data = static_cast<const T*>(view.data);
  bool any = false;
  T least{}, greatest{};
  for (std::int64_t k = 0; k < view.dims[2]; ++k) {
    for (std::int64_t j = 0; j < view.dims[1]; ++j) {
      const T* row = data + j * strides[1] + k * strides[2];
      for (std::int64_t i = 0; i < view.dims[0]; ++i) {
        const T value = row[i * strides[0]];
        if constexpr (std::is_floating_point_v<T>) {
          if (!std::isfinite(value)) continue;
        }
        least = any ? std::min(least, value) : value;
        greatest = any ? std::max(greatest, value) : value;
        any = true;
      }
    }
  }
  if (any) range = {static_cast<double>(least), static_cast<double>(greatest)};
}

}  // namespace

std::string shortest(double number) { return to_text(number); }

std::string to_string(zmc::Inside inside) {
  return inside == zmc::Inside::above ? "above" : "below";
}

std::string to_string(zmc::TieRule ties) {
  return ties == zmc::TieRule::neutral ? "neutral" : "positive";
}

void add_volume_options(CLI::App& command, VolumeArguments& arguments) {
  command
      .add_option("VOLUME", arguments.path,
                  "A folder of DICOM slices, .nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd or .vti")
      ->required();
  command
      .add_option("--series", arguments.series,
                  "The DICOM series: its UID, or its number in the list")
      ->type_name("UID|N");
  static const std::map<std::string, zmc::Inside> kInside{{"above", zmc::Inside::above},
                                                          {"below", zmc::Inside::below}};
  command
      .add_option("--inside", arguments.inside,
                  "The side of the isovalue that is the object: above (default: CT, MR, labels) or "
                  "below (distance functions)")
      ->transform(CLI::CheckedTransformer(kInside))
      ->type_name("above|below");
  static const std::map<std::string, zmc::TieRule> kTies{{"neutral", zmc::TieRule::neutral},
                                                         {"positive", zmc::TieRule::positive}};
  command
      .add_option("--ties", arguments.ties,
                  "Equal products in ambiguous faces: by the lattice (neutral, default) or for the "
                  "positive side")
      ->transform(CLI::CheckedTransformer(kTies))
      ->type_name("neutral|positive");
  static const std::map<std::string, zmc::NonFinite> kNonFinite{{"error", zmc::NonFinite::error},
                                                                {"mask", zmc::NonFinite::mask}};
  command
      .add_option("--non-finite", arguments.non_finite,
                  "NaN and infinite samples: an error (default), or cells that touch one are left "
                  "out (mask)")
      ->transform(CLI::CheckedTransformer(kNonFinite))
      ->type_name("error|mask");
}

void add_space_option(CLI::App& command, std::string& space) {
  command
      .add_option("--space", space,
                  "World axes of the output: left-posterior-superior (lps, default) or "
                  "right-anterior-superior (ras)")
      ->check(CLI::IsMember({"lps", "ras"}))
      ->type_name("lps|ras");
}

zmc::Options to_options(const VolumeArguments& arguments, const Settings& settings) {
  zmc::Options options;
  options.inside = arguments.inside;
  options.ties = arguments.ties;
  options.non_finite = arguments.non_finite;
  options.threads = settings.threads;
  return options;
}

Volume read_volume_of(const VolumeArguments& arguments, const Settings& settings,
                      Progress& progress) {
  progress.stage("reading " + arguments.path);
  VolumeReadOptions options;
  options.series = arguments.series;
  Volume volume = read_volume(arguments.path, options);
  for (const std::string& sentence : volume.warnings) warn(settings, sentence);
  return volume;
}

void fail_for(const std::string& path, const std::invalid_argument& error) {
  std::string sentence = error.what();
  const std::string name = "NonFinite::mask";
  if (const std::size_t at = sentence.find(name); at != std::string::npos)
    sentence.replace(at, name.size(), "--non-finite mask");
  throw FileError(path, sentence);
}

std::optional<std::array<double, 2>> range_of(const zmc::VolumeView& view) {
  std::optional<std::array<double, 2>> range;
  switch (view.type) {
    case zmc::SampleType::int8:
      include_samples<std::int8_t>(view, range);
      break;
    case zmc::SampleType::uint8:
      include_samples<std::uint8_t>(view, range);
      break;
    case zmc::SampleType::int16:
      include_samples<std::int16_t>(view, range);
      break;
    case zmc::SampleType::uint16:
      include_samples<std::uint16_t>(view, range);
      break;
    case zmc::SampleType::int32:
      include_samples<std::int32_t>(view, range);
      break;
    case zmc::SampleType::float32:
      include_samples<float>(view, range);
      break;
    case zmc::SampleType::float64:
      include_samples<double>(view, range);
      break;
  }
  return range;
}

std::string emptiness(const std::string& what, double isovalue, const zmc::VolumeView& view,
                      const std::string& path) {
  const std::optional<std::array<double, 2>> range = range_of(view);
  if (!range) return path + ": no sample is finite: " + what + " is empty";
  const bool outside = isovalue < (*range)[0] || isovalue > (*range)[1];
  return path + ": the isovalue " + shortest(isovalue) +
         (outside ? " is outside" : " divides no samples within") + " the range " +
         shortest((*range)[0]) + " … " + shortest((*range)[1]) + ": " + what + " is empty";
}

}  // namespace shape3d::apps
