#include "dicom_series.hpp"

#include <algorithm>
#include <exception>
#include <map>
#include <optional>
#include <system_error>

#include <vtkDICOMDictionary.h>
#include <vtkDICOMMetaData.h>
#include <vtkDICOMParser.h>
#include <vtkDICOMUtilities.h>
#include <vtkDICOMValue.h>
#include <vtkSmartPointer.h>

#include "byte_source.hpp"
#include "dicom_elements.hpp"
#include "error.hpp"
#include "text.hpp"
#include "vtk_messages.hpp"

namespace shape3d::apps {
namespace {

// Attributes as DICOM part 6 numbers them.
const vtkDICOMTag kTransferSyntax(0x0002, 0x0010);
const vtkDICOMTag kMediaClass(0x0002, 0x0002);
const vtkDICOMTag kSopClass(0x0008, 0x0016);
const vtkDICOMTag kSopInstance(0x0008, 0x0018);
const vtkDICOMTag kModality(0x0008, 0x0060);
const vtkDICOMTag kSeriesDescription(0x0008, 0x103e);
const vtkDICOMTag kSeriesInstance(0x0020, 0x000e);
const vtkDICOMTag kSeriesNumber(0x0020, 0x0011);
const vtkDICOMTag kPosition(0x0020, 0x0032);
const vtkDICOMTag kOrientation(0x0020, 0x0037);
const vtkDICOMTag kSamplesPerPixel(0x0028, 0x0002);
const vtkDICOMTag kPhotometric(0x0028, 0x0004);
const vtkDICOMTag kFrames(0x0028, 0x0008);
const vtkDICOMTag kRows(0x0028, 0x0010);
const vtkDICOMTag kColumns(0x0028, 0x0011);
const vtkDICOMTag kPixelSpacing(0x0028, 0x0030);
const vtkDICOMTag kBitsAllocated(0x0028, 0x0100);
const vtkDICOMTag kBitsStored(0x0028, 0x0101);
const vtkDICOMTag kHighBit(0x0028, 0x0102);
const vtkDICOMTag kPixelRepresentation(0x0028, 0x0103);
const vtkDICOMTag kIntercept(0x0028, 0x1052);
const vtkDICOMTag kSlope(0x0028, 0x1053);
const vtkDICOMTag kFunctionalGroups(0x5200, 0x9230);

// Implicit and explicit, little- and big-endian; RLE; JPEG, JPEG-LS and JPEG 2000 for one image.
bool is_read(std::string_view transfer_syntax) {
  constexpr std::string_view kRoot = "1.2.840.10008.1.2";
  if (transfer_syntax.substr(0, kRoot.size()) != kRoot) return false;
  transfer_syntax.remove_prefix(kRoot.size());
  for (const std::string_view end : {"", ".1", ".2", ".5", ".4.50", ".4.51", ".4.57", ".4.70",
                                     ".4.80", ".4.81", ".4.90", ".4.91"}) {
    if (transfer_syntax == end) return true;
  }
  return false;
}

constexpr unsigned int kEncapsulated = 0xffffffff;

bool named_dicom(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".dcm" || extension == ".ima" || extension == ".dicom";
}

// One file, parsed as far as its pixel data.
class Parser {
 public:
  explicit Parser(const std::filesystem::path& path)
      : path_(path), data_(vtkSmartPointer<vtkDICOMMetaData>::New()) {
    const VtkMessages messages;
    const auto parser = vtkSmartPointer<vtkDICOMParser>::New();
    parser->SetMetaData(data_);
    parser->SetFileName(path.c_str());
    parser->Update();
    error_ = messages.first_error();
    if (error_.empty() && parser->GetErrorCode() != 0) error_ = "its data elements are damaged";
    has_pixels_ = parser->GetPixelDataFound();
    pixel_length_ = parser->GetPixelDataVL();
    pixel_offset_ = static_cast<std::uint64_t>(parser->GetFileOffset());
  }

  // Why the data elements up to the pixels could not be parsed; empty when they could.
  [[nodiscard]] std::string header_error() const {
    return has_pixels_ || error_.empty() ? std::string() : "cannot be read: " + error_;
  }

  // Whether the object must hold pixels, or does.
  [[nodiscard]] bool is_image() const {
    return has_pixels_ || has(kRows) || has_image_class(kSopClass) || has_image_class(kMediaClass);
  }

