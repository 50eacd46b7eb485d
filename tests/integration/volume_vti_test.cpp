#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataWriter.h>

#include "common/error.hpp"
#include "common/volume_io.hpp"
#include "made_volumes.hpp"

namespace {

using namespace shape3d::apps;
using namespace shape3d::test;

/// An oblique image of 5 x 4 x 3 samples whose extent does not begin at 0.
vtkSmartPointer<vtkImageData> make_image(int type) {
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(2, 6, -1, 2, 0, 2);
  image->SetSpacing(0.75, 0.5, 2.0);
  image->SetOrigin(-10.0, 20.0, 5.5);
  // A rotation by the quaternion (1, 2, 3, 4) / √30.
  image->SetDirectionMatrix(-20.0 / 30, 4.0 / 30, 22.0 / 30, 20.0 / 30, -10.0 / 30, 20.0 / 30,
                            10.0 / 30, 28.0 / 30, 4.0 / 30);
  image->AllocateScalars(type, 1);
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  scalars->SetName("density");
  for (vtkIdType n = 0; n < scalars->GetNumberOfTuples(); ++n) {
    scalars->SetTuple1(n, static_cast<double>((37 * n) % 101));
  }
  return image;
}

struct Layout {
  int mode = vtkXMLWriter::Appended;
  bool encode = false;
  int compressor = vtkXMLWriter::NONE;
  int header = vtkXMLWriter::UInt32;
  int order = vtkXMLWriter::LittleEndian;
};

void write_image(const std::filesystem::path& path, vtkImageData* image, const Layout& layout) {
  const auto writer = vtkSmartPointer<vtkXMLImageDataWriter>::New();
  writer->SetFileName(path.c_str());
  writer->SetInputData(image);
  writer->SetDataMode(layout.mode);
  writer->SetEncodeAppendedData(layout.encode ? 1 : 0);
  writer->SetCompressorType(layout.compressor);
  writer->SetHeaderType(layout.header);
  writer->SetByteOrder(layout.order);
  // Several blocks, the last of them not full.
  writer->SetBlockSize(64);
  REQUIRE(writer->Write() == 1);
}

/// Every way in which VTK stores arrays.
std::vector<Layout> layouts() {
  std::vector<Layout> result;
  for (const int order : {vtkXMLWriter::LittleEndian, vtkXMLWriter::BigEndian}) {
    for (const int header : {vtkXMLWriter::UInt32, vtkXMLWriter::UInt64}) {
      for (const int compressor :
           {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4, vtkXMLWriter::LZMA}) {
        result.push_back({vtkXMLWriter::Appended, false, compressor, header, order});
        result.push_back({vtkXMLWriter::Appended, true, compressor, header, order});
        result.push_back({vtkXMLWriter::Binary, false, compressor, header, order});
      }
    }
  }
  result.push_back({vtkXMLWriter::Ascii, false, vtkXMLWriter::NONE, vtkXMLWriter::UInt32,
                    vtkXMLWriter::LittleEndian});
  return result;
}

/// The message of the FileError; empty when the file is read. Nothing may be printed.
std::string error_of(const std::filesystem::path& path) {
  std::string message;
  ConsoleCapture console;
  try {
    static_cast<void>(read_volume(path));
  } catch (const FileError& error) {
    message = error.what();
  }
  CHECK(console.stop().empty());
  if (!message.empty()) CHECK_THAT(message, Catch::StartsWith(path.string() + ": "));
  return message;
}

TEST_CASE("VTI: every layout has the values and places of VTK's image", "[volume][vti]") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "image.vti";
  const auto image = make_image(VTK_SHORT);
  for (const Layout& layout : layouts()) {
    INFO("mode " << layout.mode << " encode " << layout.encode << " compressor "
                 << layout.compressor << " header " << layout.header << " order " << layout.order);
    write_image(path, image, layout);
    const Volume volume = read_volume(path);
    CHECK(volume.format == "VTI");
    REQUIRE(volume.view.dims == std::array<std::int64_t, 3>{5, 4, 3});
    REQUIRE(volume.view.type == shape3d::zmc::SampleType::int16);
    const std::vector<double> values = sample_values(volume);
    vtkDataArray* scalars = image->GetPointData()->GetScalars();
    for (vtkIdType n = 0; n < 60; ++n) {
      REQUIRE(values[static_cast<std::size_t>(n)] == scalars->GetTuple1(n));
    }
    for (const auto& p :
         {Eigen::Vector3i(0, 0, 0), Eigen::Vector3i(4, 3, 2), Eigen::Vector3i(1, 2, 0)}) {
      double expected[3] = {};
      image->TransformIndexToPhysicalPoint(p[0] + 2, p[1] - 1, p[2], expected);
      const Eigen::Vector3d place = volume.view.world(p.cast<double>());
      CHECK((place - Eigen::Vector3d(expected[0], expected[1], expected[2])).norm() < 1e-12);
    }
    CHECK(volume.warnings.empty());
  }
}

