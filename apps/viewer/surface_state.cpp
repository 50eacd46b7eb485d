// Parameters of the isosurface view as JSON, for sessions and undo.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <QCheckBox>
#include <QComboBox>
#include <QListWidget>
#include <nlohmann/json.hpp>

#include "document.hpp"
#include "four_up.hpp"
#include "surface_item.hpp"
#include "surface_view.hpp"

namespace shape3d::apps::viewer {

nlohmann::json SurfaceView::state() const {
  nlohmann::json surfaces = nlohmann::json::array();
  for (const auto& item : items_) surfaces.push_back(item->state());
  return {{"surfaces", surfaces},
          {"selected", list_->currentRow()},
          {"contours", contours_->isChecked()},
          {"marks", marks_->isChecked()},
          {"method", method_->currentIndex() == 1 ? "flying-edges" : "zmc"},
          {"layout", four_up_->state()}};
}

void SurfaceView::set_state(const nlohmann::json& state) {
  if (state.contains("method")) {
    const std::string method = state["method"].get<std::string>();
    if (method != "zmc" && method != "flying-edges")
      throw std::invalid_argument("method is \"" + method + "\"; expected zmc or flying-edges");
    method_->setCurrentIndex(method == "flying-edges" ? 1 : 0);
  }
  if (state.contains("marks")) marks_->setChecked(state["marks"].get<bool>());
  if (state.contains("contours")) contours_->setChecked(state["contours"].get<bool>());
  if (state.contains("surfaces")) set_surfaces(state["surfaces"]);
  if (state.contains("selected")) {
    const int row = state["selected"].get<int>();
    if (row < list_->count()) list_->setCurrentRow(row);
  }
  if (state.contains("isovalue")) {
    const double isovalue = state["isovalue"].get<double>();
    if (!std::isfinite(isovalue))
      throw std::invalid_argument("isovalue is not finite; expected a number");
    set_isovalue(isovalue, false);
  }
  if (state.contains("layout")) {
    four_up_->set_state(state["layout"]);
    if (state["layout"].contains("camera")) ready_to_look_ = false;
  }
  request_all();
  show_list();
  show_marks();
  four_up_->refresh_outlines();
}

void SurfaceView::set_surfaces(const nlohmann::json& surfaces) {
  // Isosurfaces in their order; those that are more go, those that are missing are made.
  std::size_t at = 0;
  for (const nlohmann::json& given : surfaces) {
    Item* item = nullptr;
    if (given.contains("mesh")) {
      for (const auto& other : items_) {
        if (other->mesh && other->mesh->path == given["mesh"].get<std::string>())
          item = other.get();
      }
      if (item == nullptr) continue;  // the mesh has been closed
    } else {
      const double isovalue = given.at("isovalue").get<double>();
      if (!std::isfinite(isovalue))
        throw std::invalid_argument("isovalue is not finite; expected a number");
      while (at < items_.size() && items_[at]->mesh) ++at;
      if (at == items_.size()) add_item(isovalue);
      item = items_[at++].get();
      item->isovalue = isovalue;
      if (given.contains("inside")) item->below = given["inside"].get<std::string>() == "below";
    }
    if (given.contains("color")) {
      const QColor color(QString::fromStdString(given["color"].get<std::string>()));
      if (!color.isValid())
        throw std::invalid_argument("color is " + given["color"].dump() + "; expected \"#rrggbb\"");
      item->color = color;
    }
    if (given.contains("opacity"))
      item->opacity = std::clamp(given["opacity"].get<double>(), 0.0, 1.0);
    if (given.contains("visible")) item->visible = given["visible"].get<bool>();
    style(*item);
  }
  for (std::size_t n = items_.size(); n-- > at;) {
    if (!items_[n]->mesh) drop(n);
  }
  show_list();
}

}  // namespace shape3d::apps::viewer