  // Whether the first data elements say that the object is another than an image.
  [[nodiscard]] bool is_other() const { return has(kMediaClass) && !has_image_class(kMediaClass); }

  [[nodiscard]] std::string text(const vtkDICOMTag& tag) const {
    const vtkDICOMValue& value = data_->Get(tag);
    return value.IsValid() ? std::string(trim(value.AsUTF8String())) : std::string();
  }

  [[nodiscard]] std::int64_t integer(const vtkDICOMTag& tag, std::int64_t otherwise) const {
    const vtkDICOMValue& value = data_->Get(tag);
    return value.IsValid() && value.GetNumberOfValues() > 0 ? value.GetInt64(0) : otherwise;
  }

  [[nodiscard]] DicomFile file() const {
    DicomFile file;
    file.path = path_;
    file.instance_uid = text(kSopInstance);
    file.transfer_syntax = text(kTransferSyntax);
    file.rows = integer(kRows, 0);
    file.columns = integer(kColumns, 0);
    file.problem = read_image(file);
    if (file.problem.empty() && !error_.empty()) file.problem = "cannot be read: " + error_;
    return file;
  }

 private:
  [[nodiscard]] bool has(const vtkDICOMTag& tag) const { return data_->Get(tag).IsValid(); }

  [[nodiscard]] bool has_image_class(const vtkDICOMTag& tag) const {
    const char* name = vtkDICOMUtilities::GetUIDName(text(tag).c_str());
    return name != nullptr &&
           std::string_view(name).find("Image Storage") != std::string_view::npos;
  }

  // `count` numbers of a frame; decimal strings are parsed exactly. Nothing when missing or
  // malformed.
  [[nodiscard]] std::optional<std::vector<double>> reals(int frame, const vtkDICOMTag& tag,
                                                         std::size_t count) const {
    const vtkDICOMValue& value = data_->Get(0, frame, tag);
    if (!value.IsValid() || value.GetNumberOfValues() < count) return std::nullopt;
    std::vector<double> numbers;
    for (std::size_t n = 0; n < count; ++n) {
      const bool is_text = value.GetVR() == vtkDICOMVR::DS || value.GetVR() == vtkDICOMVR::IS;
      const auto number = is_text ? parse_real(trim(value.GetString(n))) : value.GetDouble(n);
      if (!number) return std::nullopt;
      numbers.push_back(*number);
    }
    return numbers;
  }

  // What is wrong with the image as a part of a volume; empty when nothing is.
  [[nodiscard]] std::string read_image(DicomFile& file) const {
    if (!has_pixels_) return "ends before its pixel data";
    constexpr std::int64_t kMostRows = 65535;
    if (std::min(file.rows, file.columns) < 1 || std::max(file.rows, file.columns) > kMostRows) {
      return "has " + std::to_string(file.rows) + " rows and " + std::to_string(file.columns) +
             " columns; expected 1 to 65535";
    }
    if (!file.transfer_syntax.empty() && !is_read(file.transfer_syntax)) {
      return "has transfer syntax " + in_quotes(file.transfer_syntax) +
             ", which is not read; expected uncompressed, RLE, JPEG, JPEG-LS or JPEG 2000 images";
    }
    const std::int64_t components = integer(kSamplesPerPixel, 1);
    const std::string photometric = text(kPhotometric);
    if (components != 1) {
      return "holds " + std::to_string(components) + " components a voxel; expected one";
    }
    if (photometric != "MONOCHROME1" && photometric != "MONOCHROME2") {
      return "photometric interpretation is " + in_quotes(photometric) +
             "; expected MONOCHROME1 or MONOCHROME2";
    }
    const std::int64_t bits = integer(kBitsAllocated, 0);
    const bool with_sign = integer(kPixelRepresentation, 0) == 1;
    if (bits == 8) {
      file.type = with_sign ? StoredType::int8 : StoredType::uint8;
    } else if (bits == 16) {
      file.type = with_sign ? StoredType::int16 : StoredType::uint16;
    } else if (bits == 32) {
      file.type = with_sign ? StoredType::int32 : StoredType::uint32;
    } else {
      return "has " + std::to_string(bits) + " bits allocated a sample; expected 8, 16 or 32";
    }
    const std::int64_t stored = integer(kBitsStored, bits);
    const std::int64_t high = integer(kHighBit, stored - 1);
    if (stored < 1 || stored > bits || high != stored - 1) {
      return "stores " + std::to_string(stored) + " bits up to bit " + std::to_string(high) +
             " of " + std::to_string(bits) + "; expected the lowest ones";
    }
    const std::int64_t frames = integer(kFrames, 1);
    constexpr std::int64_t kMostFrames = 1000000;
    if (frames < 1 || frames > kMostFrames) {
      return "has " + std::to_string(frames) + " frames; expected 1 to " +
             std::to_string(kMostFrames);
    }
    const std::string length = check_length(file, frames);
    return length.empty() ? read_frames(file, static_cast<int>(frames)) : length;
  }

