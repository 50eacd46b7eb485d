// Arrays that were handed over behave as VTK's own.

#include <limits>

#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataNormals.h>
#include <catch2/catch.hpp>

#include "images.hpp"
#include "surface_arrays.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::zmc_vtk;
using namespace shape3d::zmc_vtk::test;

TEST_CASE("buffers become arrays at their address", "[zmc_vtk]") {
  zmc::detail::Buffer<float> buffer(3 << 20);
  for (std::size_t n = 0; n < buffer.size(); ++n) buffer[n] = static_cast<float>(n);
  const float* address = buffer.data();
  const auto array = adopt(std::move(buffer), 3);
  CHECK(array->GetPointer(0) == address);
  CHECK(array->GetNumberOfTuples() == 1 << 20);
  SECTION("a shallow copy outlives it") {
    vtkNew<vtkFloatArray> copy;
    copy->ShallowCopy(array);
    const_cast<vtkSmartPointer<vtkFloatArray>&>(array) = nullptr;
    CHECK(copy->GetComponent((1 << 20) - 1, 2) == (3 << 20) - 1);
  }
  SECTION("it grows and shrinks") {
    array->InsertNextTuple3(1, 2, 3);
    CHECK(array->GetNumberOfTuples() == (1 << 20) + 1);
    CHECK(array->GetComponent(1 << 20, 1) == 2);
    CHECK(array->GetComponent(77, 1) == 232);
    array->SetNumberOfTuples(100);
    array->Squeeze();
    CHECK(array->GetComponent(99, 2) == 299);
  }
  SECTION("it is emptied and filled again") {
    array->Initialize();
    array->SetNumberOfComponents(1);
    array->InsertNextValue(4);
    CHECK(array->GetValue(0) == 4);
  }
}

TEST_CASE("an empty buffer is an empty array", "[zmc_vtk]") {
  const auto array = adopt(zmc::detail::Buffer<double>(), 3);
  CHECK(array->GetNumberOfComponents() == 3);
  CHECK(array->GetNumberOfTuples() == 0);
}

template <class Index>
void check_triangles() {
  constexpr Index kCount = 50000;
  zmc::detail::Buffer<Index> corners(3 * kCount);
  for (Index n = 0; n < 3 * kCount; ++n) corners[n] = (7 * n) % 1000;
  const auto cells = make_triangles(std::move(corners));
  REQUIRE(cells->GetNumberOfCells() == kCount);
  CHECK(cells->IsStorage64Bit() == (sizeof(Index) == 8));
  CHECK(cells->IsValid());
  CHECK(cells->IsHomogeneous() == 3);
  for (const vtkIdType cell : {vtkIdType{0}, vtkIdType{1}, vtkIdType{kCount - 1}}) {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCellAtId(cell, size, ids);
    REQUIRE(size == 3);
    for (int n = 0; n < 3; ++n) CHECK(ids[n] == (7 * (3 * cell + n)) % 1000);
  }
  cells->InsertNextCell({1, 2, 3});
  CHECK(cells->GetNumberOfCells() == kCount + 1);
  CHECK(cells->ConvertToDefaultStorage());
  CHECK(cells->GetCellSize(kCount) == 3);
}

TEST_CASE("triangles are cells of 32 or 64 bits", "[zmc_vtk]") {
  check_triangles<std::int32_t>();
  check_triangles<std::int64_t>();
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  CHECK(fits_32_bits(kMost, kMost / 3));
  CHECK_FALSE(fits_32_bits(kMost + 1, 1));
  CHECK_FALSE(fits_32_bits(1, kMost / 3 + 1));
}

TEST_CASE("filters of VTK take the output and outlive its filter", "[zmc_vtk]") {
  vtkNew<vtkPolyDataNormals> normals;
  normals->SplittingOff();
  normals->ConsistencyOff();
  {
    vtkNew<vtkZeroCrossingMarchingCubes> filter;
    filter->SetInputData(
        make_image({0, 20, 0, 21, 0, 22}, VTK_INT, distance_from(10.1, 10.2, 11.3)));
    filter->SetValue(0, 700.5);
    filter->ComputeNormalsOff();
    filter->Update();
    normals->SetInputData(filter->GetOutput());
  }
  normals->Update();
  vtkPolyData* mesh = normals->GetOutput();
  REQUIRE(mesh->GetNumberOfPoints() > 500);
  // Inside above: the body is what lies outside of the sphere, so that its volume is negative.
  CHECK(signed_volume(mesh) ==
        Approx(-4.0 / 3.0 * 3.14159265 * 7.005 * 7.005 * 7.005).epsilon(0.02));
  int inward = 0;
  for (vtkIdType v = 0; v < mesh->GetNumberOfPoints(); ++v) {
    const Eigen::Vector3d n(mesh->GetPointData()->GetNormals()->GetTuple3(v));
    inward += n.dot(point(mesh, v) - Eigen::Vector3d(10.1, 10.2, 11.3)) < 0.0 ? 1 : 0;
  }
  CHECK(inward == mesh->GetNumberOfPoints());
}
}  // namespace
