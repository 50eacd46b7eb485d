#include "shape_library.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <unordered_map>

#include <shape3d/descriptors/descriptor.hpp>

#include "byte_source.hpp"
#include "error.hpp"
#include "interrupt.hpp"
#include "shape_library_parts.hpp"
#include "shape_library_schema.hpp"
#include "sqlite.hpp"
#include "writer_lock.hpp"

namespace shape3d::apps {
namespace {

namespace fs = std::filesystem;

constexpr char kModelColumns[] =
    "SELECT m.id, m.path, m.size, m.mtime, m.digest, m.vertices, m.triangles, c.name "
    "FROM models m LEFT JOIN classes c ON c.id = m.class ";

LibraryModel model_of(const Sqlite::Statement& row) {
  LibraryModel model;
  model.id = row.integer(0);
  model.file = {row.text(1), static_cast<std::uint64_t>(row.integer(2)), row.integer(3)};
  model.digest = row.text(4);
  model.vertices = row.integer(5);
  model.triangles = row.integer(6);
  model.class_name = row.optional_text(7);
  return model;
}

std::optional<LibraryModel> first_model(Sqlite::Statement& statement) {
  if (!statement.step()) return std::nullopt;
  LibraryModel model = model_of(statement);
  statement.reset();
  return model;
}

// Makes an empty library that appears under its name when it is complete: what another process
// finds there is a library, however this one ends.
void make_library(const std::string& path) {
  const std::string unfinished = path + "-new";
  std::error_code error;
  const auto clear = [&] {
    for (const char* tail : {"", "-wal", "-shm", "-journal"}) fs::remove(unfinished + tail, error);
  };
  clear();  // the remains of a process that was killed
  try {
    const RemoveOnInterrupt guard(unfinished);
    make_schema(Sqlite(unfinished, Sqlite::Mode::create));
    fs::rename(unfinished, path, error);
    if (error) throw FileError(path, "cannot be written: " + error.message());
  } catch (...) {
    clear();
    throw;
  }
}

}  // namespace

struct ShapeLibrary::State {
  std::unique_ptr<WriterLock> lock;
  std::unique_ptr<Sqlite> database;
  bool made = false;

  // The descriptor of this spec, made when it is not there.
  [[nodiscard]] std::int64_t make_descriptor(const std::string& spec, Eigen::Index length) const {
    Sqlite::Statement find = database->prepare("SELECT id, length FROM descriptors WHERE spec = ?");
    find.bind(1, std::string_view(spec));
    if (find.step()) {
      const std::int64_t id = find.integer(0), stored = find.integer(1);
      find.reset();
      if (stored == length) return id;
      throw std::invalid_argument("a vector by " + spec + " has " + std::to_string(length) +
                                  " numbers, expected " + std::to_string(stored));
    }
    database->prepare("INSERT INTO descriptors (spec, length) VALUES (?, ?)")
        .bind(1, std::string_view(spec))
        .bind(2, static_cast<std::int64_t>(length))
        .run();
    return database->last_id();
  }

  [[nodiscard]] std::optional<std::int64_t> make_class(
      const std::optional<std::string>& name) const {
    if (!name) return std::nullopt;
    database->prepare("INSERT INTO classes (name) VALUES (?) ON CONFLICT DO NOTHING")
        .bind(1, std::string_view(*name))
        .run();
    Sqlite::Statement find = database->prepare("SELECT id FROM classes WHERE name = ?");
    find.bind(1, std::string_view(*name));
    find.step();
    const std::int64_t id = find.integer(0);
    find.reset();
    return id;
  }

