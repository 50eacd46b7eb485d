#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dicom_fragments.hpp"
#include "samples.hpp"
#include "slice_geometry.hpp"
#include "volume_header.hpp"

namespace shape3d::apps {

/// One file of a DICOM series.
struct DicomFile {
  std::filesystem::path path;
  std::string instance_uid;
  std::string transfer_syntax;
  std::int64_t rows = 0;
  std::int64_t columns = 0;
  StoredType type = StoredType::int16;
  std::vector<SlicePlace> frames;  ///< At least one.
  bool compressed = false;
  std::vector<Fragment> fragments;  ///< Of compressed pixel data.
  std::vector<Scale> scales;        ///< For each frame.
  std::string problem;              ///< Why the file cannot be part of a volume; empty: it can.
};

/// Image files with the same SeriesInstanceUID.
struct DicomSeries {
  std::string uid;
  std::string modality;
  std::string description;
  std::int64_t number = 0;       ///< SeriesNumber, 0 when it is not there.
  std::vector<DicomFile> files;  ///< By name.
};

/// The image series in a directory (sub-directories are not searched), by number, then UID. Files
/// that are not DICOM and DICOM files without an image (reports, DICOMDIR) are left out.
/// @throws FileError  the directory cannot be read; a file says that it is DICOM (by its first
/// bytes or the
///         extensions .dcm and .ima) and cannot be understood or ends before its image.
[[nodiscard]] std::vector<DicomSeries> scan_dicom(const std::filesystem::path& directory);

/// The series a selector stands for: a UID, a number in the list from 1 on, or empty for the only
/// one.
/// @throws FileError  there are none, several and no selector, or none that fits; with the list.
[[nodiscard]] const DicomSeries& choose_series(const std::vector<DicomSeries>& series,
                                               const std::string& selector,
                                               const std::filesystem::path& path);

/// "1: CT "Thorax", 28 slices of 512 x 512, 1.2.840…", one line each.
[[nodiscard]] std::string series_list(const std::vector<DicomSeries>& series);

}  // namespace shape3d::apps
