// Point data carried over to the surface, and several contour values.

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkShortArray.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <catch2/catch.hpp>

#include "images.hpp"
#include "support/random_volume.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::zmc_vtk::test;

const Extent kExtent{-4, 15, 3, 17, 0, 16};

/// Samples of −1, 0, 1 or more, which make every kind of vertex.
vtkSmartPointer<vtkImageData> random_image(int magnitude) {
  const std::array<std::int64_t, 3> dims{20, 15, 17};
  const std::vector<int> values = shape3d::test::random_samples(dims, magnitude, 20, 5);
  std::size_t n = 0;
  return make_image(kExtent, VTK_SHORT, [&](int, int, int) { return values[n++]; });
}

double worst_difference(vtkPolyData* mesh, const char* name) {
  vtkDataArray* array = mesh->GetPointData()->GetArray(name);
  REQUIRE(array != nullptr);
  REQUIRE(array->GetNumberOfTuples() == mesh->GetNumberOfPoints());
  double worst = 0.0;
  for (vtkIdType v = 0; v < mesh->GetNumberOfPoints(); ++v)
    worst = std::max(worst, (Eigen::Vector3d(array->GetTuple3(v)) - point(mesh, v)).norm());
  return worst;
}

TEST_CASE("interpolated coordinates are those of the vertices", "[zmc_vtk]") {
  const auto image = random_image(GENERATE(1, 4));
  image->SetOrigin(16, -32, 64);  // so that coordinates are integers and halves
  image->SetSpacing(0.5, 1, 2);
  image->SetDirectionMatrix(0, 1, 0, -1, 0, 0, 0, 0, 1);
  add_coordinates<vtkDoubleArray>(image, "double");
  add_coordinates<vtkFloatArray>(image, "float");
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(image);
  filter->InterpolateAttributesOn();
  filter->SetTriangulation(GENERATE(0, 1));
  filter->SetZeroFaces(GENERATE(0, 1));
  SECTION("one value") {}
  SECTION("values of several surfaces") { filter->GenerateValues(3, -1.0, 1.0); }
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->Update();
  REQUIRE(filter->GetOutput()->GetNumberOfCells() > 1000);
  CHECK(worst_difference(filter->GetOutput(), "double") < 1e-12);
  CHECK(worst_difference(filter->GetOutput(), "float") < 2e-5);  // of 80 and three components
  filter->SetOutputPointsPrecision(vtkAlgorithm::SINGLE_PRECISION);
  filter->Update();
  CHECK(worst_difference(filter->GetOutput(), "double") < 2e-5);
}

TEST_CASE("interpolation of a cap takes the values at its border samples", "[zmc_vtk]") {
  const auto image = random_image(2);
  add_coordinates<vtkDoubleArray>(image, "double");
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(image);
  filter->InterpolateAttributesOn();
  filter->SetBorderToCapped();
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->Update();
  CHECK(worst_difference(filter->GetOutput(), "double") < std::ldexp(1.5, -20));
}

TEST_CASE("a piece interpolates the point data of its part of the image", "[zmc_vtk]") {
  const auto whole = random_image(3);
  vtkNew<PartSource> source;
  source->Produce(
      kExtent, [&](int i, int j, int k) { return whole->GetScalarComponentAsDouble(i, j, k, 0); });
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->InterpolateAttributesOn();
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  for (int piece = 0; piece < 4; ++piece) {
    filter->UpdatePiece(piece, 4, 0);
    REQUIRE(filter->GetOutput()->GetNumberOfCells() > 100);
    CHECK(worst_difference(filter->GetOutput(), "coordinates") < 1e-12);
  }
}