  [[nodiscard]] std::string check_length(DicomFile& file, std::int64_t frames) const {
    const std::uint64_t size = readable_size(path_);
    if (pixel_length_ == kEncapsulated) {
      const auto fragments = find_fragments(path_, pixel_offset_);
      if (!fragments) {
        return "is cut off: its compressed pixel data have no end in " + std::to_string(size) +
               " bytes";
      }
      file.compressed = true;
      file.fragments = *fragments;
      return {};
    }
    // Rows and columns have 16 bits, so that the product fits.
    const std::uint64_t expected =
        static_cast<std::uint64_t>(file.rows * file.columns * frames) * sample_size(file.type);
    const std::uint64_t found = size - std::min(size, pixel_offset_);
    // One byte fills an odd number up.
    if (found < expected || pixel_length_ < expected || pixel_length_ > expected + 1) {
      return "holds " + std::to_string(std::min<std::uint64_t>(found, pixel_length_)) +
             " bytes of pixel data; expected " + std::to_string(expected) + ", says the header";
    }
    return {};
  }

  [[nodiscard]] std::string read_frames(DicomFile& file, int frames) const {
    for (int frame = 0; frame < frames; ++frame) {
      const auto position = reals(frame, kPosition, 3);
      const auto orientation = reals(frame, kOrientation, 6);
      const auto spacing = reals(frame, kPixelSpacing, 2);
      const std::string which = frames > 1 ? "frame " + std::to_string(frame + 1) + " " : "";
      if (!position || (frames > 1 && !has(kFunctionalGroups))) {
        return which + "has no ImagePositionPatient of three numbers";
      }
      if (!orientation) return which + "has no ImageOrientationPatient of six numbers";
      if (!spacing) return which + "has no PixelSpacing of two numbers";
      SlicePlace place;
      for (int n = 0; n < 3; ++n) {
        const auto index = static_cast<std::size_t>(n);
        place.position[n] = (*position)[index];
        place.row[n] = (*orientation)[index];
        place.column[n] = (*orientation)[index + 3];
      }
      place.row_spacing = (*spacing)[0];
      place.column_spacing = (*spacing)[1];
      place.name =
          path_.filename().string() + (frames > 1 ? " frame " + std::to_string(frame + 1) : "");
      file.frames.push_back(place);
      Scale scale;
      for (const bool is_slope : {true, false}) {
        const vtkDICOMTag& tag = is_slope ? kSlope : kIntercept;
        const vtkDICOMValue& value = data_->Get(0, frame, tag);
        if (!value.IsValid() || value.GetNumberOfValues() == 0) continue;
        const auto number = reals(frame, tag, 1);
        if (!number) return which + "has a rescale slope or intercept that is no number";
        (is_slope ? scale.slope : scale.intercept) = number->front();
      }
      file.scales.push_back(scale);
    }
    return {};
  }

