#include "vtk_samples.hpp"

#include <vtkType.h>

namespace shape3d::apps {

int vtk_type(zmc::SampleType type) {
  switch (type) {
    case zmc::SampleType::int8:
      return VTK_SIGNED_CHAR;
    case zmc::SampleType::uint8:
      return VTK_UNSIGNED_CHAR;
    case zmc::SampleType::int16:
      return VTK_SHORT;
    case zmc::SampleType::uint16:
      return VTK_UNSIGNED_SHORT;
    case zmc::SampleType::int32:
      return VTK_INT;
    case zmc::SampleType::float32:
      return VTK_FLOAT;
    case zmc::SampleType::float64:
      return VTK_DOUBLE;
  }
  return VTK_VOID;
}

}  // namespace shape3d::apps
