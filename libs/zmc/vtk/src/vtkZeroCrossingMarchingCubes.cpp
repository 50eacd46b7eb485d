#include "shape3d/zmc_vtk/vtkZeroCrossingMarchingCubes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <new>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "image_samples.hpp"
#include "point_attributes.hpp"
#include "shape3d/zmc/extractor.hpp"
#include "surface_arrays.hpp"

namespace zmc = shape3d::zmc;
using shape3d::zmc_vtk::adopt;
using shape3d::zmc_vtk::ImageSamples;

namespace {

using Filter = vtkZeroCrossingMarchingCubes;

template <class Enum>
constexpr bool same(Enum setting, int ours) {
  return static_cast<int>(setting) == ours;
}
static_assert(same(zmc::Inside::below, Filter::INSIDE_BELOW) &&
              same(zmc::Inside::above, Filter::INSIDE_ABOVE));
static_assert(same(zmc::TieRule::neutral, Filter::TIE_RULE_NEUTRAL) &&
              same(zmc::TieRule::positive, Filter::TIE_RULE_POSITIVE));
static_assert(same(zmc::Triangulation::compact, Filter::TRIANGULATION_COMPACT) &&
              same(zmc::Triangulation::centroid, Filter::TRIANGULATION_CENTROID));
static_assert(same(zmc::ZeroFaces::boundary, Filter::ZERO_FACES_BOUNDARY) &&
              same(zmc::ZeroFaces::mating, Filter::ZERO_FACES_MATING));
static_assert(same(zmc::Border::open, Filter::BORDER_OPEN) &&
              same(zmc::Border::capped, Filter::BORDER_CAPPED));
static_assert(same(zmc::NonFinite::error, Filter::NON_FINITE_ERROR) &&
              same(zmc::NonFinite::mask, Filter::NON_FINITE_MASK));

/// What a run works on.
struct Run {
  Filter& filter;
  zmc::Extractor& extractor;
  vtkImageData& image;
  vtkDataArray& scalars;
  ImageSamples samples;
  std::vector<double> values;
  zmc::Options options;
  vtkPolyData& output;
};

/// "[0, 9] x [0, 9] x [0, 0]"
std::string extent_text(const int* extent) {
  std::string text;
  for (int d = 0; d < 3; ++d) {
    text += (d == 0 ? "[" : " x [") + std::to_string(extent[2 * d]) + ", " +
            std::to_string(extent[2 * d + 1]) + "]";
  }
  return text;
}

/// Whether the type of an array holds each value as it is.
template <class T>
bool holds(const std::vector<double>& values) {
  if (std::is_floating_point_v<T>) return true;
  return std::all_of(values.begin(), values.end(), [](double value) {
    constexpr auto kLowest = static_cast<double>(std::numeric_limits<T>::lowest());
    // One more than the largest is a power of two, which double holds.
    const double end = std::ldexp(1.0, std::numeric_limits<T>::digits);
    return value >= kLowest && value < end && static_cast<double>(static_cast<T>(value)) == value;
  });
}

/// The contour value of each vertex.
vtkSmartPointer<vtkDataArray> value_array(vtkDataArray& scalars, const std::vector<double>& values,
                                          const std::vector<vtkIdType>& counts) {
  bool same_type = false;
  switch (scalars.GetDataType()) {
    vtkTemplateMacro(same_type = holds<VTK_TT>(values));
    default:
      break;
  }
  auto array = vtkSmartPointer<vtkDataArray>::Take(
      vtkDataArray::CreateDataArray(same_type ? scalars.GetDataType() : VTK_DOUBLE));
  array->SetName(scalars.GetName());
  array->SetNumberOfTuples(std::accumulate(counts.begin(), counts.end(), vtkIdType{0}));
  vtkIdType from = 0;
  for (std::size_t n = 0; n < values.size(); ++n) {
    switch (array->GetDataType()) {
      vtkTemplateMacro({
        auto* first = static_cast<VTK_TT*>(array->GetVoidPointer(0));
        vtkSMPTools::Fill(first + from, first + from + counts[n], static_cast<VTK_TT>(values[n]));
      });
    }
    from += counts[n];
  }
  return array;
}

template <class Real, class Index>
void write_output(Run& run, std::vector<zmc::Surface<Real, Index>>&& surfaces) {
  std::vector<vtkIdType> counts;
  for (const auto& surface : surfaces) counts.push_back(surface.vertex_count());
  zmc::Surface<Real, Index> surface =
      surfaces.size() == 1 ? std::move(surfaces[0])
                           : shape3d::zmc_vtk::join<Real, Index>(std::move(surfaces));

  vtkPointData& data = *run.output.GetPointData();
  if (run.filter.GetInterpolateAttributes() != 0) {
    shape3d::zmc_vtk::interpolate_attributes(*run.image.GetPointData(), &run.scalars,
                                             shape3d::zmc_vtk::vertex_sources(surface, run.samples),
                                             data);
  }
  if (run.filter.GetComputeScalars() != 0)
    data.SetScalars(value_array(run.scalars, run.values, counts));
  if (run.filter.GetComputeNormals() != 0) {
    const auto normals = adopt(std::move(surface.normals), 3);
    normals->SetName("Normals");
    data.SetNormals(normals);
  }
  if (run.filter.GetComputeGradients() != 0) {
    const auto gradients = adopt(std::move(surface.gradients), 3);
    gradients->SetName("Gradients");
    data.SetVectors(gradients);
  }
  vtkNew<vtkPoints> points;
  points->SetData(adopt(std::move(surface.positions), 3));
  run.output.SetPoints(points);
  run.output.SetPolys(shape3d::zmc_vtk::make_triangles(std::move(surface.indices)));
}

enum class End { done, cancelled, too_large };

template <class Real, class Index>
End extract(Run& run) {
  std::vector<zmc::Surface<Real, Index>> surfaces(run.values.size());
  std::vector<zmc::Status> statuses;
  if (run.values.size() == 1) {
    statuses.push_back(
        run.extractor.extract(run.samples.view, run.values[0], run.options, surfaces[0]));
  } else {
    statuses = run.extractor.extract(run.samples.view, run.values, run.options, surfaces);
  }
  const auto ended = [&](zmc::Status status) {
    return std::find(statuses.begin(), statuses.end(), status) != statuses.end();
  };
  if (ended(zmc::Status::cancelled)) return End::cancelled;
  std::int64_t vertices = 0, triangles = 0;
  for (const auto& surface : surfaces) {
    vertices += surface.vertex_count();
    triangles += surface.triangle_count();
  }
  if (sizeof(Index) == 4 && (ended(zmc::Status::too_many_vertices) ||
                             !shape3d::zmc_vtk::fits_32_bits(vertices, triangles)))
    return End::too_large;
  write_output(run, std::move(surfaces));
  return End::done;
}

template <class Real>
void extract(Run& run) {
  if (extract<Real, std::int32_t>(run) == End::too_large) extract<Real, std::int64_t>(run);
}

}  // namespace

