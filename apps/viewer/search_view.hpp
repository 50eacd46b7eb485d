#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "common/shape_library.hpp"
#include "library_pictures.hpp"
#include "model/latest_worker.hpp"
#include "model/library_search.hpp"
#include "view.hpp"

class QComboBox;
class QLabel;
class QLineEdit;
class QListWidget;
class QPushButton;
class QSpinBox;

namespace shape3d::apps::viewer {

class SearchContent;
class ThumbnailGrid;

/// The models of a shape library, and those that are like one: thumbnails in frames as in
/// Fig. 5.10.
class SearchView : public View {
  Q_OBJECT

 public:
  explicit SearchView(Document& document);
  ~SearchView() override;

  [[nodiscard]] QWidget* content() override;
  [[nodiscard]] QWidget* panel() override { return panel_; }
  [[nodiscard]] QString missing() const override;
  [[nodiscard]] nlohmann::json state() const override;
  void set_state(const nlohmann::json& state) override;
  void reset() override;
  [[nodiscard]] bool takes(const std::string& path) const override;
  void open(const std::string& path) override;
  [[nodiscard]] bool busy() const override;
  [[nodiscard]] std::vector<KeyHelp> keys() const override;
  void set_theme(const Theme& theme) override;
  void set_active(bool active) override;

  [[nodiscard]] ThumbnailGrid* grid() const { return grid_; }
  /// What is shown: with the wish it answers; without query when the library as a whole is shown.
  [[nodiscard]] const SearchResult& result() const { return result_; }

 private:
  void make_panel();
  void close_library();
  void take_library();
  void take_meshes();
  void fill_models();
  /// Searches by a wish of the user, or of the program.
  void want(const SearchWish& wish, bool by_user);
  void search();
  void take_result(SearchResult result, std::uint64_t library);
  void show_result();
  void show_models();
  void show_controls();
  void click(int cell, int modifiers);
  void choose_file();
  [[nodiscard]] QImage picture(std::int64_t key);

  Document& document_;
  SearchContent* content_ = nullptr;
  ThumbnailGrid* grid_ = nullptr;
  QWidget* panel_ = nullptr;
  QLabel *about_ = nullptr, *facts_ = nullptr;
  QLineEdit* filter_ = nullptr;
  QListWidget* list_ = nullptr;
  QPushButton *all_ = nullptr, *file_ = nullptr;
  QComboBox *descriptor_ = nullptr, *ranking_ = nullptr;
  QSpinBox* count_ = nullptr;

  std::unique_ptr<ShapeLibrary> library_;  // for this thread
  std::vector<LibraryModel> models_;
  std::map<std::int64_t, std::size_t> row_of_;  // in models_, by id
  std::uint64_t library_number_ = 0;            // of the library, as they were opened
  std::unique_ptr<LatestWorker<SearchWish>> worker_;
  SearchWish wish_;
  SearchResult result_;
  bool searching_ = false, active_ = false;
  std::size_t meshes_ = 0;
  LibraryPictures pictures_;
};

}  // namespace shape3d::apps::viewer