TEST_CASE("VTI: every type of samples", "[volume][vti]") {
  using shape3d::zmc::SampleType;
  const auto [vtk, type] =
      GENERATE(table<int, SampleType>({{VTK_SIGNED_CHAR, SampleType::int8},
                                       {VTK_UNSIGNED_CHAR, SampleType::uint8},
                                       {VTK_SHORT, SampleType::int16},
                                       {VTK_UNSIGNED_SHORT, SampleType::uint16},
                                       {VTK_INT, SampleType::int32},
                                       {VTK_UNSIGNED_INT, SampleType::int32},
                                       {VTK_LONG_LONG, SampleType::int32},
                                       {VTK_UNSIGNED_LONG_LONG, SampleType::int32},
                                       {VTK_FLOAT, SampleType::float32},
                                       {VTK_DOUBLE, SampleType::float64}}));
  const TemporaryFolder folder;
  const auto image = make_image(vtk);
  write_image(folder / "image.vti", image, {});
  const Volume volume = read_volume(folder / "image.vti");
  CHECK(volume.view.type == type);
  const std::vector<double> values = sample_values(volume);
  for (vtkIdType n = 0; n < 60; ++n) {
    REQUIRE(values[static_cast<std::size_t>(n)] ==
            image->GetPointData()->GetScalars()->GetTuple1(n));
  }
}

TEST_CASE("VTI: every beginning of a file is refused", "[volume][vti]") {
  const TemporaryFolder folder;
  const std::filesystem::path whole = folder / "whole.vti";
  const std::filesystem::path path = folder / "cut.vti";
  const auto image = make_image(VTK_SHORT);
  for (const Layout& layout : layouts()) {
    if (layout.order != vtkXMLWriter::LittleEndian) continue;
    INFO("mode " << layout.mode << " encode " << layout.encode << " compressor "
                 << layout.compressor << " header " << layout.header);
    write_image(whole, image, layout);
    const std::string bytes = read_bytes(whole);
    // Behind appended data only tags are left, which say nothing.
    std::size_t end = bytes.rfind("</AppendedData>");
    end = end == std::string::npos ? bytes.rfind('>') : bytes.find_last_not_of(" \r\n", end - 1);
    for (std::size_t length = 0; length <= end; length += length < 400 ? 37 : 1) {
      write_bytes(path, bytes.substr(0, length));
      INFO("the first " << length << " of " << bytes.size() << " bytes");
      REQUIRE_FALSE(error_of(path).empty());
    }
  }
}

