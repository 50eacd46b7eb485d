// Segmentation beside ITK's ThresholdSegmentationLevelSetImageFilter, one after the other in one
// process and from the same front: shape3d_levelset_itk --help.
#include <algorithm>
#include <array>
#include <ctime>
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

/// Processor time, summed over threads: other programs do not add to it.
double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
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

/// The box one sample within the border: ITK starts from the zero crossings between samples, of
/// which a box of the whole volume has none.
levelset::Field start_of(const levelset::Grid& grid) {
  return levelset::box_front(grid,
                             {{1, 1, 1}, {grid.dims[0] - 1, grid.dims[1] - 1, grid.dims[2] - 1}});
}

std::vector<std::uint8_t> mask_of(const levelset::Field& psi) {
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(psi.size()));
  for (std::size_t n = 0; n < mask.size(); ++n)
    mask[n] = psi[static_cast<Eigen::Index>(n)] <= 0.0F ? 1 : 0;
  return mask;
}

/// Share of the samples that two masks have on different sides.
double difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < a.size(); ++n) count += a[n] != b[n] ? 1 : 0;
  return static_cast<double>(count) / static_cast<double>(a.size());
}

struct ItkResult {
  std::vector<std::uint8_t> mask;
  unsigned iterations = 0;
  double rms = 0.0, seconds = 0.0;
};

ItkResult run_itk(const test::LungPhantom& phantom, const levelset::Field& start_front,
                  double level, unsigned iterations, unsigned threads) {
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(threads);
  const Image::Pointer feature =
      image_of(phantom, [&](std::size_t n) { return static_cast<float>(phantom.samples[n]); });
  const Image::Pointer front =
      image_of(phantom, [&](std::size_t n) { return start_front[static_cast<Eigen::Index>(n)]; });
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
  const double start = processor_seconds();
  filter->Update();
  result.seconds = processor_seconds() - start;
  result.iterations = static_cast<unsigned>(filter->GetElapsedIterations());
  result.rms = filter->GetRMSChange();
  const Image* psi = filter->GetOutput();
  for (itk::ImageRegionConstIterator<Image> at(psi, psi->GetLargestPossibleRegion()); !at.IsAtEnd();
       ++at)
    result.mask.push_back(at.Get() <= 0.0F ? 1 : 0);
  return result;
}

/// Dice, and the 95 % Hausdorff distance in samples.
std::string agreement(const std::vector<std::uint8_t>& mask, const std::vector<std::uint8_t>& truth,
                      const std::array<std::int64_t, 3>& dims) {
  const apps::SegmentationMeasures m =
      apps::compare_masks({mask.data(), dims}, {truth.data(), dims});
  return "\"dice\": " + std::to_string(m.dice) +
         ", \"hausdorff95_samples\": " + std::to_string(m.hausdorff95.value_or(-1.0));
}

int run(int argc, char** argv) {
  unsigned iterations = 2000, threads = 1;
  int rounds = 3;
  test::LungPhantomOptions options;
  for (int n = 1; n + 1 < argc; n += 2) {
    const std::string name = argv[n];
    const int value = std::stoi(argv[n + 1]);
    if (name == "--iterations") iterations = static_cast<unsigned>(value);
    if (name == "--threads") threads = static_cast<unsigned>(value);
    if (name == "--rounds") rounds = value;
    if (name == "--noise") options.noise_hu = value;
    if (name == "--size") options.dims = {value, value, value};
  }
  if (argc % 2 == 0) {
    std::cerr << "shape3d_levelset_itk [--iterations N] [--threads N] [--rounds N] [--noise HU] "
                 "[--size N: a cube, default 290 380 62]\n";
    return 2;
  }
  const test::LungPhantom phantom = test::make_lung_phantom(options);
  const levelset::ImageView image =
      levelset::make_view(phantom.samples.data(), phantom.dims, phantom.spacing);
  const levelset::Field start = start_of(image.grid());
  levelset::SegmentOptions segment_options;
  segment_options.threads = static_cast<int>(threads);
  std::vector<double> evolution, total;
  levelset::Segmentation ours;
  for (int round = 0; round < rounds; ++round) {
    const double begin = processor_seconds();
    double begin_evolution = begin;
    segment_options.progress = [&](const levelset::Progress& at) {
      if (at.stage == "speed") begin_evolution = processor_seconds();  // the stage before
      return true;
    };
    ours = levelset::segment(image, segment_options, start);
    const double end = processor_seconds();
    total.push_back(end - begin);
    evolution.push_back(end - begin_evolution);
  }
  std::sort(evolution.begin(), evolution.end());
  std::sort(total.begin(), total.end());
  const double median = evolution[evolution.size() / 2], whole = total[total.size() / 2];
  const ItkResult itk = run_itk(phantom, start, test::LungPhantom::kHalfLevel, iterations, threads);
  const std::vector<std::uint8_t> mask = mask_of(ours.evolution.psi), truth = phantom.tissue();
  // A front that stays where it starts is soon done: then there is nothing to compare.
  const double moved = difference(itk.mask, mask_of(start));
  if (moved < 0.01) {
    std::cerr << "shape3d_levelset_itk: ITK's front changed " << 100.0 * moved
              << " % of the samples; expected a front that moves\n";
    return 1;
  }
  const apps::SegmentationMeasures both =
      apps::compare_masks({itk.mask.data(), phantom.dims}, {mask.data(), phantom.dims});
  std::cout << "{\"dims\": [" << phantom.dims[0] << ", " << phantom.dims[1] << ", "
            << phantom.dims[2] << "], \"threads\": " << threads
            << ",\n \"shape3d\": {\"evolution\": " << median << ", \"total\": " << whole
            << ", \"iterations\": " << ours.evolution.iterations.size() << ", \"status\": \""
            << levelset::to_string(ours.status) << "\", " << agreement(mask, truth, phantom.dims)
            << "},\n \"itk\": {\"version\": \"" << itk::Version::GetITKVersion()
            << "\", \"evolution\": " << itk.seconds << ", \"iterations\": " << itk.iterations
            << ", \"rms\": " << itk.rms << ", \"moved\": " << moved << ", "
            << agreement(itk.mask, truth, phantom.dims) << "},\n \"dice_of_both\": " << both.dice
            << ", \"ratio_evolution\": " << itk.seconds / median
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
