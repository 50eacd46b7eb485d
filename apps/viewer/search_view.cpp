#include "search_view.hpp"

#include <algorithm>
#include <filesystem>

#include <QComboBox>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QFormLayout>
#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMimeData>
#include <QPushButton>
#include <QSpinBox>
#include <QUrl>
#include <QVBoxLayout>
#include <nlohmann/json.hpp>

#include "common/error.hpp"
#include "common/mesh_io.hpp"
#include "common/text.hpp"
#include "document.hpp"
#include "model_text.hpp"
#include "theme.hpp"
#include "thumbnail_grid.hpp"

namespace shape3d::apps::viewer {

namespace fs = std::filesystem;

/// The grid; a mesh that is dropped here is a query.
class SearchContent : public QWidget {
 public:
  SearchContent() : grid(new ThumbnailGrid) {
    setAcceptDrops(true);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->addWidget(grid);
  }

  ThumbnailGrid* grid;
  std::function<void(const std::string&)> dropped;

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override {
    if (!mesh_of(event->mimeData()).isEmpty()) event->acceptProposedAction();
  }
  void dropEvent(QDropEvent* event) override {
    const QString mesh = mesh_of(event->mimeData());
    if (mesh.isEmpty()) return;
    event->acceptProposedAction();
    dropped(mesh.toStdString());
  }

 private:
  // Anything else is for the window.
  static QString mesh_of(const QMimeData* data) {
    const QList<QUrl> urls = data->urls();
    if (urls.size() != 1 || !urls[0].isLocalFile()) return {};
    const QString path = urls[0].toLocalFile();
    return mesh_format(path.toStdString()) ? path : QString();
  }
};

namespace {

constexpr std::int64_t kQueryKey = 0;  // of the picture of a query that the library does not hold

QString stem_of(const std::string& path) { return text_of(fs::path(path).stem().string()); }

}  // namespace

SearchView::SearchView(Document& document)
    : View("search", "Search"), document_(document), content_(new SearchContent) {
  grid_ = content_->grid;
  grid_->set_pictures([this](std::int64_t key) { return picture(key); });
  grid_->set_picture_size(130);  // three whole rows of six at 1280 x 720
  make_panel();
  connect(grid_, &ThumbnailGrid::clicked, this, &SearchView::click);
  content_->dropped = [this](const std::string& path) {
    SearchWish wish = wish_;
    wish.id = 0;
    wish.path = path;
    want(wish, true);
  };
  connect(&document_, &Document::collection_changed, this, [this] {
    if (document_.library() != (library_ ? library_->path() : std::string())) take_library();
  });
  connect(&document_, &Document::meshes_changed, this, &SearchView::take_meshes);
  connect(&pictures_, &LibraryPictures::changed, grid_, &ThumbnailGrid::refresh);
  connect(&pictures_, &LibraryPictures::busy_changed, this, &SearchView::busy_changed);
  connect(&pictures_, &LibraryPictures::failed, this, &SearchView::failed);
}

SearchView::~SearchView() { worker_.reset(); }

QWidget* SearchView::content() { return content_; }

QString SearchView::missing() const {
  if (library_) return {};
  return "Open a shape library: drop its file (.db) here, or press Ctrl+O.\n"
         "'shape3d library add shapes.db MESHES' makes one.";
}

void SearchView::make_panel() {
  panel_ = new QWidget;
  auto* column = new QVBoxLayout(panel_);
  auto* library = new QGroupBox("Library");
  auto* library_column = new QVBoxLayout(library);
  about_ = new QLabel;
  about_->setWordWrap(true);
  about_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  library_column->addWidget(about_);
  all_ = new QPushButton("Show all shapes");
  all_->setObjectName("all");
  library_column->addWidget(all_);
  column->addWidget(library);

  auto* query = new QGroupBox("Query");
  auto* query_column = new QVBoxLayout(query);
  filter_ = new QLineEdit;
  filter_->setObjectName("filter");
  filter_->setPlaceholderText("Name or class …");
  filter_->setClearButtonEnabled(true);
  query_column->addWidget(filter_);
  list_ = new QListWidget;
  list_->setObjectName("models");
  list_->setMinimumHeight(130);
  list_->setUniformItemSizes(true);
  query_column->addWidget(list_);
  file_ = new QPushButton("A mesh file …");
  query_column->addWidget(file_);
  column->addWidget(query, 1);

  auto* ranking = new QGroupBox("Ranking");
  auto* form = new QFormLayout(ranking);
  descriptor_ = new QComboBox;
  descriptor_->setObjectName("descriptor");
  descriptor_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  form->addRow("Descriptor", descriptor_);
  ranking_ = new QComboBox;
  ranking_->setObjectName("ranking");
  ranking_->addItem("Euclidean (L2)", "L2");
  ranking_->addItem("City block (L1)", "L1");
  ranking_->addItem("Class-weighted", "weighted");
  form->addRow("Distance", ranking_);
  count_ = new QSpinBox;
  count_->setObjectName("count");
  count_->setRange(1, 1000);
  count_->setKeyboardTracking(false);
  form->addRow("Matches", count_);
  facts_ = new QLabel;
  facts_->setObjectName("facts");
  facts_->setWordWrap(true);
  facts_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  form->addRow(facts_);
  column->addWidget(ranking);
  show_controls();

  connect(all_, &QPushButton::clicked, this, [this] {
    SearchWish wish = wish_;
    wish.id = 0;
    wish.path.clear();
    want(wish, true);
  });
  connect(filter_, &QLineEdit::textChanged, this, &SearchView::fill_models);
  connect(list_, &QListWidget::itemClicked, this, [this](const QListWidgetItem* item) {
    SearchWish wish = wish_;
    wish.id = item->data(Qt::UserRole).toLongLong();
    wish.path.clear();
    want(wish, true);
  });
  connect(list_, &QListWidget::itemActivated, list_, &QListWidget::itemClicked);
  connect(file_, &QPushButton::clicked, this, &SearchView::choose_file);
  connect(descriptor_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    SearchWish wish = wish_;
    wish.descriptor = descriptor_->currentText().toStdString();
    want(wish, true);
  });
  connect(ranking_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    SearchWish wish = wish_;
    wish.ranking = *ranking_named(ranking_->currentData().toString().toStdString());
    want(wish, true);
  });
  connect(count_, QOverload<int>::of(&QSpinBox::valueChanged), this, [this](int count) {
    SearchWish wish = wish_;
    wish.count = count;
    want(wish, true);
  });
}

