#include "images.hpp"

#include <map>
#include <utility>

#include <vtkCallbackCommand.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

namespace shape3d::zmc_vtk::test {

vtkSmartPointer<vtkImageData> make_image(const Extent& extent, int type, const Field& field) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(const_cast<int*>(extent.data()));
  image->AllocateScalars(type, 1);
  vtkDataArray* samples = image->GetPointData()->GetScalars();
  samples->SetName("samples");
  vtkIdType id = 0;
  for (int k = extent[4]; k <= extent[5]; ++k) {
    for (int j = extent[2]; j <= extent[3]; ++j) {
      for (int i = extent[0]; i <= extent[1]; ++i) samples->SetTuple1(id++, field(i, j, k));
    }
  }
  return image;
}

vtkStandardNewMacro(PartSource);

void PartSource::Produce(const Extent& whole, const Field& field) {
  whole_ = whole;
  field_ = field;
  this->Modified();
}

int PartSource::RequestInformation(vtkInformation* /*request*/, vtkInformationVector** /*in*/,
                                   vtkInformationVector* out) {
  vtkInformation* info = out->GetInformationObject(0);
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole_.data(), 6);
  info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  return 1;
}

int PartSource::RequestData(vtkInformation* /*request*/, vtkInformationVector** /*in*/,
                            vtkInformationVector* out) {
  Extent extent;
  out->GetInformationObject(0)->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(),
                                    extent.data());
  const auto image = make_image(extent, VTK_SHORT, field_);
  add_coordinates<vtkDoubleArray>(image, "coordinates");
  vtkImageData::GetData(out)->ShallowCopy(image);
  return 1;
}

std::array<vtkIdType, 3> triangle(vtkPolyData* mesh, vtkIdType cell) {
  vtkNew<vtkIdList> ids;
  mesh->GetPolys()->GetCellAtId(cell, ids);
  return {ids->GetId(0), ids->GetId(1), ids->GetId(2)};
}

Eigen::Vector3d area_vector(vtkPolyData* mesh, vtkIdType cell) {
  const auto t = triangle(mesh, cell);
  const Eigen::Vector3d a = point(mesh, t[0]);
  return (point(mesh, t[1]) - a).cross(point(mesh, t[2]) - a);
}

double signed_volume(vtkPolyData* mesh) {
  double sum = 0.0;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell) {
    const auto t = triangle(mesh, cell);
    sum += point(mesh, t[0]).dot(point(mesh, t[1]).cross(point(mesh, t[2])));
  }
  return sum / 6.0;
}

int odd_edges(vtkPolyData* mesh) {
  std::map<std::pair<vtkIdType, vtkIdType>, int> count;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell) {
    const auto t = triangle(mesh, cell);
    for (int n = 0; n < 3; ++n) ++count[std::minmax(t[n], t[(n + 1) % 3])];
  }
  int odd = 0;
  for (const auto& edge : count) odd += edge.second % 2;
  return odd;
}

ErrorLog::ErrorLog(vtkAlgorithm* filter) : filter_(filter) {
  vtkNew<vtkCallbackCommand> keep, drop;
  keep->SetClientData(&errors_);
  keep->SetCallback([](vtkObject*, unsigned long, void* log, void* text) {
    static_cast<std::vector<std::string>*>(log)->emplace_back(static_cast<const char*>(text));
  });
  drop->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  tag_ = filter->AddObserver(vtkCommand::ErrorEvent, keep);
  executive_tag_ = filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, drop);
}

ErrorLog::~ErrorLog() {
  filter_->RemoveObserver(tag_);
  filter_->GetExecutive()->RemoveObserver(executive_tag_);
}

}  // namespace shape3d::zmc_vtk::test
