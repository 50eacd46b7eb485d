#include "sqlite.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <sqlite3.h>
#include <unistd.h>

#include "byte_source.hpp"
#include "error.hpp"

namespace shape3d::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kPatience = 10000;  // milliseconds that a lock of another process is waited for

std::string folder_of(const std::string& path) {
  const fs::path parent = fs::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

// A reader makes files beside the database where there is a log to share; where that is impossible
// and there is no log, nobody can be writing.
bool is_immutable(const std::string& path) {
  std::error_code error;
  return access(folder_of(path).c_str(), W_OK) != 0 && !fs::exists(path + "-wal", error);
}

std::string uri_of(const std::string& path) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string uri = "file:";
  for (const char c : path) {
    if (c == '?' || c == '#' || c == '%') {
      const auto byte = static_cast<unsigned char>(c);
      uri += {'%', kDigits[byte / 16], kDigits[byte % 16]};
    } else {
      uri += c;
    }
  }
  return uri + "?immutable=1";
}

std::string sentence_of(int code, sqlite3* handle) {
  switch (code & 0xff) {
    case SQLITE_NOTADB:
      return "is not a shape library, or damaged: it is no SQLite database";
    case SQLITE_CORRUPT:
      return "is damaged: " + std::string(sqlite3_errmsg(handle));
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "is locked by another process";
    case SQLITE_READONLY:
      return "cannot be written: the file or its folder is read-only";
    case SQLITE_FULL:
      return "cannot be written: the disk is full";
    case SQLITE_NOMEM:
      return "not enough memory";
    default:
      return "the database reports: " + std::string(sqlite3_errmsg(handle));
  }
}

}  // namespace

void Sqlite::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }
void Sqlite::Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

void Sqlite::fail(int code) const { throw FileError(path_, sentence_of(code, handle_.get())); }

Sqlite::Sqlite(const std::string& path, Mode mode) : path_(path) {
  if (mode != Mode::create) static_cast<void>(readable_size(path));
  sqlite3* handle = nullptr;
  int code = SQLITE_OK;
  if (mode == Mode::read && is_immutable(path)) {
    code = sqlite3_open_v2(uri_of(path).c_str(), &handle, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI,
                           nullptr);
  } else {
    // Readers too: the last one to close removes the log, which only one that could write does.
    code = sqlite3_open_v2(path.c_str(), &handle,
                           SQLITE_OPEN_READWRITE | (mode == Mode::create ? SQLITE_OPEN_CREATE : 0),
                           nullptr);
  }
  handle_.reset(handle);
  if (code == SQLITE_CANTOPEN) {
    const int reason = sqlite3_system_errno(handle);
    throw FileError(
        path, "cannot be opened: " + std::string(std::strerror(reason != 0 ? reason : EACCES)));
  }
  if (code != SQLITE_OK) fail(code);
  sqlite3_extended_result_codes(handle, 1);
  sqlite3_busy_timeout(handle, kPatience);
  if (mode == Mode::read) execute("PRAGMA query_only = 1");
}

Sqlite::~Sqlite() = default;

Sqlite::Statement Sqlite::prepare(std::string_view sql) const {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(handle_.get(), sql.data(), static_cast<int>(sql.size()),
                                      &statement, nullptr);
  if (code != SQLITE_OK) fail(code);
  return {*this, statement};
}

void Sqlite::execute(const std::string& sql) const {
  const int code = sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code);
}

std::int64_t Sqlite::number(std::string_view sql) const {
  Statement statement = prepare(sql);
  if (!statement.step()) throw FileError(path_, "is damaged: a number is missing");
  return statement.integer(0);
}

std::int64_t Sqlite::last_id() const { return sqlite3_last_insert_rowid(handle_.get()); }
std::int64_t Sqlite::changes() const { return sqlite3_changes(handle_.get()); }

Sqlite::Statement& Sqlite::Statement::bind(int parameter, std::int64_t value) {
  const int code = sqlite3_bind_int64(statement_.get(), parameter, value);
  if (code != SQLITE_OK) database_->fail(code);
  return *this;
}

Sqlite::Statement& Sqlite::Statement::bind(int parameter, std::string_view text) {
  const int code = sqlite3_bind_text64(statement_.get(), parameter, text.data(), text.size(),
                                       SQLITE_STATIC, SQLITE_UTF8);
  if (code != SQLITE_OK) database_->fail(code);
  return *this;
}

Sqlite::Statement& Sqlite::Statement::bind(int parameter, const std::optional<std::string>& text) {
  return text ? bind(parameter, std::string_view(*text)) : bind_null(parameter);
}

Sqlite::Statement& Sqlite::Statement::bind_blob(int parameter, const void* data, std::size_t size) {
  const int code =
      sqlite3_bind_blob64(statement_.get(), parameter, size == 0 ? "" : data, size, SQLITE_STATIC);
  if (code != SQLITE_OK) database_->fail(code);
  return *this;
}

Sqlite::Statement& Sqlite::Statement::bind_null(int parameter) {
  const int code = sqlite3_bind_null(statement_.get(), parameter);
  if (code != SQLITE_OK) database_->fail(code);
  return *this;
}

bool Sqlite::Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    sqlite3_reset(statement_.get());
    database_->fail(code);
  }
  reset();
  return false;
}

void Sqlite::Statement::run() {
  while (step()) {
  }
}

void Sqlite::Statement::reset() { sqlite3_reset(statement_.get()); }

std::int64_t Sqlite::Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::string Sqlite::Statement::text(int column) const { return std::string(blob(column)); }

std::optional<std::string> Sqlite::Statement::optional_text(int column) const {
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return std::nullopt;
  return text(column);
}

std::string_view Sqlite::Statement::blob(int column) const {
  const void* data = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return data == nullptr
             ? std::string_view()
             : std::string_view(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

Sqlite::Transaction::Transaction(const Sqlite& database) : database_(database) {
  database.execute("BEGIN IMMEDIATE");
}

Sqlite::Transaction::~Transaction() {
  if (open_) sqlite3_exec(database_.handle_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Sqlite::Transaction::commit() {
  database_.execute("COMMIT");
  open_ = false;
}

}  // namespace shape3d::apps