bool SearchView::takes(const std::string& path) const {
  return lower_case(fs::path(path).extension().string()) == ".db";
}

void SearchView::open(const std::string& path) {
  const std::string whole = fs::absolute(path).lexically_normal().string();
  static_cast<void>(ShapeLibrary(whole, ShapeLibrary::Access::read));
  if (library_ && library_->path() == whole) close_library();  // it may have changed: read anew
  document_.set_library(whole);
}

void SearchView::close_library() {
  worker_.reset();
  library_.reset();
  models_.clear();
  row_of_.clear();
  pictures_.clear();
  searching_ = false;
  const SearchWish before = wish_;
  wish_ = {};
  wish_.ranking = before.ranking;
  wish_.count = before.count;
  result_ = {};
}

void SearchView::take_library() {
  close_library();
  if (!document_.library().empty()) {
    try {
      library_ = std::make_unique<ShapeLibrary>(document_.library(), ShapeLibrary::Access::read);
      models_ = library_->models();
      for (std::size_t row = 0; row < models_.size(); ++row) row_of_[models_[row].id] = row;
      const std::uint64_t number = ++library_number_;
      auto search = std::make_shared<LibrarySearch>(document_.library());
      worker_ = std::make_unique<LatestWorker<SearchWish>>([this, search, number](SearchWish wish) {
        auto result = std::make_shared<SearchResult>(search->search(wish));
        call_later(this, [this, result, number] { take_result(std::move(*result), number); });
      });
    } catch (const std::exception& error) {
      close_library();
      emit failed(QString::fromStdString(error.what()));
    }
  }
  descriptor_->clear();
  if (library_) {
    for (const LibraryDescriptor& descriptor : library_->descriptors())
      descriptor_->addItem(QString::fromStdString(descriptor.spec));
    about_->setText(
        QString("<b>%1</b><br>%2 shapes in %3 classes")
            .arg(text_of(fs::path(library_->path()).filename().string()).toHtmlEscaped())
            .arg(models_.size())
            .arg(library_->classes().size()));
  } else {
    about_->clear();
  }
  fill_models();
  show_models();
  show_controls();
  emit ready_changed();
  emit busy_changed();
}

