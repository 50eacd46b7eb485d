// Segmentation beside ITK's ThresholdSegmentationLevelSetImageFilter, one after the other in one
// process: shape3d_levelset_itk --help.
#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <itkImage.h>
#include <itkImageRegionIterator.h>
#include <itkMultiThreaderBase.h>
#include <itkThresholdSegmentationLevelSetImageFilter.h>
#include <itkVersion.h>

#include <shape3d/levelset/front.hpp>
#include <shape3d/levelset/segment.hpp>

#include "common/segmentation_measures.hpp"
#include "support/lung_phantom.hpp"

namespace {
using namespace shape3d;
using Image = itk::Image<float, 3>;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Value>
Image::Pointer image_of(const test::LungPhantom& phantom, const Value& value) {
  Image::Pointer image = Image::New();
  Image::SizeType size;
  Image::SpacingType spacing;
  for (unsigned axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<itk::SizeValueType>(phantom.dims[axis]);
    spacing[axis] = phantom.spacing[axis];
  }
  image->SetRegions(size);
  image->SetSpacing(spacing);
  image->Allocate();
  std::size_t n = 0;
  for (itk::ImageRegionIterator<Image> at(image, image->GetLargestPossibleRegion()); !at.IsAtEnd();
       ++at)
    at.Set(value(n++));
  return image;
}

struct ItkResult {
  std::vector<std::uint8_t> mask;
  unsigned iterations = 0;
  double rms = 0.0, seconds = 0.0;
};

ItkResult run_itk(const test::LungPhantom& phantom, const levelset::Grid& grid, double level,
                  unsigned iterations, unsigned threads) {
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(threads);
  const levelset::Field box = levelset::box_front(grid, {{0, 0, 0}, grid.dims});
  const Image::Pointer feature =
      image_of(phantom, [&](std::size_t n) { return static_cast<float>(phantom.samples[n]); });
  const Image::Pointer front =
      image_of(phantom, [&](std::size_t n) { return box[static_cast<Eigen::Index>(n)]; });
  using Filter = itk::ThresholdSegmentationLevelSetImageFilter<Image, Image, float>;
  const Filter::Pointer filter = Filter::New();
  filter->SetInput(front);
  filter->SetFeatureImage(feature);
  filter->SetLowerThreshold(static_cast<float>(level));
  filter->SetUpperThreshold(4000.0F);
  filter->SetPropagationScaling(1.0F);
  filter->SetCurvatureScaling(0.0F);
  filter->SetMaximumRMSError(0.005);
  filter->SetNumberOfIterations(iterations);
  filter->SetNumberOfWorkUnits(threads);
  ItkResult result;
  const auto start = std::chrono::steady_clock::now();
  filter->Update();
  result.seconds = seconds_since(start);
  result.iterations = static_cast<unsigned>(filter->GetElapsedIterations());
  result.rms = filter->GetRMSChange();
  const Image* psi = filter->GetOutput();
  for (itk::ImageRegionConstIterator<Image> at(psi, psi->GetLargestPossibleRegion()); !at.IsAtEnd();
       ++at)
    result.mask.push_back(at.Get() <= 0.0F ? 1 : 0);
  return result;
}

// Dice, and the 95 % Hausdorff distance in samples.
std::string agreement(const std::vector<std::uint8_t>& mask, const test::LungPhantom& phantom) {
  const std::vector<std::uint8_t> truth = phantom.tissue();
  const apps::SegmentationMeasures m =
      apps::compare_masks({mask.data(), phantom.dims}, {truth.data(), phantom.dims});
  return "\"dice\": " + std::to_string(m.dice) +
         ", \"hausdorff95_samples\": " + std::to_string(m.hausdorff95.value_or(-1.0));
}

int run(int argc, char** argv) {
  unsigned iterations = 1000, threads = 1;
  int rounds = 3;
  test::LungPhantomOptions options;
  for (int n = 1; n + 1 < argc; n += 2) {
    const std::string name = argv[n];
    const int value = std::stoi(argv[n + 1]);
    if (name == "--iterations") iterations = static_cast<unsigned>(value);
    if (name == "--threads") threads = static_cast<unsigned>(value);
    if (name == "--rounds") rounds = value;
    if (name == "--noise") options.noise_hu = value;
    if (name == "--slices") options.dims[2] = value;
  }
  if (argc % 2 == 0) {
    std::cerr << "shape3d_levelset_itk [--iterations N] [--threads N] [--rounds N] [--noise HU] "
                 "[--slices N]\n";
    return 2;
  }
  const test::LungPhantom phantom = test::make_lung_phantom(options);
  const levelset::ImageView image =
      levelset::make_view(phantom.samples.data(), phantom.dims, phantom.spacing);
  levelset::SegmentOptions segment_options;
  segment_options.threads = static_cast<int>(threads);
  std::vector<double> evolution, total;
  levelset::Segmentation ours;
  for (int round = 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    ours = levelset::segment(image, segment_options);
    total.push_back(seconds_since(start));
    evolution.push_back(ours.evolution.seconds);
  }
  std::sort(evolution.begin(), evolution.end());
  std::sort(total.begin(), total.end());
  const double median = evolution[evolution.size() / 2], whole = total[total.size() / 2];
  const auto labels = ours.labels();
  const std::vector<std::uint8_t> mask(labels.data(), labels.data() + labels.size());
  const ItkResult itk =
      run_itk(phantom, image.grid(), test::LungPhantom::kHalfLevel, iterations, threads);
  std::cout << "{\"dims\": [" << phantom.dims[0] << ", " << phantom.dims[1] << ", "
            << phantom.dims[2] << "], \"threads\": " << threads
            << ",\n \"shape3d\": {\"evolution\": " << median << ", \"total\": " << whole
            << ", \"iterations\": " << ours.evolution.iterations.size() << ", \"status\": \""
            << levelset::to_string(ours.status) << "\", " << agreement(mask, phantom)
            << "},\n \"itk\": {\"version\": \"" << itk::Version::GetITKVersion()
            << "\", \"evolution\": " << itk.seconds << ", \"iterations\": " << itk.iterations
            << ", \"rms\": " << itk.rms << ", " << agreement(itk.mask, phantom)
            << "},\n \"ratio_evolution\": " << itk.seconds / median
            << ", \"ratio_total\": " << itk.seconds / whole << "}\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "shape3d_levelset_itk: " << error.what() << '\n';
    return 1;
  }
}