TEST_CASE("which arrays are interpolated, and their types", "[zmc_vtk]") {
  const auto image = random_image(2);
  const vtkIdType count = image->GetNumberOfPoints();
  const auto add = [&](vtkAbstractArray* array, const char* name) {
    array->SetName(name);
    array->SetNumberOfTuples(count);
    image->GetPointData()->AddArray(array);
  };
  vtkNew<vtkShortArray> narrow;
  vtkNew<vtkIntArray> wide;
  vtkNew<vtkDoubleArray> coordinates;
  vtkNew<vtkStringArray> words;
  vtkNew<vtkIdTypeArray> ids;
  vtkNew<vtkUnsignedCharArray> ghosts;
  coordinates->SetNumberOfComponents(2);
  add(narrow, "narrow");
  add(wide, "wide");
  add(coordinates, "coordinates");
  add(words, "words");
  add(ids, "ids");
  add(ghosts, vtkDataSetAttributes::GhostArrayName());
  narrow->Fill(3);
  wide->Fill(1 << 30);
  coordinates->Fill(0.25);
  ids->Fill(0);
  ghosts->Fill(0);
  image->GetPointData()->SetTCoords(coordinates);
  image->GetPointData()->SetGlobalIds(ids);
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(image);
  filter->Update();
  CHECK(filter->GetOutput()->GetPointData()->GetNumberOfArrays() == 2);  // scalars and normals
  filter->InterpolateAttributesOn();
  filter->ComputeScalarsOff();
  filter->ComputeNormalsOff();
  filter->Update();
  vtkPointData* data = filter->GetOutput()->GetPointData();
  CHECK(data->GetNumberOfArrays() == 3);
  CHECK(data->GetScalars() == nullptr);
  CHECK(data->GetNormals() == nullptr);
  CHECK(vtkFloatArray::SafeDownCast(data->GetArray("narrow")) != nullptr);
  CHECK(vtkDoubleArray::SafeDownCast(data->GetArray("wide")) != nullptr);
  CHECK(data->GetTCoords() == data->GetArray("coordinates"));
  double range[2];
  data->GetArray("narrow")->GetRange(range);
  CHECK((range[0] == 3 && range[1] == 3));
  data->GetArray("wide")->GetRange(range);
  CHECK((range[0] == (1 << 30) && range[1] == (1 << 30)));
}

TEST_CASE("values are contoured one after the other", "[zmc_vtk]") {
  const auto image = make_image({0, 20, 0, 21, 0, 22}, VTK_FLOAT, distance_from(10, 10, 11));
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(image);
  filter->ComputeGradientsOn();
  filter->SetNumberOfContours(4);
  const std::array<double, 4> values{700.25, 300.0, 1e6, 500.0};
  for (int n = 0; n < 4; ++n) filter->SetValue(n, values[n]);
  filter->Update();
  vtkNew<vtkPolyData> all;
  all->ShallowCopy(filter->GetOutput());
  CHECK(odd_edges(all) == 0);
  vtkDataArray* scalars = all->GetPointData()->GetScalars();
  filter->SetNumberOfContours(1);
  vtkIdType vertex = 0, cell = 0;
  for (const double value : values) {
    filter->SetValue(0, value);
    filter->Update();
    vtkPolyData* one = filter->GetOutput();
    CHECK((one->GetNumberOfCells() == 0) == (value == 1e6));
    bool same = true;
    for (vtkIdType t = 0; t < one->GetNumberOfCells(); ++t, ++cell) {
      for (int n = 0; n < 3; ++n)
        same = same && triangle(all, cell)[n] == vertex + triangle(one, t)[n];
    }
    for (vtkIdType v = 0; v < one->GetNumberOfPoints(); ++v, ++vertex) {
      same = same && point(all, vertex) == point(one, v) && scalars->GetTuple1(vertex) == value;
      for (const char* name : {"Normals", "Gradients"}) {
        for (int c = 0; c < 3; ++c)
          same = same && all->GetPointData()->GetArray(name)->GetComponent(vertex, c) ==
                             one->GetPointData()->GetArray(name)->GetComponent(v, c);
      }
    }
    INFO("value " << value);
    CHECK(same);
  }
  CHECK(vertex == all->GetNumberOfPoints());
  CHECK(cell == all->GetNumberOfCells());
}
}  // namespace
