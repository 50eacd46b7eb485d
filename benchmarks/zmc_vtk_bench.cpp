// What vtkZeroCrossingMarchingCubes costs beside the library alone and beside vtkFlyingEdges3D:
// 512 x 512 x 150 samples of int16, some six million triangles. Argument: threads. Run with
//   --benchmark_enable_random_interleaving=true --benchmark_repetitions=9
// and compare the least times; CPU is that of all threads.

#include <cmath>

#include <benchmark/benchmark.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>

#include "shape3d/zmc/extractor.hpp"
#include "shape3d/zmc_vtk/vtkZeroCrossingMarchingCubes.h"

namespace {
using namespace shape3d;

constexpr int kNx = 512, kNy = 512, kNz = 150;
constexpr double kValue = 1000.0;

/// A gyroid of rising and falling period, rounded to integers, so that some samples are at kValue.
vtkImageData* image() {
  static const vtkNew<vtkImageData> made = [] {
    vtkNew<vtkImageData> volume;
    volume->SetDimensions(kNx, kNy, kNz);
    volume->AllocateScalars(VTK_SHORT, 1);
    auto* sample = static_cast<short*>(volume->GetScalarPointer());
    for (int k = 0; k < kNz; ++k) {
      for (int j = 0; j < kNy; ++j) {
        for (int i = 0; i < kNx; ++i) {
          const double x = 0.1 * i + std::sin(0.02 * j), y = 0.1 * j + std::sin(0.03 * k),
                       z = 0.1 * k + std::sin(0.025 * i);
          const double f =
              std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x);
          *sample++ = static_cast<short>(std::lround(kValue + 300.0 * f));
        }
      }
    }
    return volume;
  }();
  return made;
}

zmc::VolumeView view() {
  return zmc::make_view(static_cast<const std::int16_t*>(image()->GetScalarPointer()),
                        {kNx, kNy, kNz});
}

void report(benchmark::State& state, std::int64_t triangles) {
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["triangles/s"] =
      benchmark::Counter(static_cast<double>(triangles) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}

void library(benchmark::State& state, bool normals) {
  zmc::Options options;
  options.inside = zmc::Inside::above;
  options.normals = normals;
  options.threads = static_cast<int>(state.range(0));
  const auto volume = view();
  zmc::Extractor extractor;
  std::int64_t triangles = 0;
  for (auto _ : state) {
    zmc::Surface<float> surface;  // anew, as an output of the filter is
    extractor.extract(volume, kValue, options, surface);
    triangles = surface.triangle_count();
  }
  report(state, triangles);
}

template <class Filter>
void filter(benchmark::State& state, bool attributes) {
  vtkSMPTools::Initialize(static_cast<int>(state.range(0)));
  vtkNew<Filter> contour;
  contour->SetInputData(image());
  contour->SetValue(0, kValue);
  contour->SetComputeNormals(attributes);
  contour->SetComputeScalars(attributes);
  for (auto _ : state) {
    contour->Modified();
    contour->Update();
  }
  report(state, contour->GetOutput()->GetNumberOfCells());
}

void ours(benchmark::State& state, bool attributes) {
  filter<vtkZeroCrossingMarchingCubes>(state, attributes);
}
void flying_edges(benchmark::State& state, bool attributes) {
  filter<vtkFlyingEdges3D>(state, attributes);
}

void settings(benchmark::internal::Benchmark* bench) {
  bench->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
BENCHMARK_CAPTURE(library, triangles_only, false)->Apply(settings);
BENCHMARK_CAPTURE(ours, triangles_only, false)->Apply(settings);
BENCHMARK_CAPTURE(flying_edges, triangles_only, false)->Apply(settings);
BENCHMARK_CAPTURE(library, normals, true)->Apply(settings);
BENCHMARK_CAPTURE(ours, normals_and_scalars, true)->Apply(settings);
BENCHMARK_CAPTURE(flying_edges, normals_and_scalars, true)->Apply(settings);
}  // namespace
