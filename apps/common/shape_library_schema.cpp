#include "shape_library_schema.hpp"

#include <string>

#include "error.hpp"
#include "sqlite.hpp"

namespace shape3d::apps {
namespace {

constexpr int kApplication = 0x53334c42;  // "S3LB", which file(1) and SQLite can show

// vectors: little-endian doubles, in the order of descriptor, then model, as they are read.
constexpr char kTables[] = R"sql(
CREATE TABLE library (
  generation INTEGER NOT NULL
);
INSERT INTO library VALUES (0);
CREATE TABLE classes (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE
);
CREATE TABLE models (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  path TEXT NOT NULL UNIQUE,
  size INTEGER NOT NULL,
  mtime INTEGER NOT NULL,
  digest TEXT NOT NULL,
  vertices INTEGER NOT NULL,
  triangles INTEGER NOT NULL,
  class INTEGER REFERENCES classes (id)
);
CREATE INDEX models_class ON models (class);
CREATE INDEX models_digest ON models (digest);
CREATE TABLE descriptors (
  id INTEGER PRIMARY KEY,
  spec TEXT NOT NULL UNIQUE,
  length INTEGER NOT NULL
);
CREATE TABLE vectors (
  descriptor INTEGER NOT NULL REFERENCES descriptors (id),
  model INTEGER NOT NULL REFERENCES models (id),
  sum INTEGER NOT NULL,
  data BLOB NOT NULL,
  PRIMARY KEY (descriptor, model)
) WITHOUT ROWID;
CREATE INDEX vectors_model ON vectors (model);
CREATE TABLE thumbnails (
  model INTEGER PRIMARY KEY REFERENCES models (id),
  sum INTEGER NOT NULL,
  png BLOB NOT NULL
);
CREATE TABLE items (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  name TEXT NOT NULL UNIQUE,
  kind TEXT NOT NULL,
  size INTEGER NOT NULL,
  sum INTEGER NOT NULL
);
CREATE TABLE item_parts (
  item INTEGER NOT NULL REFERENCES items (id) ON DELETE CASCADE,
  part INTEGER NOT NULL,
  data BLOB NOT NULL,
  PRIMARY KEY (item, part)
);
)sql";

}  // namespace

void make_schema(const Sqlite& database) {
  database.execute("PRAGMA page_size = 8192; PRAGMA journal_mode = WAL");
  Sqlite::Transaction transaction(database);
  database.execute(kTables);
  database.execute("PRAGMA application_id = " + std::to_string(kApplication) +
                   "; PRAGMA user_version = " + std::to_string(kLibraryVersion));
  transaction.commit();
}

void check_schema(const Sqlite& database) {
  if (database.number("PRAGMA application_id") != kApplication) {
    throw FileError(database.path(), "is an SQLite database, but not a shape library");
  }
  const std::int64_t version = database.number("PRAGMA user_version");
  if (version != kLibraryVersion) {
    throw FileError(database.path(), "is a shape library of version " + std::to_string(version) +
                                         ", expected " + std::to_string(kLibraryVersion));
  }
}

void prepare_to_write(const Sqlite& database) {
  database.execute("PRAGMA foreign_keys = 1; PRAGMA synchronous = NORMAL");
}

}  // namespace shape3d::apps