  std::filesystem::path path_;
  vtkSmartPointer<vtkDICOMMetaData> data_;
  std::string error_;
  bool has_pixels_ = false;
  unsigned int pixel_length_ = 0;
  std::uint64_t pixel_offset_ = 0;
};

// The regular files of a directory by name.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  std::filesystem::directory_iterator entries(directory, error);
  for (const std::filesystem::directory_iterator end; !error && entries != end;
       entries.increment(error)) {
    std::error_code unreadable;
    if (entries->is_regular_file(unreadable)) files.push_back(entries->path());
  }
  if (error) throw FileError(directory, "cannot be read: " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}

// Whether to parse a file, and whether it must then be understood.
enum class Claim { none, perhaps, certain };

Claim dicom_claim(const std::filesystem::path& path) {
  const std::string head = read_head(path, 132);
  if (head.size() == 132 && head.compare(128, 4, "DICM") == 0) return Claim::certain;
  if (named_dicom(path)) return Claim::certain;
  return vtkDICOMUtilities::IsDICOMFile(path.c_str()) ? Claim::perhaps : Claim::none;
}

std::optional<bool> is_sequence(std::uint32_t tag) {
  const vtkDICOMDictEntry entry = vtkDICOMDictionary::FindDictEntry(vtkDICOMTag(
      static_cast<unsigned short>(tag >> 16), static_cast<unsigned short>(tag & 0xffffU)));
  if (!entry.IsValid()) return std::nullopt;
  return entry.GetVR() == vtkDICOMVR::SQ;
}

void add_file(const std::filesystem::path& path, std::map<std::string, DicomSeries>& by_uid) {
  const Claim claim = dicom_claim(path);
  if (claim == Claim::none) return;
  if (claim == Claim::certain && !vtkDICOMUtilities::IsDICOMFile(path.c_str())) {
    throw FileError(path, "is not DICOM, though its name says so; damaged or cut off?");
  }
  if (const std::string problem = check_dicom_elements(MappedFile(path).bytes(), is_sequence);
      !problem.empty()) {
    if (claim == Claim::perhaps) return;
    throw FileError(path, problem);
  }
  const Parser parser(path);
  if (parser.is_other()) return;
  if (const std::string error = parser.header_error(); !error.empty()) {
    if (claim == Claim::perhaps) return;
    throw FileError(path, error);
  }
  if (!parser.is_image()) return;
  const std::string uid = parser.text(kSeriesInstance);
  if (uid.empty()) {
    if (claim == Claim::perhaps) return;
    throw FileError(path, "has no SeriesInstanceUID; damaged or cut off?");
  }
  DicomSeries& series = by_uid[uid];
  if (series.files.empty()) {
    series.uid = uid;
    series.modality = parser.text(kModality);
    series.description = parser.text(kSeriesDescription);
    series.number = parser.integer(kSeriesNumber, 0);
  }
  series.files.push_back(parser.file());
}

}  // namespace

std::vector<DicomSeries> scan_dicom(const std::filesystem::path& directory) {
  std::map<std::string, DicomSeries> by_uid;
  for (const std::filesystem::path& path : files_in(directory)) add_file(path, by_uid);
  std::vector<DicomSeries> result;
  for (auto& [uid, series] : by_uid) result.push_back(std::move(series));
  std::stable_sort(result.begin(), result.end(),
                   [](const DicomSeries& a, const DicomSeries& b) { return a.number < b.number; });
  return result;
}

std::string series_list(const std::vector<DicomSeries>& series) {
  std::string list;
  for (std::size_t n = 0; n < series.size(); ++n) {
    const DicomSeries& one = series[n];
    std::size_t slices = 0;
    for (const DicomFile& file : one.files) slices += std::max<std::size_t>(file.frames.size(), 1);
    list +=
        "\n  " + std::to_string(n + 1) + ": " + printable(one.uid) + "  " + printable(one.modality);
    if (!one.description.empty()) list += " " + in_quotes(one.description);
    list += ", " + std::to_string(slices) + (slices == 1 ? " slice" : " slices") + " of " +
            std::to_string(one.files.front().columns) + " x " +
            std::to_string(one.files.front().rows);
  }
  return list;
}

const DicomSeries& choose_series(const std::vector<DicomSeries>& series,
                                 const std::string& selector, const std::filesystem::path& path) {
  if (series.empty()) {
    throw FileError(path, "holds no DICOM images (sub-directories are not searched)");
  }
  if (selector.empty()) {
    if (series.size() == 1) return series.front();
    throw FileError(
        path, "holds " + std::to_string(series.size()) +
                  " DICOM series; choose one with --series UID or number:" + series_list(series));
  }
  for (const DicomSeries& one : series) {
    if (one.uid == selector) return one;
  }
  const auto number = parse_integer(selector);
  if (number && *number >= 1 && static_cast<std::uint64_t>(*number) <= series.size()) {
    return series[static_cast<std::size_t>(*number) - 1];
  }
  throw FileError(path, "holds no DICOM series " + in_quotes(selector) + "; expected one of" +
                            series_list(series));
}

}  // namespace shape3d::apps
