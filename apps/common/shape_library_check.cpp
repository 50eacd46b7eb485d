#include <filesystem>

#include <vtksys/MD5.h>
#include <zlib.h>

#include "byte_source.hpp"
#include "error.hpp"
#include "shape_library_parts.hpp"
#include "sqlite.hpp"

namespace shape3d::apps {
namespace {

constexpr std::size_t kMostFaults = 1000;  // a file damaged all over need not be listed whole

class Faults {
 public:
  void add(LibraryFault::Kind kind, std::int64_t id, const std::string& sentence) {
    if (list_.size() < kMostFaults) list_.push_back({kind, id, sentence});
  }
  [[nodiscard]] bool full() const { return list_.size() >= kMostFaults; }
  [[nodiscard]] std::vector<LibraryFault> take() { return std::move(list_); }

 private:
  std::vector<LibraryFault> list_;
};

void check_structure(const Sqlite& database, Faults& faults) {
  Sqlite::Statement rows = database.prepare("PRAGMA integrity_check(100)");
  while (rows.step()) {
    const std::string text = rows.text(0);
    if (text != "ok") faults.add(LibraryFault::Kind::damage, 0, "the database: " + text);
  }
  Sqlite::Statement keys = database.prepare("PRAGMA foreign_key_check");
  while (keys.step() && !faults.full()) {
    faults.add(LibraryFault::Kind::damage, 0,
               "row " + std::to_string(keys.integer(1)) + " of " + keys.text(0) +
                   " names a row of " + keys.text(2) + " that is not there");
  }
}

void check_vectors(const Sqlite& database, Faults& faults) {
  Sqlite::Statement rows = database.prepare(
      "SELECT v.model, d.spec, v.data, v.sum, d.length FROM vectors v "
      "JOIN descriptors d ON d.id = v.descriptor ORDER BY v.descriptor, v.model");
  while (rows.step() && !faults.full()) {
    const std::string fault =
        vector_fault(rows.blob(2), rows.integer(3), static_cast<Eigen::Index>(rows.integer(4)));
    if (fault.empty()) continue;
    faults.add(LibraryFault::Kind::damage, rows.integer(0),
               vector_name(rows.integer(0), rows.text(1)) + " " + fault);
  }
}

void check_blobs(const Sqlite& database, Faults& faults) {
  Sqlite::Statement rows = database.prepare("SELECT model, png, sum FROM thumbnails");
  while (rows.step() && !faults.full()) {
    if (check_sum(rows.blob(1)) == rows.integer(2)) continue;
    faults.add(LibraryFault::Kind::damage, rows.integer(0),
               "the thumbnail of model " + std::to_string(rows.integer(0)) +
                   " does not have its check sum");
  }
  Sqlite::Statement items = database.prepare("SELECT id, name, size, sum FROM items");
  Sqlite::Statement parts =
      database.prepare("SELECT data FROM item_parts WHERE item = ? ORDER BY part");
  while (items.step() && !faults.full()) {
    std::uint64_t size = 0;
    uLong sum = 0;
    parts.bind(1, items.integer(0));
    while (parts.step()) {
      const std::string_view part = parts.blob(0);
      sum = crc32_z(sum, reinterpret_cast<const Bytef*>(part.data()), part.size());
      size += part.size();
    }
    if (size == static_cast<std::uint64_t>(items.integer(2)) &&
        static_cast<std::int64_t>(sum) == items.integer(3)) {
      continue;
    }
    faults.add(LibraryFault::Kind::damage, 0,
               "'" + items.text(1) + "' does not have its size and check sum");
  }
}

void check_files(const Sqlite& database, Faults& faults) {
  Sqlite::Statement rows =
      database.prepare("SELECT id, path, size, digest FROM models ORDER BY id");
  while (rows.step() && !faults.full()) {
    const std::int64_t id = rows.integer(0);
    const std::string path = rows.text(1), name = "model " + std::to_string(id) + ": ";
    try {
      const std::uint64_t size = readable_size(path);
      if (size != static_cast<std::uint64_t>(rows.integer(2)) ||
          digest_of(MappedFile(path).bytes()) != rows.text(3)) {
        faults.add(LibraryFault::Kind::changed, id,
                   name + printable(path) + ": is not the file that was described");
      }
    } catch (const FileError& error) {
      faults.add(LibraryFault::Kind::missing, id, name + error.what());
    }
  }
}

}  // namespace

std::int64_t check_sum(std::string_view bytes) {
  return static_cast<std::int64_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string vector_fault(std::string_view bytes, std::int64_t sum, Eigen::Index length) {
  const std::size_t expected = static_cast<std::size_t>(length) * sizeof(double);
  if (bytes.size() != expected) {
    return "has " + std::to_string(bytes.size()) + " bytes, expected " + std::to_string(expected);
  }
  return check_sum(bytes) == sum ? "" : "does not have its check sum";
}

std::string vector_name(std::int64_t id, const std::string& spec) {
  return "the vector of model " + std::to_string(id) + " by " + spec;
}

std::vector<LibraryFault> faults_of(const Sqlite& database, bool files) {
  Faults faults;
  try {
    check_structure(database, faults);
    check_vectors(database, faults);
    check_blobs(database, faults);
    if (files) check_files(database, faults);
  } catch (const FileError& error) {  // damage that ends the reading
    const std::string sentence = error.what(), prefix = database.path() + ": ";
    faults.add(LibraryFault::Kind::damage, 0,
               sentence.rfind(prefix, 0) == 0 ? sentence.substr(prefix.size()) : sentence);
  }
  return faults.take();
}

std::string digest_of(std::string_view bytes) {
  struct Free {
    void operator()(vtksysMD5* state) const { vtksysMD5_Delete(state); }
  };
  const std::unique_ptr<vtksysMD5, Free> state(vtksysMD5_New());
  vtksysMD5_Initialize(state.get());
  constexpr std::size_t kStep = std::size_t{1} << 30;  // lengths are int there
  for (; !bytes.empty(); bytes.remove_prefix(std::min(kStep, bytes.size()))) {
    vtksysMD5_Append(state.get(), reinterpret_cast<const unsigned char*>(bytes.data()),
                     static_cast<int>(std::min(kStep, bytes.size())));
  }
  char digits[32];
  vtksysMD5_FinalizeHex(state.get(), digits);
  return {digits, sizeof digits};
}

}  // namespace shape3d::apps