struct vtkZeroCrossingMarchingCubes::Internals {
  zmc::Extractor extractor;
};

vtkStandardNewMacro(vtkZeroCrossingMarchingCubes);

vtkZeroCrossingMarchingCubes::vtkZeroCrossingMarchingCubes()
    : Memory(std::make_unique<Internals>()) {
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                               vtkDataSetAttributes::SCALARS);
}

vtkZeroCrossingMarchingCubes::~vtkZeroCrossingMarchingCubes() = default;

vtkMTimeType vtkZeroCrossingMarchingCubes::GetMTime() {
  return std::max(this->Superclass::GetMTime(), this->ContourValues->GetMTime());
}

int vtkZeroCrossingMarchingCubes::FillInputPortInformation(int /*port*/, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkZeroCrossingMarchingCubes::RequestData(vtkInformation* /*request*/,
                                              vtkInformationVector** inputVector,
                                              vtkInformationVector* outputVector) {
  vtkImageData* image = vtkImageData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  if (image->GetNumberOfPoints() == 0) return 1;

  const int* whole = image->GetExtent();
  std::array<int, 6> extent;
  std::copy_n(whole, 6, extent.begin());
  bool thin = false;
  for (int d = 0; d < 3; ++d) thin = thin || whole[2 * d] == whole[2 * d + 1];
  if (thin) {
    vtkErrorMacro("image: expected at least 2 samples along each axis, got extent "
                  << extent_text(whole));
    return 0;
  }
  // A source may give more than the piece that is wanted.
  vtkInformation* input = inputVector[0]->GetInformationObject(0);
  if (input->Has(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT()) != 0) {
    const int* wanted = input->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT());
    for (int d = 0; d < 3; ++d) {
      extent[2 * d] = std::max(extent[2 * d], wanted[2 * d]);
      extent[2 * d + 1] = std::min(extent[2 * d + 1], wanted[2 * d + 1]);
      if (extent[2 * d] >= extent[2 * d + 1]) return 1;  // no cells
    }
  }

  int association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  vtkDataArray* scalars = this->GetInputArrayToProcess(0, image, association);
  if (scalars == nullptr) {
    vtkErrorMacro("array to process: expected point data of numbers, got none");
    return 0;
  }
  if (association != vtkDataObject::FIELD_ASSOCIATION_POINTS) {
    vtkErrorMacro("array to process: expected point data, got '"
                  << (scalars->GetName() != nullptr ? scalars->GetName() : "")
                  << "', which is not");
    return 0;
  }
  const vtkIdType count = this->GetNumberOfContours();
  if (count == 0) return 1;

  zmc::Options options;
  options.inside = static_cast<zmc::Inside>(this->Inside);
  options.ties = static_cast<zmc::TieRule>(this->TieRule);
  options.triangulation = static_cast<zmc::Triangulation>(this->Triangulation);
  options.zero_faces = static_cast<zmc::ZeroFaces>(this->ZeroFaces);
  options.border = static_cast<zmc::Border>(this->Border);
  options.non_finite = static_cast<zmc::NonFinite>(this->NonFinite);
  options.normals = this->ComputeNormals != 0;
  options.gradients = this->ComputeGradients != 0;
  options.edges = this->InterpolateAttributes != 0;
  options.threads = this->NumberOfThreads > 0 ? this->NumberOfThreads
                                              : vtkSMPTools::GetEstimatedNumberOfThreads();
  options.progress = [this](double share) {
    this->UpdateProgress(share);
    return this->GetAbortExecute() == 0;
  };
  try {
    Run run{*this,
            this->Memory->extractor,
            *image,
            *scalars,
            shape3d::zmc_vtk::image_samples(*image, *scalars, this->ArrayComponent, extent),
            std::vector<double>(this->GetValues(), this->GetValues() + count),
            options,
            *output};
    if (this->OutputPointsPrecision == DOUBLE_PRECISION) {
      extract<double>(run);
    } else {
      extract<float>(run);
    }
    return 1;
  } catch (const std::bad_alloc&) {
    output->Initialize();
    vtkErrorMacro("out of memory for the surface of an image of extent "
                  << extent_text(extent.data()));
  } catch (const std::exception& error) {
    output->Initialize();
    vtkErrorMacro(<< error.what());
  }
  return 0;
}