// A mesh that is opened while this view is in front is what to look for.
void SearchView::take_meshes() {
  const auto& meshes = document_.meshes();
  const bool more = meshes.size() > meshes_;
  meshes_ = meshes.size();
  if (!more || !active_ || !library_ || meshes.back()->path == document_.looked_at()) return;
  SearchWish wish = wish_;
  wish.id = 0;
  wish.path = meshes.back()->path;
  want(wish, true);
}

void SearchView::fill_models() {
  list_->clear();
  const QString wanted = filter_->text().trimmed();
  for (const LibraryModel& model : models_) {
    const QString name = stem_of(model.file.path), class_name = class_text(model.class_name);
    if (!name.contains(wanted, Qt::CaseInsensitive) &&
        !class_name.contains(wanted, Qt::CaseInsensitive))
      continue;
    auto* item = new QListWidgetItem(name + "  ·  " + class_name, list_);
    item->setData(Qt::UserRole, static_cast<qlonglong>(model.id));
    if (model.id == wish_.id) list_->setCurrentItem(item);
  }
}

void SearchView::want(const SearchWish& wish, bool by_user) {
  if (!library_ || wish == wish_) return;
  wish_ = wish;
  show_controls();
  if (wish_.has_query()) {
    search();
  } else {
    show_models();
  }
  if (by_user) emit edited();
}

void SearchView::search() {
  searching_ = true;
  worker_->request(wish_);
  emit busy_changed();
}

void SearchView::take_result(SearchResult result, std::uint64_t library) {
  if (library != library_number_ || !library_) return;
  if (!(result.wish == wish_)) return;  // another one comes
  searching_ = false;
  if (!result.error.empty()) {
    // What was shown before stays, and is what the controls say.
    const QString sentence = QString::fromStdString(result.error);
    wish_ = result_.wish;
    show_controls();
    emit failed(sentence);
  } else {
    for (const std::string& warning : result.warnings)
      emit said(QString::fromStdString(result.wish.path + ": " + warning));
    result_ = std::move(result);
    show_result();
  }
  emit busy_changed();
}

void SearchView::show_result() {
  const Query& query = result_.query;
  std::vector<ThumbnailCell> cells;
  ThumbnailCell first;
  first.key = query.model ? query.model->id : kQueryKey;
  first.frame = to_qt(kQueryFrame);
  const std::string& path = query.mesh ? query.name : query.model->file.path;
  first.first = stem_of(path);
  first.second = class_text(query.class_name);
  first.third = "query";
  first.tip = text_of(path);
  if (!query.model) pictures_.draw(kQueryKey, *query.mesh);
  cells.push_back(first);
  int same = 0;
  for (const Found& found : result_.found) {
    const MatchKind kind = match_kind(query, found.model);
    same += kind == MatchKind::same_class ? 1 : 0;
    cells.push_back({found.model.id, to_qt(frame_color(kind)), stem_of(found.model.file.path),
                     class_text(found.model.class_name),
                     "distance " + QString::number(found.match.distance, 'g', 4),
                     text_of(found.model.file.path)});
  }
  grid_->set_heading({});
  grid_->set_cells(std::move(cells));
  grid_->ensureVisible(0, 0);
  QString facts;
  if (query.class_name && !result_.found.empty()) {
    facts =
        QString("%1 of %2 matches are of the query's class.").arg(same).arg(result_.found.size());
  }
  if (!result_.classes.empty()) {
    QStringList names;
    for (const auto& [name, share] : result_.classes)
      names += text_of(name) + QString(" %1 %").arg(100.0 * share, 0, 'f', 0);
    facts += (facts.isEmpty() ? "" : "\n") + QString("Probable classes: ") + names.join(", ");
  }
  facts += QString("%1%2 shapes searched in %3 ms.")
               .arg(facts.isEmpty() ? "" : "\n")
               .arg(result_.models)
               .arg(1000.0 * result_.seconds, 0, 'f', 0);
  facts_->setText(facts);
}

void SearchView::show_models() {
  const SearchWish wish = wish_;
  result_ = {};
  result_.wish = wish;
  searching_ = false;
  std::vector<ThumbnailCell> cells;
  for (const LibraryModel& model : models_) {
    cells.push_back({model.id, QColor(), stem_of(model.file.path), class_text(model.class_name), "",
                     text_of(model.file.path)});
  }
  grid_->set_heading(models_.empty() ? "The library holds no shape"
                                     : "Click a shape to find those that are like it, or drop a "
                                       "mesh here");
  grid_->set_cells(std::move(cells));
  facts_->clear();
  emit busy_changed();
}

