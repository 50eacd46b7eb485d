#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkSmartPointer.h>
#include <QColor>
#include <nlohmann/json_fwd.hpp>

#include "model/iso_worker.hpp"
#include "scene_widget.hpp"
#include "surface_view.hpp"

namespace shape3d::apps::viewer {

/// A surface of the list: an isosurface of the volume, or a mesh.
struct SurfaceView::Item {
  int id = 0;
  double isovalue = 0.0;
  bool below = false;                    ///< Inside is below the isovalue.
  std::shared_ptr<const OpenMesh> mesh;  ///< Null: an isosurface.
  QColor color;
  double opacity = 1.0;
  bool visible = true;

  std::shared_ptr<SceneSurface> surface;
  vtkNew<vtkPolyDataMapper> zero_mapper, line_mapper;
  vtkNew<vtkActor> zero_actor, line_actor;
  std::uint64_t newest = 0;  ///< Number of the newest wish whose result is drawn.
  std::uint64_t wished = 0;  ///< Number of the newest full wish.
  IsoResult shown;           ///< Its numbers; the data is with the surface.

  Item();
  /// What the list says of it.
  [[nodiscard]] QString title() const;
  [[nodiscard]] nlohmann::json state() const;
};

}  // namespace shape3d::apps::viewer
