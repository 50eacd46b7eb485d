#include "volume_write.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <string_view>
#include <vector>

#include <zlib.h>
#include <Eigen/Geometry>

#include "error.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

constexpr bool kBigEndian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

// Deflates what it is given and hands on the compressed bytes.
class Deflater {
 public:
  using Sink = std::function<void(const unsigned char*, std::size_t)>;
  enum class Wrapper { zlib, gzip };

  Deflater(Wrapper wrapper, Sink sink, const std::string& path)
      : sink_(std::move(sink)), path_(path), buffer_(std::size_t{1} << 17) {
    constexpr int kWindow = 15, kMemory = 8, kGzip = 16, kLevel = 6;
    const int bits = kWindow + (wrapper == Wrapper::gzip ? kGzip : 0);
    check(deflateInit2(&stream_, kLevel, Z_DEFLATED, bits, kMemory, Z_DEFAULT_STRATEGY));
  }
  ~Deflater() { deflateEnd(&stream_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  void add(const void* data, std::size_t size) {
    constexpr std::size_t kMost = std::size_t{1} << 30;  // zlib counts in 32 bits
    const auto* bytes = static_cast<const unsigned char*>(data);
    while (size > 0) {
      const std::size_t part = std::min(size, kMost);
      stream_.next_in = const_cast<unsigned char*>(bytes);  // zlib's interface; it does not write
      stream_.avail_in = static_cast<uInt>(part);
      while (stream_.avail_in > 0) step(Z_NO_FLUSH);
      bytes += part;
      size -= part;
    }
  }
  void end() {
    while (step(Z_FINISH) != Z_STREAM_END) {
    }
  }

 private:
  int step(int flush) {
    stream_.next_out = buffer_.data();
    stream_.avail_out = static_cast<uInt>(buffer_.size());
    const int result = deflate(&stream_, flush);
    if (result != Z_STREAM_END && result != Z_BUF_ERROR) check(result);
    sink_(buffer_.data(), buffer_.size() - stream_.avail_out);
    return result;
  }
  void check(int result) const {
    if (result != Z_OK)
      throw FileError(path_, "cannot be compressed: zlib says " + std::to_string(result));
  }

  z_stream stream_{};
  Sink sink_;
  std::string path_;
  std::vector<unsigned char> buffer_;
};

// Calls give(bytes, size) for the samples, row by row, x fastest.
template <class Give>
void for_rows(const zmc::VolumeView& view, const Give& give) {
  const std::array<std::int64_t, 3> strides = view.effective_strides();
  const auto size = static_cast<std::int64_t>(zmc::sample_size(view.type));
  const auto* data = static_cast<const char*>(view.data);
  std::vector<char> gathered(static_cast<std::size_t>(view.dims[0] * size));
  for (std::int64_t k = 0; k < view.dims[2]; ++k) {
    for (std::int64_t j = 0; j < view.dims[1]; ++j) {
      const char* row = data + (j * strides[1] + k * strides[2]) * size;
      if (strides[0] != 1) {
        for (std::int64_t i = 0; i < view.dims[0]; ++i)
          std::memcpy(gathered.data() + i * size, row + i * strides[0] * size,
                      static_cast<std::size_t>(size));
        row = gathered.data();
      }
      give(row, static_cast<std::size_t>(view.dims[0] * size));
    }
  }
}

void add_rows(Deflater& deflater, const zmc::VolumeView& view) {
  for_rows(view, [&](const char* row, std::size_t size) { deflater.add(row, size); });
}

Deflater::Sink into(OutputFile& file) {
  return [&file](const unsigned char* bytes, std::size_t size) { file.write(bytes, size); };
}

std::string words(const Eigen::Vector3d& v, const char* between) {
  return to_text(v[0]) + between + to_text(v[1]) + between + to_text(v[2]);
}

std::string numbers(const std::array<std::int64_t, 3>& dims) {
  return std::to_string(dims[0]) + " " + std::to_string(dims[1]) + " " + std::to_string(dims[2]);
}

std::string nrrd_type(zmc::SampleType type) {
  switch (type) {
    case zmc::SampleType::float32:
      return "float";
    case zmc::SampleType::float64:
      return "double";
    default:
      return std::string(zmc::to_string(type));
  }
}

void write_nrrd(OutputFile& file, const zmc::VolumeView& view) {
  std::string header =
      "NRRD0004\ntype: " + nrrd_type(view.type) +
      "\ndimension: 3\nspace: left-posterior-superior\nsizes: " + numbers(view.dims) +
      "\nspace directions:";
  for (int axis = 0; axis < 3; ++axis)
    header += " (" + words(view.direction.col(axis) * view.spacing[axis], ",") + ")";
  header += "\nkinds: domain domain domain\nspace units: \"mm\" \"mm\" \"mm\"\n";
  if (zmc::sample_size(view.type) > 1)
    header += std::string("endian: ") + (kBigEndian ? "big" : "little") + "\n";
  header += "encoding: gzip\nspace origin: (" + words(view.origin, ",") + ")\n\n";
  file.write(header);
  Deflater deflater(Deflater::Wrapper::gzip, into(file), file.path());
  add_rows(deflater, view);
  deflater.end();
}

std::string metaimage_type(zmc::SampleType type) {
  switch (type) {
    case zmc::SampleType::int8:
      return "MET_CHAR";
    case zmc::SampleType::uint8:
      return "MET_UCHAR";
    case zmc::SampleType::int16:
      return "MET_SHORT";
    case zmc::SampleType::uint16:
      return "MET_USHORT";
    case zmc::SampleType::int32:
      return "MET_INT";
    case zmc::SampleType::float32:
      return "MET_FLOAT";
    case zmc::SampleType::float64:
      return "MET_DOUBLE";
  }
  return {};
}

void write_metaimage(OutputFile& file, const zmc::VolumeView& view) {
  // The header names the size of the compressed samples, which come after it.
  std::vector<unsigned char> bytes;
  Deflater deflater(
      Deflater::Wrapper::zlib,
      [&bytes](const unsigned char* part, std::size_t size) {
        bytes.insert(bytes.end(), part, part + size);
      },
      file.path());
  add_rows(deflater, view);
  deflater.end();
  std::string header =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = " +
      std::string(kBigEndian ? "True" : "False") +
      "\nCompressedData = True\nCompressedDataSize = " + std::to_string(bytes.size()) +
      "\nTransformMatrix = ";
  for (int axis = 0; axis < 3; ++axis)
    header += words(view.direction.col(axis), " ") + (axis < 2 ? " " : "\n");
  header += "Offset = " + words(view.origin, " ") +
            "\nCenterOfRotation = 0 0 0\nAnatomicalOrientation = RAI\nElementSpacing = " +
            words(view.spacing, " ") + "\nDimSize = " + numbers(view.dims) +
            "\nElementType = " + metaimage_type(view.type) + "\nElementDataFile = LOCAL\n";
  file.write(header);
  file.write(bytes.data(), bytes.size());
}

class NiftiHeader {
 public:
  template <class T>
  void set(std::size_t at, T value) {
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  void set_floats(std::size_t at, std::initializer_list<double> values) {
    for (const double value : values) {
      set(at, static_cast<float>(value));
      at += sizeof(float);
    }
  }
  [[nodiscard]] const std::array<char, 352>& bytes() const { return bytes_; }

 private:
  std::array<char, 352> bytes_{};  // and the four of "no extensions"
};

std::int16_t nifti_type(zmc::SampleType type) {
  switch (type) {
    case zmc::SampleType::int8:
      return 256;
    case zmc::SampleType::uint8:
      return 2;
    case zmc::SampleType::int16:
      return 4;
    case zmc::SampleType::uint16:
      return 512;
    case zmc::SampleType::int32:
      return 8;
    case zmc::SampleType::float32:
      return 16;
    case zmc::SampleType::float64:
      return 64;
  }
  return 0;
}

// The quaternion of the axes in RAS, with the third turned round for a left-handed triple.
void set_qform(NiftiHeader& header, const Eigen::Matrix3d& axes, const Eigen::Vector3d& origin) {
  Eigen::Matrix3d rotation = axes;
  const double handedness = axes.determinant() < 0.0 ? -1.0 : 1.0;
  rotation.col(2) *= handedness;
  Eigen::Quaterniond q(rotation);
  q.normalize();
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  header.set(252, std::int16_t{1});
  header.set_floats(76, {handedness});
  header.set_floats(256, {q.x(), q.y(), q.z(), origin[0], origin[1], origin[2]});
}

NiftiHeader nifti_header(const zmc::VolumeView& view, const std::string& path) {
  NiftiHeader header;
  header.set(0, std::int32_t{348});
  header.set(38, 'r');
  header.set(40, std::int16_t{3});
  for (std::size_t axis = 0; axis < 7; ++axis) {
    const std::int64_t size = axis < 3 ? view.dims[axis] : 1;
    if (size > 32767)
      throw FileError(path, "axis " + std::to_string(axis) + " has " + std::to_string(size) +
                                " samples; NIfTI-1 holds up to 32767");
    header.set(42 + 2 * axis, static_cast<std::int16_t>(size));
  }
  header.set(70, nifti_type(view.type));
  header.set(72, static_cast<std::int16_t>(8 * zmc::sample_size(view.type)));
  header.set_floats(76, {1.0, view.spacing[0], view.spacing[1], view.spacing[2]});
  header.set_floats(108, {352.0, 1.0, 0.0});  // vox_offset, scl_slope, scl_inter
  header.set(123, char{2});                   // millimetres
  constexpr std::string_view kProgram = "Shape3D";
  for (std::size_t n = 0; n < kProgram.size(); ++n) header.set(148 + n, kProgram[n]);  // descrip
  const Eigen::Vector3d lps_to_ras(-1.0, -1.0, 1.0);
  const Eigen::Matrix3d axes = lps_to_ras.asDiagonal() * view.direction;
  const Eigen::Vector3d origin = lps_to_ras.cwiseProduct(view.origin);
  header.set(254, std::int16_t{1});  // sform: scanner
  for (int row = 0; row < 3; ++row) {
    header.set_floats(280 + 16 * static_cast<std::size_t>(row),
                      {axes(row, 0) * view.spacing[0], axes(row, 1) * view.spacing[1],
                       axes(row, 2) * view.spacing[2], origin[row]});
  }
  // A rotation to the precision of the float in which it is stored.
  if ((axes.transpose() * axes - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6)
    set_qform(header, axes, origin);
  header.set(344, 'n');
  header.set(345, '+');
  header.set(346, '1');
  return header;
}

void write_nifti(OutputFile& file, const zmc::VolumeView& view) {
  const NiftiHeader header = nifti_header(view, file.path());
  const std::string name = lower_case(file.path());
  if (name.size() >= 4 && name.compare(name.size() - 4, 4, ".nii") == 0) {
    file.write(header.bytes().data(), header.bytes().size());
    for_rows(view, [&](const char* row, std::size_t size) { file.write(row, size); });
    return;
  }
  Deflater deflater(Deflater::Wrapper::gzip, into(file), file.path());
  deflater.add(header.bytes().data(), header.bytes().size());
  add_rows(deflater, view);
  deflater.end();
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

std::optional<VolumeFormat> written_volume_format(const std::string& path) {
  const std::string name = lower_case(path);
  if (ends_with(name, ".nrrd")) return VolumeFormat::nrrd;
  if (ends_with(name, ".nii") || ends_with(name, ".nii.gz")) return VolumeFormat::nifti;
  if (ends_with(name, ".mha")) return VolumeFormat::metaimage;
  return std::nullopt;
}

std::string unknown_volume_extension(const std::string& path) {
  return "unknown extension '" + std::filesystem::path(path).extension().string() +
         "', expected .nrrd, .nii.gz, .nii or .mha";
}

void write_volume(OutputFile& file, VolumeFormat format, const zmc::VolumeView& view) {
  zmc::validate(view);
  switch (format) {
    case VolumeFormat::nrrd:
      return write_nrrd(file, view);
    case VolumeFormat::nifti:
      return write_nifti(file, view);
    case VolumeFormat::metaimage:
      return write_metaimage(file, view);
    case VolumeFormat::dicom:
    case VolumeFormat::vti:
      break;
  }
  throw FileError(file.path(), "volumes are not written as " + std::string(to_string(format)) +
                                   "; expected NRRD, NIfTI or MetaImage");
}

}  // namespace shape3d::apps
