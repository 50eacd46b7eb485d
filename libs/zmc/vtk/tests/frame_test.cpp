// Extents, frames, and equality with the library.

#include <vtkNew.h>
#include <vtkPointData.h>
#include <catch2/catch.hpp>

#include "images.hpp"
#include "support/random_volume.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::zmc_vtk::test;

const Extent kExtent{-5, 34, 100, 117, 7, 21};
const std::array<std::int64_t, 3> kDims{40, 18, 15};

/// Random integers with many zeros.
vtkSmartPointer<vtkImageData> random_image(int magnitude, std::vector<int>* samples = nullptr) {
  const std::vector<int> values = shape3d::test::random_samples(kDims, magnitude, 20, 99);
  if (samples != nullptr) *samples = values;
  return make_image(kExtent, VTK_SHORT, [&](int i, int j, int k) {
    const auto at = (i + 5) + kDims[0] * ((j - 100) + kDims[1] * (k - 7));
    return values[static_cast<std::size_t>(at)];
  });
}

TEST_CASE("the surface is the library's, for every setting", "[zmc_vtk]") {
  using Filter = vtkZeroCrossingMarchingCubes;
  std::vector<int> values;
  const auto image = random_image(3, &values);
  image->SetSpacing(0.5, 0.75, 2.0);
  image->SetOrigin(10.0, 20.0, 30.0);
  const std::vector<std::int16_t> samples(values.begin(), values.end());
  const auto view = zmc::make_view(samples.data(), kDims, {0.5, 0.75, 2.0},
                                   {10.0 - 5 * 0.5, 20.0 + 100 * 0.75, 30.0 + 7 * 2.0});
  zmc::Options options;
  vtkNew<Filter> filter;
  filter->SetInputData(image);
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  SECTION("as it is") { filter->SetInsideToBelow(); }
  SECTION("inside above") {
    filter->SetInsideToAbove();
    options.inside = zmc::Inside::above;
  }
  SECTION("positive") {
    filter->SetInsideToBelow();
    filter->SetTieRuleToPositive();
    options.ties = zmc::TieRule::positive;
  }
  SECTION("centroid") {
    filter->SetInsideToBelow();
    filter->SetTriangulationToCentroid();
    options.triangulation = zmc::Triangulation::centroid;
  }
  SECTION("mating") {
    filter->SetInsideToBelow();
    filter->SetZeroFacesToMating();
    options.zero_faces = zmc::ZeroFaces::mating;
  }
  SECTION("capped, two threads") {
    filter->SetInsideToBelow();
    filter->SetBorderToCapped();
    filter->SetNumberOfThreads(2);
    options.border = zmc::Border::capped;
  }
  filter->Update();
  zmc::Surface<double> expected;
  REQUIRE(zmc::extract(view, 0.0, options, expected) == zmc::Status::ok);
  REQUIRE(expected.triangle_count() > 1000);
  CHECK(equals(filter->GetOutput(), expected));

  filter->SetOutputPointsPrecision(vtkAlgorithm::DEFAULT_PRECISION);
  filter->Update();
  zmc::Surface<float> single;
  REQUIRE(zmc::extract(view, 0.0, options, single) == zmc::Status::ok);
  CHECK(filter->GetOutput()->GetPoints()->GetDataType() == VTK_FLOAT);
  CHECK(equals(filter->GetOutput(), single));
}

TEST_CASE("a capped surface is closed", "[zmc_vtk]") {
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(random_image(2));
  filter->SetBorderToCapped();
  filter->Update();
  REQUIRE(filter->GetOutput()->GetNumberOfCells() > 1000);
  CHECK(odd_edges(filter->GetOutput()) == 0);
}

TEST_CASE("vertices lie where the image puts its points, for any extent and direction",
          "[zmc_vtk]") {
  // f = x + 2y - 3z of the world: the surface f = 1.7 is known, and f grows along its gradient.
  const auto frame = GENERATE(0, 1, 2, 3);
  vtkNew<vtkImageData> geometry;
  geometry->SetExtent(-3, 9, 4, 17, -20, -9);
  geometry->SetOrigin(0.5, -4.0, 11.0);
  geometry->SetSpacing(0.5, 0.75, frame == 3 ? -1.0 : 1.0);
  const double c = std::cos(1.1), s = std::sin(1.1);
  if (frame == 1) geometry->SetDirectionMatrix(c, -s, 0, s, c, 0, 0, 0, 1);
  if (frame == 2) geometry->SetDirectionMatrix(0, 0, 1, 0, 1, 0, 1, 0, 0);  // left-handed
  const Eigen::Vector3d slope(1.0, 2.0, -3.0);
  double centre[3];
  geometry->TransformIndexToPhysicalPoint(3, 10, -15, centre);
  const double value = slope.dot(Eigen::Vector3d(centre)) + 0.123;
  const auto image = make_image({-3, 9, 4, 17, -20, -9}, VTK_DOUBLE, [&](int i, int j, int k) {
    double p[3];
    geometry->TransformIndexToPhysicalPoint(i, j, k, p);
    return slope.dot(Eigen::Vector3d(p));
  });
  image->SetOrigin(geometry->GetOrigin());
  image->SetSpacing(geometry->GetSpacing());
  image->SetDirectionMatrix(geometry->GetDirectionMatrix());

  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(image);
  filter->SetValue(0, value);
  filter->ComputeGradientsOn();
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->Update();
  vtkPolyData* mesh = filter->GetOutput();
  REQUIRE(mesh->GetNumberOfCells() > 50);
  double worst = 0.0, worst_gradient = 0.0, worst_normal = 0.0, least_along = 1.0;
  for (vtkIdType v = 0; v < mesh->GetNumberOfPoints(); ++v) {
    worst = std::max(worst, std::abs(slope.dot(point(mesh, v)) - value));
    const Eigen::Vector3d g(mesh->GetPointData()->GetVectors()->GetTuple3(v)),
        n(mesh->GetPointData()->GetNormals()->GetTuple3(v));
    worst_gradient = std::max(worst_gradient, (g - slope).norm());
    worst_normal = std::max(worst_normal, (n + slope.normalized()).norm());
  }
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell) {
    const Eigen::Vector3d area = area_vector(mesh, cell);
    if (area.norm() > 1e-9)
      least_along = std::min(least_along, -area.normalized().dot(slope.normalized()));
  }
  CHECK(worst < 1e-10);
  CHECK(worst_gradient < 1e-10);
  CHECK(worst_normal < 1e-10);
  CHECK(least_along > 1.0 - 1e-5);
}

TEST_CASE("pieces of an image tile its surface", "[zmc_vtk]") {
  const Field distance = distance_from(8.3, 7.1, 9.2);
  vtkNew<PartSource> source;
  source->Produce({0, 17, 0, 15, 0, 19},
                  [&](int i, int j, int k) { return std::floor(distance(i, j, k)); });
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->SetValue(0, 512.3);
  filter->Update();
  const vtkIdType whole = filter->GetOutput()->GetNumberOfCells();
  const double volume = signed_volume(filter->GetOutput());
  REQUIRE(whole > 500);
  vtkIdType sum = 0;
  double volume_sum = 0.0;
  for (int piece = 0; piece < 3; ++piece) {
    filter->UpdatePiece(piece, 3, 0);
    const vtkIdType part = filter->GetOutput()->GetNumberOfCells();
    CHECK(part < whole);
    sum += part;
    volume_sum += signed_volume(filter->GetOutput());
  }
  CHECK(sum == whole);
  CHECK(volume_sum == Approx(volume).epsilon(1e-6));
}
}  // namespace
