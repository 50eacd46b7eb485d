// Errors, progress, abort, and what the pipeline sees.

#include <algorithm>
#include <limits>
#include <sstream>

#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <catch2/catch.hpp>

#include "images.hpp"

namespace {
using namespace shape3d::zmc_vtk::test;
using Catch::Matchers::Contains;

const Extent kExtent{3, 22, -4, 15, 7, 26};

vtkSmartPointer<vtkImageData> sphere_image(int type = VTK_FLOAT) {
  return make_image(kExtent, type, distance_from(12.2, 5.3, 16.4));
}

/// The filter's one error on an image; the output is empty.
std::string error_of(vtkZeroCrossingMarchingCubes* filter) {
  ErrorLog log(filter);
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfPoints() == 0);
  CHECK(filter->GetOutput()->GetNumberOfCells() == 0);
  CHECK(log.errors().size() == 1);
  return log.errors().empty() ? "" : log.errors().front();
}

TEST_CASE("an image that the value does not divide gives an empty surface", "[zmc_vtk]") {
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(sphere_image());
  filter->SetValue(0, 1e9);
  filter->InterpolateAttributesOn();
  filter->ComputeGradientsOn();
  ErrorLog log(filter);
  filter->Update();
  CHECK(log.errors().empty());
  CHECK(filter->GetOutput()->GetNumberOfPoints() == 0);
  CHECK(filter->GetOutput()->GetNumberOfCells() == 0);
  REQUIRE(filter->GetOutput()->GetPoints() != nullptr);
  filter->SetValue(0, 500.0);  // and then a surface
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() > 100);
  filter->SetNumberOfContours(0);
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() == 0);
  CHECK(log.errors().empty());
}

TEST_CASE("an image without points gives an empty surface", "[zmc_vtk]") {
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  vtkNew<vtkImageData> image;
  filter->SetInputData(image);
  ErrorLog log(filter);
  filter->Update();
  CHECK(log.errors().empty());
  CHECK(filter->GetOutput()->GetNumberOfCells() == 0);
}

TEST_CASE("errors name what is wrong", "[zmc_vtk]") {
  const auto image = sphere_image();
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(image);
  filter->SetValue(0, 500.0);
  SECTION("no scalars") {
    image->GetPointData()->Initialize();
    CHECK_THAT(error_of(filter), Contains("array to process: expected point data"));
  }
  SECTION("no such array") {
    filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "nope");
    CHECK_THAT(error_of(filter), Contains("array to process: expected point data"));
  }
  SECTION("cell data") {
    vtkNew<vtkFloatArray> cells;
    cells->SetName("of cells");
    cells->SetNumberOfTuples(image->GetNumberOfCells());
    cells->Fill(0);
    image->GetCellData()->AddArray(cells);
    filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "of cells");
    CHECK_THAT(error_of(filter), Contains("'of cells'") && Contains("point data"));
  }
  SECTION("too few tuples") {
    vtkNew<vtkFloatArray> few;
    few->SetName("few");
    few->SetNumberOfTuples(12);
    few->Fill(0);
    image->GetPointData()->SetScalars(few);
    CHECK_THAT(error_of(filter), Contains("'few'") && Contains("8000") && Contains("12"));
  }
  SECTION("component") {
    filter->SetArrayComponent(GENERATE(-1, 1));
    CHECK_THAT(error_of(filter), Contains("component") && Contains("'samples'") &&
                                     Contains(std::to_string(filter->GetArrayComponent())));
  }
  SECTION("words") {
    vtkNew<vtkStringArray> words;
    words->SetName("words");
    words->SetNumberOfTuples(image->GetNumberOfPoints());
    image->GetPointData()->AddArray(words);
    filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "words");
    CHECK_THAT(error_of(filter), Contains("array to process: expected point data of numbers"));
  }
  SECTION("flat image") {
    filter->SetInputData(make_image({0, 9, 0, 9, 4, 4}, VTK_FLOAT, distance_from(5, 5, 4)));
    CHECK_THAT(error_of(filter), Contains("at least 2") && Contains("[0, 9] x [0, 9] x [4, 4]"));
  }
  SECTION("spacing") {
    image->SetSpacing(1.0, 0.0, 1.0);
    CHECK_THAT(error_of(filter), Contains("spacing"));
  }
  SECTION("value") {
    filter->SetValue(0, std::numeric_limits<double>::quiet_NaN());
    CHECK_THAT(error_of(filter), Contains("isovalue"));
  }
  SECTION("a sample that is not finite") {
    image->GetPointData()->GetScalars()->SetTuple1(400, std::nan(""));
    CHECK_THAT(error_of(filter), Contains("0, 0, 1"));
    filter->SetNonFiniteToMask();
    filter->Update();
    CHECK(filter->GetOutput()->GetNumberOfCells() > 100);
  }
}

