#include "surface_item.hpp"

#include <vtkProperty.h>
#include <QFileInfo>
#include <nlohmann/json.hpp>

#include "document.hpp"

namespace shape3d::apps::viewer {

SurfaceView::Item::Item() {
  // Marks lie in the surface: they are drawn a little nearer.
  zero_mapper->SetResolveCoincidentTopologyToPolygonOffset();
  zero_mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(-2.0, -2.0);
  line_mapper->SetResolveCoincidentTopologyToPolygonOffset();
  line_mapper->SetRelativeCoincidentTopologyLineOffsetParameters(-4.0, -4.0);
  zero_actor->SetMapper(zero_mapper);
  line_actor->SetMapper(line_mapper);
  zero_actor->GetProperty()->SetColor(0.95, 0.15, 0.15);
  zero_actor->GetProperty()->LightingOff();
  line_actor->GetProperty()->SetColor(0.1, 0.85, 1.0);
  line_actor->GetProperty()->LightingOff();
  line_actor->GetProperty()->SetLineWidth(3.0F);
  zero_actor->SetVisibility(0);
  line_actor->SetVisibility(0);
}

QString SurfaceView::Item::title() const {
  if (mesh) return QFileInfo(QString::fromStdString(mesh->path)).fileName();
  return QString(below ? "below %1" : "above %1").arg(isovalue, 0, 'g', 6);
}

const SliceLines& SurfaceView::Item::contour(const zmc::VolumeView& volume,
                                             const SliceGeometry& geometry, std::int64_t slice) {
  const auto axis = static_cast<std::size_t>(geometry.axis());
  if (shown.stage == IsoStage::coarse && shown.of.slices[axis] == slice)
    return shown.contours[axis];
  // Cells of eight zeros take their sign from the whole volume.
  const bool exact = shown.counts.all_zero_cells > 0;
  Contour& known = contours[axis];
  if (known.slice != slice || known.isovalue != isovalue || known.exact != exact)
    known = {slice, isovalue, exact, slice_contour(volume, geometry, isovalue, slice, exact)};
  return known.lines;
}

nlohmann::json SurfaceView::Item::state() const {
  nlohmann::json state{
      {"color", color.name().toStdString()}, {"opacity", opacity}, {"visible", visible}};
  if (mesh) {
    state["mesh"] = mesh->path;
  } else {
    state["isovalue"] = isovalue;
    state["inside"] = below ? "below" : "above";
  }
  return state;
}

}  // namespace shape3d::apps::viewer