TEST_CASE("VTI: what a header must not say", "[volume][vti]") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "image.vti";
  write_image(path, make_image(VTK_SHORT), {});
  const std::string good = read_bytes(path);
  REQUIRE(error_of(path).empty());
  struct Case {
    const char* from;
    const char* to;
    std::vector<const char*> says;
  };
  const std::vector<Case> cases{
      {"type=\"ImageData\"",
       "type=\"PolyData\"",
       {"attribute type of VTKFile is \"PolyData\"; expected ImageData"}},
      {"WholeExtent=\"2 6 ", "WholeExtent=\"2 1 ", {"dimensions 0 x 4 x 3", "0 along i"}},
      {"WholeExtent=\"2 6 ", "WholeExtent=\"2 -6 ", {"dimensions -7 x 4 x 3"}},
      {"WholeExtent=\"2 6 ", "WholeExtent=\"2 2 ", {"one sample thick along i"}},
      {"WholeExtent=\"2 6 ", "WholeExtent=\"2 x ", {"WholeExtent", "expected six 32-bit integers"}},
      {"WholeExtent=\"2 6 ", "WholeExtent=\"2 99999999999 ", {"expected six 32-bit integers"}},
      {"WholeExtent=\"2 6 ", "WholeExtent=\"2 7 ", {"pieces do not fill the whole image"}},
      {"WholeExtent=\"2 6 ", "WholeExtent=\"2 5 ", {"a piece has samples 2 to 6 along axis 1"}},
      {"Spacing=\"0.75 ", "Spacing=\"0 ", {"spacing 0 along i"}},
      {"Spacing=\"0.75 ", "Spacing=\"-0.75 ", {"spacing -0.75 along i"}},
      {"Spacing=\"0.75 ", "Spacing=\"nan ", {"spacing nan along i"}},
      {"Spacing=\"0.75 ", "Spacing=\"inf ", {"spacing inf along i"}},
      {"Spacing=\"0.75 ", "Spacing=\"1 0.75 ", {"Spacing", "expected 3 numbers"}},
      {"Origin=\"-10 ", "Origin=\"nan ", {"origin", "is not finite"}},
      {"Direction=\"", "Direction=\"0 0 0 0 0 0 0 0 0\" D=\"", {"direction is singular"}},
      {"type=\"Int16\"", "type=\"Bit\"", {"array \"density\" has type \"Bit\""}},
      {"type=\"Int16\"", "type=\"Int32\"", {"holds 120 bytes; expected 240"}},
      {"type=\"Int16\"", "type=\"Int16\" NumberOfComponents=\"3\"", {"holds 3 components a voxel"}},
      {"Name=\"density\"", "Name=\"other\"", {"a piece has no array \"density\""}},
      {"Scalars=\"density\"", "", {}},
      {"offset=\"0\"", "offset=\"-1\"", {"attribute offset of DataArray is \"-1\""}},
      {"offset=\"0\"", "offset=\"1\"", {"array \"density\""}},
      {"offset=\"0\"", "offset=\"999999999\"", {"is cut off: array \"density\""}},
      {"byte_order=\"LittleEndian\"", "byte_order=\"Middle\"", {"byte_order", "\"Middle\""}},
      {"header_type=\"UInt32\"", "header_type=\"UInt8\"", {"header_type", "\"UInt8\""}},
      {"<Piece ", "<Piece x=y ", {"XML tag", "name=\"value\""}},
      {"<PointData", "<CellData", {"holds no point data"}},
  };
  for (const Case& one : cases) {
    INFO(one.from << " -> " << one.to);
    std::string bytes = good;
    const std::size_t at = bytes.find(one.from);
    REQUIRE(at != std::string::npos);
    bytes.replace(at, std::string(one.from).size(), one.to);
    write_bytes(path, bytes);
    const std::string message = error_of(path);
    CHECK(message.empty() == one.says.empty());
    for (const char* says : one.says) CHECK_THAT(message, Catch::Contains(says));
  }
}

TEST_CASE("VTI: which of several arrays is read", "[volume][vti]") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "image.vti";
  const auto image = make_image(VTK_SHORT);
  const auto other = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(VTK_FLOAT));
  other->SetName("other");
  other->SetNumberOfTuples(60);
  other->Fill(7.5);
  image->GetPointData()->AddArray(other);
  write_image(path, image, {});
  CHECK(read_volume(path).view.type == shape3d::zmc::SampleType::int16);
  image->GetPointData()->SetActiveScalars("other");
  write_image(path, image, {});
  const Volume volume = read_volume(path);
  CHECK(volume.view.type == shape3d::zmc::SampleType::float32);
  CHECK(sample_values(volume) == std::vector<double>(60, 7.5));
  image->GetPointData()->SetActiveScalars(nullptr);
  write_image(path, image, {});
  CHECK_THAT(error_of(path), Catch::Contains("holds several arrays (\"density\", \"other\")"));
}

TEST_CASE("VTI: a header that asks for more than the file can hold", "[volume][vti]") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "image.vti";
  for (const Layout& layout : layouts()) {
    write_image(path, make_image(VTK_SHORT), layout);
    std::string bytes = read_bytes(path);
    for (const char* name : {"WholeExtent=\"", "Extent=\""}) {
      std::size_t at = bytes.find(name);
      if (std::string(name) == "Extent=\"") at = bytes.find(name, bytes.find("<Piece"));
      REQUIRE(at != std::string::npos);
      at += std::string(name).size();
      bytes.replace(at, bytes.find('"', at) - at, "0 20000 0 20000 0 20000");
    }
    write_bytes(path, bytes);
    const std::string message = error_of(path);
    INFO(message);
    REQUIRE_FALSE(message.empty());
  }
}

}  // namespace
