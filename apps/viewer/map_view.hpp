#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/shape_library.hpp"
#include "library_pictures.hpp"
#include "model/collection_map.hpp"
#include "view.hpp"

class QCheckBox;
class QComboBox;
class QLabel;
class QListWidget;
class QSplitter;

namespace shape3d::apps::viewer {

class SomWidget;
class ThumbnailGrid;

/// The self-organizing map of a collection: U-matrix and labels, and the shapes of the unit that is
/// chosen, which are those of the open shape library.
class MapView : public View {
  Q_OBJECT

 public:
  explicit MapView(Document& document);
  ~MapView() override;

  [[nodiscard]] QWidget* content() override;
  [[nodiscard]] QWidget* panel() override { return panel_; }
  [[nodiscard]] QString missing() const override;
  [[nodiscard]] nlohmann::json state() const override;
  void set_state(const nlohmann::json& state) override;
  void reset() override;
  [[nodiscard]] bool takes(const std::string& path) const override;
  void open(const std::string& path) override;
  [[nodiscard]] bool busy() const override { return pictures_.busy(); }
  [[nodiscard]] std::vector<KeyHelp> keys() const override;
  void set_theme(const Theme& theme) override;

  [[nodiscard]] SomWidget* som() const { return som_; }
  [[nodiscard]] ThumbnailGrid* grid() const { return grid_; }
  [[nodiscard]] const std::shared_ptr<const CollectionMap>& map() const { return map_; }
  /// Of the unit that is chosen.
  [[nodiscard]] const std::vector<UnitShape>& shapes() const { return shown_; }

 private:
  void make_panel();
  void take_collection();
  void take_library();
  void choose(int unit);
  void show_unit();
  void open_shape(std::size_t shape);
  [[nodiscard]] QString about_unit() const;
  [[nodiscard]] QImage picture(std::int64_t key);

  Document& document_;
  QSplitter* content_ = nullptr;
  SomWidget* som_ = nullptr;
  ThumbnailGrid* grid_ = nullptr;
  QWidget* panel_ = nullptr;
  QLabel *about_ = nullptr, *unit_ = nullptr;
  QComboBox* labels_ = nullptr;
  QCheckBox* borders_ = nullptr;
  QListWidget* list_ = nullptr;

  std::shared_ptr<const CollectionMap> map_, read_;  // read_: by open(), for take_collection()
  std::unique_ptr<ShapeLibrary> library_;
  std::string library_error_;                   // why its shapes are not on the map
  std::vector<std::vector<UnitShape>> shapes_;  // of each unit
  std::vector<UnitShape> shown_;
  LibraryPictures pictures_;
};

}  // namespace shape3d::apps::viewer
