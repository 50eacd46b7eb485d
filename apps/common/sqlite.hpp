#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace shape3d::apps {

/// A connection to an SQLite file. Every failure is a FileError of that file: what SQLite says, as
/// a sentence.
class Sqlite {
 public:
  enum class Mode { read, write, create };

  /// Opens the file; nothing of it is read yet. A file in a folder that cannot be written is opened
  /// as one that nobody changes.
  /// @throws FileError  it does not exist (read, write), or cannot be opened.
  Sqlite(const std::string& path, Mode mode);
  ~Sqlite();
  Sqlite(const Sqlite&) = delete;
  Sqlite& operator=(const Sqlite&) = delete;

  /// One prepared statement. A text or blob that is bound must live until the statement is reset.
  class Statement {
   public:
    /// Numbers of parameters begin with 1, those of columns with 0.
    Statement& bind(int parameter, std::int64_t value);
    Statement& bind(int parameter, std::string_view text);
    Statement& bind_blob(int parameter, const void* data, std::size_t size);
    Statement& bind_null(int parameter);
    /// Binds the text, or NULL.
    Statement& bind(int parameter, const std::optional<std::string>& text);

    /// Runs to the next row. @return whether there is one; if not, the statement is reset.
    bool step();
    /// Runs a statement without rows, and resets it.
    void run();
    void reset();

    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] std::string text(int column) const;
    [[nodiscard]] std::optional<std::string> optional_text(int column) const;
    /// Valid until the next step() or reset().
    [[nodiscard]] std::string_view blob(int column) const;

   private:
    friend class Sqlite;
    struct Finalize {
      void operator()(sqlite3_stmt* statement) const;
    };
    Statement(const Sqlite& database, sqlite3_stmt* statement)
        : database_(&database), statement_(statement) {}

    const Sqlite* database_;
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  };

  [[nodiscard]] Statement prepare(std::string_view sql) const;
  /// Runs statements without results.
  void execute(const std::string& sql) const;
  /// The first column of the first row as a number. @throws FileError  there is no row.
  [[nodiscard]] std::int64_t number(std::string_view sql) const;
  [[nodiscard]] std::int64_t last_id() const;
  [[nodiscard]] std::int64_t changes() const;  ///< Rows of the last statement.
  [[nodiscard]] const std::string& path() const { return path_; }

  /// All or nothing: rolls back unless committed.
  class Transaction {
   public:
    explicit Transaction(const Sqlite& database);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

   private:
    const Sqlite& database_;
    bool open_ = true;
  };

 private:
  [[noreturn]] void fail(int code) const;

  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::string path_;
  std::unique_ptr<sqlite3, Close> handle_;
};

}  // namespace shape3d::apps
