#pragma once

#include <shape3d/zmc/volume_view.hpp>

namespace shape3d::apps {

/// VTK's name for the type of samples: VTK_SHORT for int16 and so on.
[[nodiscard]] int vtk_type(zmc::SampleType type);

}  // namespace shape3d::apps