  void changed() const { database->execute("UPDATE library SET generation = generation + 1"); }
};

ShapeLibrary::ShapeLibrary(const std::string& path, Access access)
    : state_(std::make_unique<State>()) {
  if (path.empty()) throw FileError("shape library", "the name is empty");
  const bool writes = access != Access::read;
  std::error_code error;
  const bool fresh =
      access == Access::create &&
      (!fs::exists(path, error) || (fs::is_regular_file(path, error) && fs::is_empty(path, error)));
  if (!fresh) static_cast<void>(readable_size(path));
  if (writes) state_->lock = std::make_unique<WriterLock>(path);
  if (fresh) {
    make_library(path);
    state_->made = true;
  }
  state_->database =
      std::make_unique<Sqlite>(path, writes ? Sqlite::Mode::write : Sqlite::Mode::read);
  check_schema(*state_->database);
  if (writes) prepare_to_write(*state_->database);
}

ShapeLibrary::~ShapeLibrary() {
  // Nothing was put into a library that was made: no file stays behind.
  if (!state_ || !state_->made) return;
  try {
    if (size() > 0 || !items().empty()) return;
    const std::string name = path();
    state_->database.reset();
    std::error_code error;
    for (const char* tail : {"", "-wal", "-shm"}) fs::remove(name + tail, error);
  } catch (const std::exception&) {  // the file stays
  }
}

ShapeLibrary::ShapeLibrary(ShapeLibrary&&) noexcept = default;
ShapeLibrary& ShapeLibrary::operator=(ShapeLibrary&&) noexcept = default;

const std::string& ShapeLibrary::path() const { return state_->database->path(); }
int ShapeLibrary::version() const {
  return static_cast<int>(state_->database->number("PRAGMA user_version"));
}

std::int64_t ShapeLibrary::size() const {
  return state_->database->number("SELECT count(*) FROM models");
}

std::int64_t ShapeLibrary::generation() const {
  return state_->database->number("SELECT generation FROM library");
}

std::vector<LibraryModel> ShapeLibrary::models() const {
  std::vector<LibraryModel> models;
  Sqlite::Statement rows = state_->database->prepare(std::string(kModelColumns) + "ORDER BY m.id");
  while (rows.step()) models.push_back(model_of(rows));
  return models;
}

std::optional<LibraryModel> ShapeLibrary::model(std::int64_t id) const {
  Sqlite::Statement row = state_->database->prepare(std::string(kModelColumns) + "WHERE m.id = ?");
  return first_model(row.bind(1, id));
}

std::optional<LibraryModel> ShapeLibrary::model_of_path(const std::string& absolute_path) const {
  Sqlite::Statement row =
      state_->database->prepare(std::string(kModelColumns) + "WHERE m.path = ?");
  return first_model(row.bind(1, std::string_view(absolute_path)));
}

std::optional<LibraryModel> ShapeLibrary::model_of_digest(const std::string& digest) const {
  Sqlite::Statement row = state_->database->prepare(std::string(kModelColumns) +
                                                    "WHERE m.digest = ? ORDER BY m.id LIMIT 1");
  return first_model(row.bind(1, std::string_view(digest)));
}

std::vector<std::pair<std::string, std::int64_t>> ShapeLibrary::classes() const {
  std::vector<std::pair<std::string, std::int64_t>> classes;
  Sqlite::Statement rows = state_->database->prepare(
      "SELECT c.name, count(*) FROM models m JOIN classes c ON c.id = m.class "
      "GROUP BY c.id ORDER BY c.name");
  while (rows.step()) classes.emplace_back(rows.text(0), rows.integer(1));
  return classes;
}

std::vector<LibraryDescriptor> ShapeLibrary::descriptors() const {
  std::vector<LibraryDescriptor> descriptors;
  Sqlite::Statement rows = state_->database->prepare(
      "SELECT d.spec, d.length, (SELECT count(*) FROM vectors v WHERE v.descriptor = d.id) "
      "FROM descriptors d ORDER BY d.id");
  while (rows.step()) {
    descriptors.push_back(
        {rows.text(0), static_cast<Eigen::Index>(rows.integer(1)), rows.integer(2)});
  }
  return descriptors;
}

LibraryDescriptor ShapeLibrary::descriptor(const std::string& spec) const {
  const std::vector<LibraryDescriptor> stored = descriptors();
  if (stored.empty()) throw FileError(path(), "holds no feature vectors");
  if (spec.empty()) return stored.front();
  const descriptors::Descriptor wanted = descriptors::Descriptor::parse(spec);
  const std::string text = wanted.to_string();
  std::string names, difference;
  for (const LibraryDescriptor& candidate : stored) {
    if (candidate.spec == text) return candidate;
    names += (names.empty() ? "'" : ", '") + candidate.spec + "'";
    if (!difference.empty()) continue;
    try {
      const descriptors::Descriptor other = descriptors::Descriptor::parse(candidate.spec);
      if (other.kind() == wanted.kind()) {
        difference = wanted.difference(other).value_or("");
      }
    } catch (const std::invalid_argument&) {  // of another version of the program
    }
  }
  throw FileError(path(), "has no vectors by '" + text + "', expected one of " + names +
                              (difference.empty() ? "" : ": " + difference));
}

LibraryVectors ShapeLibrary::vectors(const std::string& spec) const {
  LibraryVectors result;
  result.spec = spec;
  const Sqlite& database = *state_->database;
  database.execute("BEGIN");  // one state of the library for all that follows
  struct End {
    const Sqlite& database;
    ~End() {
      try {
        database.execute("COMMIT");
      } catch (const FileError&) {  // nothing was written
      }
    }
  } const end{database};
  Sqlite::Statement head = database.prepare(
      "SELECT d.id, d.length, (SELECT count(*) FROM vectors v WHERE v.descriptor = d.id) "
      "FROM descriptors d WHERE d.spec = ?");
  head.bind(1, std::string_view(spec));
  if (!head.step()) throw FileError(path(), "has no vectors by '" + spec + "'");
  const std::int64_t descriptor = head.integer(0);
  const auto length = static_cast<Eigen::Index>(head.integer(1));
  const auto count = static_cast<Eigen::Index>(head.integer(2));
  head.reset();
  result.vectors.resize(count, length);
  result.ids.reserve(static_cast<std::size_t>(count));
  Sqlite::Statement rows =
      database.prepare("SELECT model, sum, data FROM vectors WHERE descriptor = ? ORDER BY model");
  rows.bind(1, descriptor);
  for (Eigen::Index row = 0; row < count && rows.step(); ++row) {
    const std::string_view bytes = rows.blob(2);
    const std::string fault = vector_fault(bytes, rows.integer(1), length);
    if (!fault.empty()) {
      throw FileError(path(), "is damaged: " + vector_name(rows.integer(0), spec) + " " + fault);
    }
    result.ids.push_back(rows.integer(0));
    std::memcpy(result.vectors.row(row).data(), bytes.data(), bytes.size());
  }
  rows.reset();

  std::unordered_map<std::int64_t, std::int32_t> label_of_class;
  Sqlite::Statement names = database.prepare("SELECT id, name FROM classes ORDER BY name");
  while (names.step()) {
    label_of_class.emplace(names.integer(0), static_cast<std::int32_t>(result.classes.size()));
    result.classes.push_back(names.text(1));
  }
  result.labels.assign(result.ids.size(), -1);
  // By the index of classes: the rows of models need not be read.
  Sqlite::Statement members =
      database.prepare("SELECT class, id FROM models WHERE class IS NOT NULL ORDER BY class, id");
  while (members.step()) {
    const auto place = std::lower_bound(result.ids.begin(), result.ids.end(), members.integer(1));
    if (place == result.ids.end() || *place != members.integer(1)) continue;
    result.labels[static_cast<std::size_t>(place - result.ids.begin())] =
        label_of_class.at(members.integer(0));
  }
  return result;
}

std::optional<Eigen::VectorXd> ShapeLibrary::vector(std::int64_t id,
                                                    const std::string& spec) const {
  Sqlite::Statement row = state_->database->prepare(
      "SELECT v.data, v.sum, d.length FROM vectors v JOIN descriptors d ON d.id = v.descriptor "
      "WHERE d.spec = ? AND v.model = ?");
  row.bind(1, std::string_view(spec)).bind(2, id);
  if (!row.step()) return std::nullopt;
  const std::string_view bytes = row.blob(0);
  const std::string fault =
      vector_fault(bytes, row.integer(1), static_cast<Eigen::Index>(row.integer(2)));
  if (!fault.empty()) {
    throw FileError(path(), "is damaged: " + vector_name(id, spec) + " " + fault);
  }
  Eigen::VectorXd vector(static_cast<Eigen::Index>(row.integer(2)));
  std::memcpy(vector.data(), bytes.data(), bytes.size());
  row.reset();
  return vector;
}

std::vector<std::int64_t> ShapeLibrary::described_models(const std::string& spec) const {
  std::vector<std::int64_t> ids;
  Sqlite::Statement rows = state_->database->prepare(
      "SELECT model FROM vectors WHERE descriptor = (SELECT id FROM descriptors WHERE spec = ?) "
      "ORDER BY model");
  rows.bind(1, std::string_view(spec));
  while (rows.step()) ids.push_back(rows.integer(0));
  return ids;
}

std::string ShapeLibrary::thumbnail(std::int64_t id) const {
  Sqlite::Statement row = state_->database->prepare("SELECT png FROM thumbnails WHERE model = ?");
  row.bind(1, id);
  if (!row.step()) return {};
  std::string png = row.text(0);
  row.reset();
  return png;
}

std::vector<std::int64_t> ShapeLibrary::models_without_thumbnail() const {
  std::vector<std::int64_t> ids;
  Sqlite::Statement rows = state_->database->prepare(
      "SELECT id FROM models EXCEPT SELECT model FROM thumbnails ORDER BY 1");
  while (rows.step()) ids.push_back(rows.integer(0));
  return ids;
}

std::int64_t ShapeLibrary::put(
    const LibraryModel& model,
    const std::vector<std::pair<std::string, Eigen::VectorXd>>& vectors) {
  const Sqlite& database = *state_->database;
  for (const auto& [spec, vector] : vectors) {
    if (!vector.allFinite()) {
      throw std::invalid_argument("the vector by " + spec + " has numbers that are not finite");
    }
  }
  Sqlite::Transaction transaction(database);
  const std::optional<std::int64_t> class_id = state_->make_class(model.class_name);
  std::int64_t id = 0;
  if (const std::optional<LibraryModel> before = model_of_path(model.file.path)) {
    id = before->id;
    if (before->digest != model.digest) {
      database.prepare("DELETE FROM vectors WHERE model = ?").bind(1, id).run();
      database.prepare("DELETE FROM thumbnails WHERE model = ?").bind(1, id).run();
    }
  }
  Sqlite::Statement put = database.prepare(
      id > 0 ? "UPDATE models SET path = ?, size = ?, mtime = ?, digest = ?, vertices = ?, "
               "triangles = ?, class = ? WHERE id = ?"
             : "INSERT INTO models (path, size, mtime, digest, vertices, triangles, class) "
               "VALUES (?, ?, ?, ?, ?, ?, ?)");
  put.bind(1, std::string_view(model.file.path))
      .bind(2, static_cast<std::int64_t>(model.file.size))
      .bind(3, model.file.time)
      .bind(4, std::string_view(model.digest))
      .bind(5, model.vertices)
      .bind(6, model.triangles);
  if (class_id) {
    put.bind(7, *class_id);
  } else {
    put.bind_null(7);
  }
  if (id > 0) put.bind(8, id);
  put.run();
  if (id == 0) id = database.last_id();
  for (const auto& [spec, vector] : vectors) {
    const std::string_view bytes(reinterpret_cast<const char*>(vector.data()),
                                 static_cast<std::size_t>(vector.size()) * sizeof(double));
    database
        .prepare(
            "INSERT OR REPLACE INTO vectors (descriptor, model, sum, data) VALUES (?, ?, ?, ?)")
        .bind(1, state_->make_descriptor(spec, vector.size()))
        .bind(2, id)
        .bind(3, check_sum(bytes))
        .bind_blob(4, bytes.data(), bytes.size())
        .run();
  }
  state_->changed();
  transaction.commit();
  return id;
}

void ShapeLibrary::set_class(std::int64_t id, const std::optional<std::string>& class_name) {
  Sqlite::Transaction transaction(*state_->database);
  const std::optional<std::int64_t> class_id = state_->make_class(class_name);
  Sqlite::Statement update = state_->database->prepare("UPDATE models SET class = ? WHERE id = ?");
  if (class_id) {
    update.bind(1, *class_id);
  } else {
    update.bind_null(1);
  }
  update.bind(2, id).run();
  state_->changed();
  transaction.commit();
}

void ShapeLibrary::put_thumbnails(const std::vector<std::pair<std::int64_t, std::string>>& png) {
  Sqlite::Transaction transaction(*state_->database);
  for (const auto& [id, bytes] : png) {
    state_->database
        ->prepare(
            "INSERT OR REPLACE INTO thumbnails (model, sum, png) SELECT id, ?, ? FROM models "
            "WHERE id = ?")
        .bind(1, check_sum(bytes))
        .bind_blob(2, bytes.data(), bytes.size())
        .bind(3, id)
        .run();
  }
  transaction.commit();
}

bool ShapeLibrary::remove(std::int64_t id) {
  Sqlite::Transaction transaction(*state_->database);
  for (const char* table : {"vectors", "thumbnails"}) {
    state_->database->prepare("DELETE FROM " + std::string(table) + " WHERE model = ?")
        .bind(1, id)
        .run();
  }
  state_->database->prepare("DELETE FROM models WHERE id = ?").bind(1, id).run();
  const bool found = state_->database->changes() > 0;
  state_->database->execute(
      "DELETE FROM classes WHERE id NOT IN (SELECT class FROM models WHERE class IS NOT NULL)");
  if (found) state_->changed();
  transaction.commit();
  return found;
}

std::vector<LibraryItem> ShapeLibrary::items() const {
  std::vector<LibraryItem> items;
  Sqlite::Statement rows =
      state_->database->prepare("SELECT name, kind, size FROM items ORDER BY name");
  while (rows.step()) {
    items.push_back({rows.text(0), rows.text(1), static_cast<std::uint64_t>(rows.integer(2))});
  }
  return items;
}

std::string ShapeLibrary::item(const std::string& name) const {
  Sqlite::Statement head =
      state_->database->prepare("SELECT id, size, sum FROM items WHERE name = ?");
  head.bind(1, std::string_view(name));
  if (!head.step()) throw FileError(path(), "holds nothing of the name '" + name + "'");
  const std::int64_t id = head.integer(0), sum = head.integer(2);
  const auto size = static_cast<std::size_t>(head.integer(1));
  head.reset();
  std::string bytes;
  Sqlite::Statement parts =
      state_->database->prepare("SELECT data FROM item_parts WHERE item = ? ORDER BY part");
  parts.bind(1, id);
  while (parts.step()) bytes += parts.blob(0);
  if (bytes.size() != size || check_sum(bytes) != sum) {
    throw FileError(path(), "is damaged: '" + name + "' does not have its check sum");
  }
  return bytes;
}

void ShapeLibrary::put_item(const std::string& name, const std::string& kind,
                            const std::string& bytes) {
  constexpr std::size_t kPart = std::size_t{1} << 22;  // SQLite's blobs are limited, items not
  const Sqlite& database = *state_->database;
  Sqlite::Transaction transaction(database);
  database.prepare("DELETE FROM items WHERE name = ?").bind(1, std::string_view(name)).run();
  database.prepare("INSERT INTO items (name, kind, size, sum) VALUES (?, ?, ?, ?)")
      .bind(1, std::string_view(name))
      .bind(2, std::string_view(kind))
      .bind(3, static_cast<std::int64_t>(bytes.size()))
      .bind(4, check_sum(bytes))
      .run();
  const std::int64_t id = database.last_id();
  Sqlite::Statement insert =
      database.prepare("INSERT INTO item_parts (item, part, data) VALUES (?, ?, ?)");
  for (std::size_t at = 0, part = 0; at < bytes.size(); at += kPart, ++part) {
    insert.bind(1, id)
        .bind(2, static_cast<std::int64_t>(part))
        .bind_blob(3, bytes.data() + at, std::min(kPart, bytes.size() - at))
        .run();
  }
  transaction.commit();
}

std::vector<LibraryFault> ShapeLibrary::check(bool files) const {
  return faults_of(*state_->database, files);
}

bool ShapeLibrary::remove_item(const std::string& name) {
  Sqlite::Transaction transaction(*state_->database);
  state_->database->prepare("DELETE FROM items WHERE name = ?")
      .bind(1, std::string_view(name))
      .run();
  const bool found = state_->database->changes() > 0;
  transaction.commit();
  return found;
}

}  // namespace shape3d::apps
