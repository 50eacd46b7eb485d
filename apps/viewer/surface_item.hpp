#pragma once

#include <array>
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

  /// Contours of the slice that was asked for last across each axis.
  struct Contour {
    std::int64_t slice = -1;
    double isovalue = 0.0;
    bool exact = false;
    SliceLines lines;
  };
  std::array<Contour, 3> contours;

  Item();
  /// Where the isosurface cuts a slice of the volume: while a coarse surface is shown, as the
  /// worker found it.
  [[nodiscard]] const SliceLines& contour(const zmc::VolumeView& volume,
                                          const SliceGeometry& geometry, std::int64_t slice);
  /// What the list says of it.
  [[nodiscard]] QString title() const;
  [[nodiscard]] nlohmann::json state() const;
};

}  // namespace shape3d::apps::viewer