void vtkZeroCrossingMarchingCubes::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  this->ContourValues->PrintSelf(os, indent.GetNextIndent());
  const auto on_off = [](vtkTypeBool value) { return value != 0 ? "On\n" : "Off\n"; };
  os << indent << "Compute Normals: " << on_off(this->ComputeNormals);
  os << indent << "Compute Gradients: " << on_off(this->ComputeGradients);
  os << indent << "Compute Scalars: " << on_off(this->ComputeScalars);
  os << indent << "Interpolate Attributes: " << on_off(this->InterpolateAttributes);
  os << indent << "Array Component: " << this->ArrayComponent << "\n";
  os << indent << "Output Points Precision: " << this->OutputPointsPrecision << "\n";
  os << indent << "Inside: " << (this->Inside == INSIDE_BELOW ? "Below\n" : "Above\n");
  os << indent << "Tie Rule: " << (this->TieRule == TIE_RULE_NEUTRAL ? "Neutral\n" : "Positive\n");
  os << indent << "Triangulation: "
     << (this->Triangulation == TRIANGULATION_COMPACT ? "Compact\n" : "Centroid\n");
  os << indent
     << "Zero Faces: " << (this->ZeroFaces == ZERO_FACES_BOUNDARY ? "Boundary\n" : "Mating\n");
  os << indent << "Border: " << (this->Border == BORDER_OPEN ? "Open\n" : "Capped\n");
  os << indent << "Non Finite: " << (this->NonFinite == NON_FINITE_ERROR ? "Error\n" : "Mask\n");
  os << indent << "Number Of Threads: " << this->NumberOfThreads << "\n";
}
