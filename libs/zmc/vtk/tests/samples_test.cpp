// Types and layouts of samples.

#include <limits>

#include <vtkBitArray.h>
#include <vtkDoubleArray.h>
#include <vtkLongLongArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkShortArray.h>
#include <vtkUnsignedLongLongArray.h>
#include <catch2/catch.hpp>

#include "image_samples.hpp"
#include "images.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::zmc_vtk::test;

const Extent kExtent{1, 16, 2, 15, 3, 19};

/// 5 … 120, of both sides of 60 and often 60 itself.
double bumps(int i, int j, int k) {
  return std::round(62.0 + 40.0 * std::sin(0.6 * i) + 17.0 * std::sin(0.9 * j + 0.4 * k));
}

zmc::Surface<float> expected_surface(double value) {
  std::vector<double> samples;
  for (int k = 3; k <= 19; ++k) {
    for (int j = 2; j <= 15; ++j) {
      for (int i = 1; i <= 16; ++i) samples.push_back(bumps(i, j, k));
    }
  }
  zmc::Options options;
  options.inside = zmc::Inside::above;
  zmc::Surface<float> surface;
  REQUIRE(zmc::extract(zmc::make_view(samples.data(), {16, 14, 17}, {1, 1, 1}, {1, 2, 3}), value,
                       options, surface) == zmc::Status::ok);
  return surface;
}

TEST_CASE("every scalar type gives the same surface", "[zmc_vtk]") {
  const int type =
      GENERATE(VTK_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_INT,
               VTK_UNSIGNED_INT, VTK_LONG, VTK_UNSIGNED_LONG, VTK_LONG_LONG, VTK_UNSIGNED_LONG_LONG,
               VTK_FLOAT, VTK_DOUBLE, VTK_ID_TYPE);
  const double value = GENERATE(60.0, 60.5);
  const auto image = make_image(kExtent, type, bumps);
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(image);
  filter->SetValue(0, value);
  filter->Update();
  const auto expected = expected_surface(value);
  REQUIRE(expected.triangle_count() > 1000);
  INFO(image->GetScalarTypeAsString());
  CHECK(equals(filter->GetOutput(), expected));
  // Scalars keep their type unless it cannot hold the value.
  vtkDataArray* scalars = filter->GetOutput()->GetPointData()->GetScalars();
  REQUIRE(scalars != nullptr);
  const bool real = type == VTK_FLOAT || type == VTK_DOUBLE;
  CHECK(scalars->GetDataType() == (real || value == 60.0 ? type : VTK_DOUBLE));
  CHECK(scalars->GetNumberOfTuples() == expected.vertex_count());
  CHECK(scalars->GetTuple1(0) == value);
  CHECK(scalars->GetTuple1(scalars->GetNumberOfTuples() - 1) == value);
}

TEST_CASE("bits are samples", "[zmc_vtk]") {
  const auto image = make_image(kExtent, VTK_UNSIGNED_CHAR,
                                [](int i, int j, int k) { return bumps(i, j, k) > 60.0 ? 1 : 0; });
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(image);
  filter->SetValue(0, 0.5);
  filter->Update();
  vtkNew<vtkPolyData> expected;
  expected->DeepCopy(filter->GetOutput());
  REQUIRE(expected->GetNumberOfCells() > 1000);
  vtkNew<vtkBitArray> bits;
  bits->DeepCopy(image->GetPointData()->GetScalars());
  bits->SetName("samples");
  image->GetPointData()->SetScalars(bits);
  filter->Modified();
  filter->Update();
  REQUIRE(filter->GetOutput()->GetNumberOfPoints() == expected->GetNumberOfPoints());
  REQUIRE(filter->GetOutput()->GetNumberOfCells() == expected->GetNumberOfCells());
  for (vtkIdType v = 0; v < expected->GetNumberOfPoints(); ++v)
    REQUIRE((point(expected, v) == point(filter->GetOutput(), v)));
}