TEST_CASE("progress rises to one, and an abort empties the output", "[zmc_vtk]") {
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(sphere_image());
  filter->SetValue(0, 500.0);
  struct Seen {
    std::vector<double> shares;
    std::size_t stop = std::numeric_limits<std::size_t>::max();
  } seen;
  vtkNew<vtkCallbackCommand> watch;
  watch->SetClientData(&seen);
  watch->SetCallback([](vtkObject* caller, unsigned long, void* data, void* share) {
    auto& s = *static_cast<Seen*>(data);
    s.shares.push_back(*static_cast<double*>(share));
    if (s.shares.size() == s.stop) static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
  });
  filter->AddObserver(vtkCommand::ProgressEvent, watch);
  filter->Update();
  const vtkIdType cells = filter->GetOutput()->GetNumberOfCells();
  REQUIRE(cells > 100);
  REQUIRE(seen.shares.size() > 10);
  CHECK(std::is_sorted(seen.shares.begin(), seen.shares.end()));
  CHECK(seen.shares.back() == 1.0);
  const std::size_t all = seen.shares.size();
  for (std::size_t stop = 2; stop + 2 < all; stop += 3) {
    seen.shares.clear();
    seen.stop = stop;
    filter->Modified();
    filter->Update();
    INFO("aborted at event " << stop << " of " << all);
    CHECK(filter->GetOutput()->GetNumberOfCells() == 0);
    CHECK(filter->GetOutput()->GetNumberOfPoints() == 0);
    CHECK(seen.shares.size() <= stop + 1);  // the executive may send a last one
  }
  seen.shares.clear();
  seen.stop = std::numeric_limits<std::size_t>::max();
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() == cells);
}

TEST_CASE("a new value makes the filter run again, nothing new does not", "[zmc_vtk]") {
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetInputData(sphere_image());
  filter->SetValue(0, 500.0);
  filter->Update();
  const vtkIdType cells = filter->GetOutput()->GetNumberOfCells();
  const vtkMTimeType time = filter->GetOutput()->GetMTime();
  filter->Update();
  CHECK(filter->GetOutput()->GetMTime() == time);
  filter->SetValue(0, 700.0);
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() > cells);
}

TEST_CASE("GenerateValues spaces values evenly", "[zmc_vtk]") {
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->GenerateValues(3, 100.0, 200.0);
  REQUIRE(filter->GetNumberOfContours() == 3);
  CHECK(filter->GetValue(1) == 150.0);
  double range[2] = {0.0, 8.0}, values[5];
  filter->GenerateValues(5, range);
  filter->GetValues(values);
  for (int n = 0; n < 5; ++n) {
    CHECK(values[n] == 2.0 * n);
    CHECK(filter->GetValues()[n] == 2.0 * n);
  }
}

TEST_CASE("settings print themselves and keep within their range", "[zmc_vtk]") {
  vtkNew<vtkZeroCrossingMarchingCubes> filter;
  filter->SetBorderToCapped();
  filter->SetNonFiniteToMask();
  filter->SetTieRuleToPositive();
  filter->SetTriangulationToCentroid();
  filter->SetZeroFacesToMating();
  filter->SetInsideToBelow();
  filter->SetNumberOfThreads(-4);
  std::ostringstream text;
  filter->Print(text);
  for (const char* line :
       {"Border: Capped", "Non Finite: Mask", "Tie Rule: Positive", "Triangulation: Centroid",
        "Zero Faces: Mating", "Inside: Below", "Number Of Threads: 0", "Compute Normals: On"}) {
    CHECK_THAT(text.str(), Contains(line));
  }
  filter->SetBorder(17);
  CHECK(filter->GetBorder() == vtkZeroCrossingMarchingCubes::BORDER_CAPPED);
}
}  // namespace
