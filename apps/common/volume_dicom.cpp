#include <algorithm>
#include <set>
#include <utility>

#include "dicom_pixels.hpp"
#include "dicom_series.hpp"
#include "error.hpp"
#include "memory_limit.hpp"
#include "payload.hpp"
#include "text.hpp"
#include "volume_formats.hpp"

namespace shape3d::apps {
namespace {

// The files of the series that a path and a selector stand for.
struct Selection {
  std::string uid;
  std::vector<DicomFile> files;
};

Selection select(const std::filesystem::path& path, const std::string& selector) {
  std::error_code error;
  const bool directory = std::filesystem::is_directory(path, error);
  if (!directory) static_cast<void>(readable_size(path));
  std::filesystem::path folder = directory ? path : path.parent_path();
  if (folder.empty()) folder = ".";
  const std::vector<DicomSeries> all = scan_dicom(folder);
  if (directory || !selector.empty()) {
    const DicomSeries& series = choose_series(all, selector, path);
    return {series.uid, series.files};
  }
  for (const DicomSeries& series : all) {
    for (const DicomFile& file : series.files) {
      if (file.path.filename() != path.filename()) continue;
      // A file of many frames is a volume by itself.
      if (file.frames.size() > 1) return {series.uid, {file}};
      return {series.uid, series.files};
    }
  }
  throw FileError(path, "is not a DICOM image");
}

// Copies of an instance count once.
void drop_copies(std::vector<DicomFile>& files, std::vector<std::string>& warnings) {
  std::set<std::string> seen;
  const auto copies = std::remove_if(files.begin(), files.end(), [&](const DicomFile& file) {
    return !file.instance_uid.empty() && !seen.insert(file.instance_uid).second;
  });
  const auto count = std::distance(copies, files.end());
  if (count == 0) return;
  warnings.push_back(std::to_string(count) +
                     (count == 1 ? " file is a copy" : " files are copies") +
                     " of other files of the series and left out");
  files.erase(copies, files.end());
}

void check_files(const std::vector<DicomFile>& files) {
  const DicomFile& first = files.front();
  for (const DicomFile& file : files) {
    if (!file.problem.empty()) throw FileError(file.path, file.problem);
    if (file.compressed) {
      FrameSize size;
      size.frames = file.frames.size();
      size.pixels = static_cast<std::uint64_t>(file.rows * file.columns);
      size.bytes_per_pixel = sample_size(file.type);
      const std::string problem =
          check_fragments(file.path, file.transfer_syntax, file.fragments, size);
      if (!problem.empty()) throw FileError(file.path, problem);
    }
    if (file.rows != first.rows || file.columns != first.columns || file.type != first.type) {
      throw FileError(file.path,
                      "is " + std::to_string(file.columns) + " x " + std::to_string(file.rows) +
                          " " + std::string(to_string(file.type)) + "; " +
                          first.path.filename().string() + " of the same series is " +
                          std::to_string(first.columns) + " x " + std::to_string(first.rows) + " " +
                          std::string(to_string(first.type)));
    }
  }
}

}  // namespace

Volume read_dicom(const std::filesystem::path& path, const std::string& series,
                  std::uint64_t memory_limit) {
  Selection selection = select(path, series);
  VolumeHeader header;
  header.format = "DICOM series";
  drop_copies(selection.files, header.warnings);
  check_files(selection.files);

  std::vector<SlicePlace> places;
  std::vector<Scale> scales;
  for (const DicomFile& file : selection.files) {
    places.insert(places.end(), file.frames.begin(), file.frames.end());
    scales.insert(scales.end(), file.scales.begin(), file.scales.end());
  }
  SliceStack stack = stack_slices(places, path);
  header.dims = {selection.files.front().columns, selection.files.front().rows,
                 static_cast<std::int64_t>(places.size())};
  header.type = selection.files.front().type;
  set_affine(header, stack.steps, stack.origin, path);
  check_header(header, path);
  header.warnings.insert(header.warnings.end(), stack.warnings.begin(), stack.warnings.end());

  const std::uint64_t bytes = payload_bytes(header);
  // VTK's image and its copy.
  require_memory(path, 2 * bytes, memory_limit,
                 "reading " + samples_text(header.dims, header.type));
  std::vector<std::byte> data = read_dicom_pixels(selection.files, stack.order, path, bytes);
  std::vector<Scale> ordered_scales;
  for (const std::size_t slice : stack.order) ordered_scales.push_back(scales[slice]);
  TypedSamples samples =
      convert_samples(std::move(data), header.type, ordered_scales, path, memory_limit);
  return make_volume(std::move(header), std::move(samples));
}

}  // namespace shape3d::apps