void SearchView::show_controls() {
  const QSignalBlocker quiet(count_);
  count_->setValue(wish_.count);
  ranking_->setCurrentIndex(
      ranking_->findData(QString::fromStdString(std::string(to_string(wish_.ranking)))));
  const int row = descriptor_->findText(QString::fromStdString(wish_.descriptor));
  descriptor_->setCurrentIndex(descriptor_->count() > 0 ? std::max(row, 0) : -1);
  all_->setEnabled(wish_.has_query());
  list_->setCurrentItem(nullptr);
  for (int n = 0; n < list_->count(); ++n) {
    if (list_->item(n)->data(Qt::UserRole).toLongLong() == wish_.id) list_->setCurrentRow(n);
  }
}

void SearchView::click(int cell, int modifiers) {
  const std::int64_t key = grid_->cells()[static_cast<std::size_t>(cell)].key;
  const bool whole = !result_.wish.has_query();
  if (key != kQueryKey && (whole || (modifiers & Qt::ControlModifier) != 0)) {
    SearchWish wish = wish_;
    wish.id = key;
    wish.path.clear();
    want(wish, true);
    return;
  }
  const auto row = row_of_.find(key);
  look_at(document_, row == row_of_.end() ? result_.query.name : models_[row->second].file.path);
}

void SearchView::choose_file() {
  const QString path = QFileDialog::getOpenFileName(
      panel_, "Query", {}, "Meshes (*.ply *.obj *.off *.stl *.vtp);;All files (*)");
  if (!path.isEmpty()) content_->dropped(path.toStdString());
}

QImage SearchView::picture(std::int64_t key) {
  const auto row = row_of_.find(key);
  if (row == row_of_.end() || !library_) return pictures_.known(key);
  return pictures_.of(*library_, key, models_[row->second].file.path);
}

nlohmann::json SearchView::state() const {
  nlohmann::json query = nullptr;
  if (wish_.id > 0) query = wish_.id;
  if (!wish_.path.empty()) query = wish_.path;
  return {{"query", query},
          {"descriptor", wish_.descriptor},
          {"distance", to_string(wish_.ranking)},
          {"count", wish_.count}};
}

void SearchView::set_state(const nlohmann::json& state) {
  SearchWish wish = wish_;
  if (state.contains("query")) {
    const nlohmann::json& query = state["query"];
    wish.id = query.is_number_integer() ? query.get<std::int64_t>() : 0;
    wish.path = query.is_string() ? fs::absolute(query.get<std::string>()).string() : "";
    if (!query.is_null() && wish.id < 1 && wish.path.empty())
      throw std::invalid_argument("query is " + query.dump() +
                                  "; expected the id of a model, the path of a mesh or null");
  }
  if (state.contains("descriptor")) {
    wish.descriptor = state["descriptor"].get<std::string>();
    if (library_ && !wish.descriptor.empty())
      wish.descriptor = library_->descriptor(wish.descriptor).spec;
  }
  if (state.contains("distance")) {
    const auto ranking = ranking_named(state["distance"].get<std::string>());
    if (!ranking)
      throw std::invalid_argument("distance is " + state["distance"].dump() +
                                  "; expected L2, L1 or weighted");
    wish.ranking = *ranking;
  }
  if (state.contains("count")) {
    wish.count = state["count"].get<int>();
    if (wish.count < count_->minimum() || wish.count > count_->maximum())
      throw std::invalid_argument("count is " + state["count"].dump() + "; expected 1 to 1000");
  }
  if (library_) {
    want(wish, false);
  } else {
    wish_.ranking = wish.ranking;
    wish_.count = wish.count;
    show_controls();
  }
}

void SearchView::reset() {
  filter_->clear();
  if (library_) want(SearchWish{}, false);
}

bool SearchView::busy() const { return searching_ || pictures_.busy(); }

std::vector<KeyHelp> SearchView::keys() const {
  return {{"click", "opens a match; where all shapes are shown, finds those like it"},
          {"Ctrl and click", "finds shapes like this one"},
          {"a dropped mesh", "is what to look for"}};
}

void SearchView::set_theme(const Theme& theme) { grid_->set_theme(theme); }

void SearchView::set_active(bool active) { active_ = active; }

}  // namespace shape3d::apps::viewer