TEST_CASE("a component is read from between the others", "[zmc_vtk]") {
  const auto image = make_image(kExtent, VTK_SHORT, bumps);
  const vtkIdType count = image->GetNumberOfPoints();
  vtkDataArray* samples = image->GetPointData()->GetScalars();
  vtkSmartPointer<vtkDataArray> several;
  bool zero_copy = true;
  SECTION("array of structures") { several = vtkSmartPointer<vtkShortArray>::New(); }
  SECTION("structure of arrays") {
    several = vtkSmartPointer<vtkSOADataArrayTemplate<short>>::New();
  }
  SECTION("array of structures, converted") {
    several = vtkSmartPointer<vtkLongLongArray>::New();
    zero_copy = false;
  }
  SECTION("structure of arrays, converted") {
    several = vtkSmartPointer<vtkSOADataArrayTemplate<unsigned int>>::New();
    zero_copy = false;
  }
  several->SetName("several");
  several->SetNumberOfComponents(3);
  several->SetNumberOfTuples(count);
  for (vtkIdType id = 0; id < count; ++id) {
    several->SetComponent(id, 0, 7);
    several->SetComponent(id, 1, samples->GetTuple1(id));
    several->SetComponent(id, 2, static_cast<int>(id % 5));
  }
  image->GetPointData()->AddArray(several);
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(image);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "several");
  filter->SetArrayComponent(1);
  filter->SetValue(0, 60.5);
  filter->Update();
  CHECK(equals(filter->GetOutput(), expected_surface(60.5)));
  const auto view = zmc_vtk::image_samples(*image, *several, 1, kExtent);
  CHECK(view.converted.empty() == zero_copy);
}

TEST_CASE("integers of 64 bits are read when double holds them, else refused", "[zmc_vtk]") {
  const auto image = make_image(kExtent, VTK_LONG_LONG, bumps);
  auto* wide = vtkLongLongArray::SafeDownCast(image->GetPointData()->GetScalars());
  const vtkIdType at = wide->GetNumberOfTuples() / 2;
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(image);
  filter->SetValue(0, 60.5);
  const auto errors_with = [&](long long value) {
    wide->SetValue(at, value);
    wide->Modified();
    ErrorLog log(filter);
    filter->Modified();
    filter->Update();
    CHECK(log.errors().empty() == (filter->GetOutput()->GetNumberOfCells() > 0));
    return log.errors();
  };
  constexpr long long kExact = 1LL << 53;
  for (const long long value :
       {kExact, -kExact, kExact - 1, kExact + 2, std::numeric_limits<long long>::lowest(),
        (kExact - 1) << 10, -((kExact - 1) << 10)}) {
    INFO(value);
    CHECK(errors_with(value).empty());
  }
  for (const long long value :
       {kExact + 1, -kExact - 1, std::numeric_limits<long long>::max(), (kExact << 3) + 4}) {
    INFO(value);
    const auto errors = errors_with(value);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].find(std::to_string(value)) != std::string::npos);
    // at = i + 16 (j + 14 k), counted from (1, 2, 3)
    CHECK(errors[0].find("(1, 9, 11)") != std::string::npos);
  }
  vtkNew<vtkUnsignedLongLongArray> natural;
  natural->DeepCopy(image->GetPointData()->GetScalars());
  natural->SetValue(at, std::numeric_limits<unsigned long long>::max());
  CHECK_THROWS_AS(zmc_vtk::image_samples(*image, *natural, 0, kExtent), std::invalid_argument);
  natural->SetValue(at, 1ULL << 63);
  const auto samples = zmc_vtk::image_samples(*image, *natural, 0, kExtent);
  CHECK(samples.converted[static_cast<std::size_t>(at)] == 9223372036854775808.0);
}

TEST_CASE("a block of an image is viewed at its place", "[zmc_vtk]") {
  const int type = GENERATE(VTK_SHORT, VTK_UNSIGNED_INT);
  const auto image = make_image(kExtent, type, bumps);
  const Extent block{4, 9, 2, 6, 10, 19};
  const auto samples =
      zmc_vtk::image_samples(*image, *image->GetPointData()->GetScalars(), 0, block);
  CHECK(samples.view.dims == std::array<std::int64_t, 3>{6, 5, 10});
  CHECK((samples.view.origin == Eigen::Vector3d(4, 2, 10)));
  const auto strides = samples.view.effective_strides();
  for (int k = 0; k < 10; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 6; ++i) {
        const auto at = i * strides[0] + j * strides[1] + k * strides[2];
        const double sample = type == VTK_SHORT ? static_cast<const short*>(samples.view.data)[at]
                                                : static_cast<const double*>(samples.view.data)[at];
        REQUIRE(sample == bumps(i + 4, j + 2, k + 10));
        int index[3] = {i + 4, j + 2, k + 10};
        REQUIRE(samples.point(i, j, k) == image->ComputePointId(index));
      }
    }
  }
}
}  // namespace
