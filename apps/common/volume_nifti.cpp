#include <cmath>
#include <cstring>
#include <optional>

#include <Eigen/Geometry>

#include "error.hpp"
#include "text.hpp"
#include "volume_header.hpp"

namespace shape3d::apps {
namespace {

constexpr std::int64_t kNifti1Size = 348;
constexpr std::int64_t kNifti2Size = 540;

// A header in its own byte order. Offsets are those of nifti1.h and nifti2.h.
class Fields {
 public:
  Fields(std::string_view bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}

  template <class T>
  [[nodiscard]] T get(std::size_t offset) const {
    char word[sizeof(T)] = {};
    for (std::size_t index = 0; index < sizeof(T); ++index) {
      const std::size_t from = swapped_ ? sizeof(T) - 1 - index : index;
      word[index] = bytes_[offset + from];
    }
    T value;
    std::memcpy(&value, word, sizeof(T));
    return value;
  }

 private:
  std::string_view bytes_;
  bool swapped_;
};

// The fields used here, of either version.
struct Nifti {
  int version = 1;
  bool pair = false;  ///< Header and samples in two files.
  bool swapped = false;
  std::int64_t dim[8] = {};
  double pixdim[8] = {};
  int datatype = 0;
  double vox_offset = 0.0;
  double slope = 0.0;
  double intercept = 0.0;
  int units = 0;
  int qform_code = 0;
  int sform_code = 0;
  double quaternion[3] = {};
  double offset[3] = {};
  double srow[3][4] = {};
};

std::int32_t size_field(std::string_view bytes, bool swapped) {
  return Fields(bytes, swapped).get<std::int32_t>(0);
}

// The byte order in which the first field is a header size.
std::optional<bool> byte_order(std::string_view bytes) {
  if (bytes.size() < 4) return std::nullopt;
  for (const bool swapped : {false, true}) {
    const std::int32_t size = size_field(bytes, swapped);
    if (size == kNifti1Size || size == kNifti2Size) return swapped;
  }
  return std::nullopt;
}

template <class Dim, class Real, class Code>
void read_fields(const Fields& fields, const std::size_t (&at)[10], Nifti& nifti) {
  for (std::size_t n = 0; n < 8; ++n) {
    nifti.dim[n] = fields.get<Dim>(at[0] + n * sizeof(Dim));
    nifti.pixdim[n] = fields.get<Real>(at[1] + n * sizeof(Real));
  }
  nifti.datatype = fields.get<std::int16_t>(at[2]);
  nifti.slope = fields.get<Real>(at[3]);
  nifti.intercept = fields.get<Real>(at[4]);
  nifti.qform_code = fields.get<Code>(at[5]);
  nifti.sform_code = fields.get<Code>(at[6]);
  for (std::size_t n = 0; n < 3; ++n) {
    nifti.quaternion[n] = fields.get<Real>(at[7] + n * sizeof(Real));
    nifti.offset[n] = fields.get<Real>(at[8] + n * sizeof(Real));
    for (std::size_t m = 0; m < 4; ++m) {
      nifti.srow[n][m] = fields.get<Real>(at[9] + (4 * n + m) * sizeof(Real));
    }
  }
}

Nifti read_nifti(std::string_view bytes, const std::filesystem::path& path) {
  const std::optional<bool> swapped = byte_order(bytes);
  if (!swapped) {
    if (bytes.size() < kNifti1Size) {
      throw FileError(
          path, "is " + std::to_string(bytes.size()) + " bytes long; a NIfTI header alone has 348");
    }
    throw FileError(path, "is not NIfTI: its first number is " +
                              std::to_string(size_field(bytes, false)) +
                              "; expected the header size 348 or 540");
  }
  Nifti nifti;
  nifti.swapped = *swapped;
  const std::int64_t size = size_field(bytes, *swapped);
  if (static_cast<std::int64_t>(bytes.size()) < size) {
    throw FileError(path, "ends inside its NIfTI header: found " + std::to_string(bytes.size()) +
                              " of " + std::to_string(size) + " bytes");
  }
  const Fields fields(bytes, *swapped);
  std::string_view magic;
  if (size == kNifti1Size) {
    magic = bytes.substr(344, 4);
    nifti.pair = magic.substr(0, 3) == "ni1";
    if (!nifti.pair && magic.substr(0, 3) != "n+1") {
      throw FileError(
          path, "its NIfTI magic is " + in_quotes(magic.substr(0, 3)) +
                    "; expected \"n+1\" or \"ni1\" (ANALYZE 7.5 files do not say how they lie "
                    "in the patient and are not read)");
    }
    read_fields<std::int16_t, float, std::int16_t>(
        fields, {40, 76, 70, 112, 116, 252, 254, 256, 268, 280}, nifti);
    nifti.vox_offset = fields.get<float>(108);
    nifti.units = static_cast<unsigned char>(bytes[123]);
  } else {
    nifti.version = 2;
    magic = bytes.substr(4, 8);
    nifti.pair = magic.substr(0, 3) == "ni2";
    if (!nifti.pair && magic.substr(0, 3) != "n+2") {
      throw FileError(path, "its NIfTI magic is " + in_quotes(magic.substr(0, 3)) +
                                "; expected \"n+2\" or \"ni2\"");
    }
    read_fields<std::int64_t, double, std::int32_t>(
        fields, {16, 104, 12, 176, 184, 344, 348, 352, 376, 400}, nifti);
    nifti.vox_offset = static_cast<double>(fields.get<std::int64_t>(168));
    nifti.units = fields.get<std::int32_t>(500);
  }
  return nifti;
}

StoredType stored_type(int datatype, const std::filesystem::path& path) {
  switch (datatype) {
    case 2:
      return StoredType::uint8;
    case 4:
      return StoredType::int16;
    case 8:
      return StoredType::int32;
    case 16:
      return StoredType::float32;
    case 64:
      return StoredType::float64;
    case 256:
      return StoredType::int8;
    case 512:
      return StoredType::uint16;
    case 768:
      return StoredType::uint32;
    case 1024:
      return StoredType::int64;
    case 1280:
      return StoredType::uint64;
    default:
      break;
  }
  std::string name = "unknown";
  if (datatype == 1) name = "binary";
  if (datatype == 32 || datatype == 1792 || datatype == 2048) name = "complex numbers";
  if (datatype == 128) name = "RGB colours, 3 components a voxel";
  if (datatype == 2304) name = "RGBA colours, 4 components a voxel";
  if (datatype == 1536) name = "float128";
  throw FileError(path, "NIfTI datatype " + std::to_string(datatype) + " (" + name +
                            "); expected one real number a voxel");
}

// dim[0] axes; those after the third must have length 1.
void set_dims(const Nifti& nifti, VolumeHeader& header, const std::filesystem::path& path) {
  const std::int64_t rank = nifti.dim[0];
  if (rank < 1 || rank > 7) {
    throw FileError(path, "dim[0] is " + std::to_string(rank) + "; expected 3 to 7 axes");
  }
  if (rank < 3) {
    throw FileError(path, "has " + std::to_string(rank) + " axes; a volume has three");
  }
  for (std::size_t axis = 0; axis < 3; ++axis) header.dims[axis] = nifti.dim[axis + 1];
  for (std::int64_t axis = 4; axis <= rank; ++axis) {
    const std::int64_t length = nifti.dim[axis];
    if (length == 1 || length == 0) continue;
    const std::string what = axis == 4   ? " frames (4-D)"
                             : axis == 5 ? " components a voxel"
                                         : " entries along axis " + std::to_string(axis);
    throw FileError(path, "holds " + std::to_string(length) + what + "; expected one");
  }
}

double millimetres(int units, const std::filesystem::path& path) {
  switch (units & 7) {
    case 0:
    case 2:
      return 1.0;
    case 1:
      return 1000.0;
    case 3:
      return 0.001;
    default:
      throw FileError(path, "xyzt_units " + std::to_string(units) +
                                "; expected metres, millimetres or micrometres");
  }
}

// Rotation of method 2: the quaternion's first part follows from its length, 1.
Eigen::Matrix3d rotation(const Nifti& nifti, const std::filesystem::path& path) {
  const double b = nifti.quaternion[0];
  const double c = nifti.quaternion[1];
  const double d = nifti.quaternion[2];
  const double rest = 1.0 - (b * b + c * c + d * d);
  // Float rounding of three parts of at most 1.
  constexpr double kRounding = 1e-6;
  if (!(rest >= -kRounding)) {
    throw FileError(path, "qform quaternion (" + to_text(b) + ", " + to_text(c) + ", " +
                              to_text(d) + ") is longer than 1");
  }
  return Eigen::Quaterniond(std::sqrt(std::max(rest, 0.0)), b, c, d)
      .normalized()
      .toRotationMatrix();
}

}  // namespace

bool begins_like_nifti(std::string_view bytes) {
  const std::optional<bool> swapped = byte_order(bytes);
  if (!swapped) return false;
  const bool first = size_field(bytes, *swapped) == kNifti1Size;
  if (bytes.size() < (first ? 348U : 12U)) return false;
  const std::string_view magic = bytes.substr(first ? 344 : 4, 3);
  return first ? magic == "n+1" || magic == "ni1" : magic == "n+2" || magic == "ni2";
}

VolumeHeader parse_nifti_header(std::string_view bytes, const std::filesystem::path& path) {
  const Nifti nifti = read_nifti(bytes, path);
  VolumeHeader header;
  header.format = "NIfTI";
  header.type = stored_type(nifti.datatype, path);
  set_dims(nifti, header, path);

  // pixdim[0] is the handedness (0 counts as 1); the others are lengths, also beside an sform.
  for (int axis = 1; axis <= 3; ++axis) {
    if (std::isfinite(nifti.pixdim[axis]) && nifti.pixdim[axis] > 0.0) continue;
    throw FileError(path, "spacing pixdim[" + std::to_string(axis) + "] is " +
                              to_text(nifti.pixdim[axis]) + "; expected a finite positive number");
  }
  Eigen::Matrix3d columns = Eigen::Matrix3d::Zero();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  const Eigen::Vector3d pixdim(nifti.pixdim[1], nifti.pixdim[2], nifti.pixdim[3]);
  if (nifti.sform_code > 0) {
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 3; ++col) columns(row, col) = nifti.srow[row][col];
      origin[row] = nifti.srow[row][3];
    }
  } else if (nifti.qform_code > 0) {
    columns = rotation(nifti, path) * pixdim.asDiagonal();
    if (nifti.pixdim[0] < 0.0) columns.col(2) = -columns.col(2);
    origin = Eigen::Vector3d(nifti.offset[0], nifti.offset[1], nifti.offset[2]);
  } else {
    columns = pixdim.asDiagonal();
    header.warnings.push_back(
        "has neither sform nor qform: its axes are taken for right, anterior and superior");
  }
  const double scale = millimetres(nifti.units, path);
  const Eigen::Vector3d ras_to_lps(-scale, -scale, scale);
  set_affine(header, ras_to_lps.asDiagonal() * columns, ras_to_lps.cwiseProduct(origin), path);

  // A slope of 0 stands for no scaling; writers leave NaN for it, too.
  if (nifti.slope != 0.0 && std::isfinite(nifti.slope)) {
    header.slope = nifti.slope;
    header.intercept = nifti.intercept;
  }

  const double first = nifti.version == 1 ? 352.0 : 544.0;
  const double offset = nifti.vox_offset == 0.0 && !nifti.pair ? first : nifti.vox_offset;
  if (!(offset >= (nifti.pair ? 0.0 : first)) || !(offset <= 1e15) ||
      std::trunc(offset) != offset) {
    throw FileError(path, "vox_offset is " + to_text(nifti.vox_offset) +
                              "; expected a byte position of at least " +
                              to_text(nifti.pair ? 0.0 : first));
  }
  header.payload.byte_skip = static_cast<std::int64_t>(offset);
  header.payload.pair = nifti.pair;
  constexpr bool kHostIsBigEndian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
  header.payload.big_endian = nifti.swapped != kHostIsBigEndian;
  return header;
}

}  // namespace shape3d::apps
