#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "byte_source.hpp"
#include "error.hpp"
#include "feature_formats.hpp"

namespace shape3d::apps::formats {
namespace {

constexpr const char* kKind = "shape3d describe";
constexpr std::int64_t kVersion = 1;

// Closes what HDF5 opened.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;

  [[nodiscard]] bool good() const { return id_ >= 0; }
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): as HDF5 takes it

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

// HDF5 prints its errors unless told not to.
void be_silent() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

class Writer {
 public:
  explicit Writer(const OutputFile& file)
      : path_(file.path()),
        file_(H5Fcreate(file.temporary_path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
              H5Fclose) {
    check(file_.good());
  }

  void group(const char* name) {
    check(Handle(H5Gcreate2(file_, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose).good());
  }

  Handle dataset(const std::string& name, hid_t stored, hid_t given,
                 const std::vector<hsize_t>& sizes, const void* data) {
    const Handle space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
                       H5Sclose);
    Handle set(
        H5Dcreate2(file_, name.c_str(), stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    check(set.good());
    if (sizes[0] > 0) check(H5Dwrite(set, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
    return set;
  }

  void texts(const std::string& name, const std::vector<std::string>& texts) {
    std::vector<const char*> pointers;
    for (const std::string& text : texts) pointers.push_back(text.c_str());
    const Handle type = text_type();
    dataset(name, type, type, {pointers.size()}, pointers.data());
  }

  void attribute(hid_t object, const char* name, hid_t stored, hid_t given, const void* data) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    check(attribute.good() && H5Awrite(attribute, given, data) >= 0);
  }
  void attribute(hid_t object, const char* name, const std::string& text) {
    const char* pointer = text.c_str();
    const Handle type = text_type();
    attribute(object, name, type, type, &pointer);
  }

  void flush() { check(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0); }
  [[nodiscard]] hid_t file() const { return file_; }

 private:
  void check(bool good) const {
    if (!good) throw FileError(path_, "cannot be written by the HDF5 library");
  }

  std::string path_;
  Handle file_;
};

class Reader {
 public:
  explicit Reader(const std::string& path)
      : path_(path), file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {
    if (!file_.good()) throw FileError(path, "is not an HDF5 file, or is damaged");
  }

  Handle dataset(const std::string& name) const {
    Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.good()) fail("there is no dataset " + name);
    return set;
  }

  [[nodiscard]] bool has(const char* name) const { return H5Lexists(file_, name, H5P_DEFAULT) > 0; }

  std::vector<hsize_t> sizes_of(hid_t set, const std::string& name, int expected) const {
    const Handle space(H5Dget_space(set), H5Sclose);
    if (H5Sget_simple_extent_ndims(space) != expected) {
      fail(name + " has not " + std::to_string(expected) + " dimensions");
    }
    std::vector<hsize_t> sizes(static_cast<std::size_t>(expected));
    H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
    return sizes;
  }

  template <class Number>
  std::vector<Number> numbers(const std::string& name, hid_t type) const {
    const Handle set = dataset(name);
    const std::vector<hsize_t> sizes = sizes_of(set, name, 1);
    check_storage(set, sizes[0], name);
    std::vector<Number> values(sizes[0]);
    if (!values.empty() && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
      fail(name + " cannot be read as numbers");
    }
    return values;
  }

  std::vector<std::string> texts(const std::string& name) const {
    const Handle set = dataset(name);
    const std::vector<hsize_t> sizes = sizes_of(set, name, 1);
    check_storage(set, sizes[0], name);
    const Handle type = text_type();
    std::vector<char*> pointers(sizes[0], nullptr);
    if (!pointers.empty() &&
        H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0) {
      fail(name + " cannot be read as text");
    }
    std::vector<std::string> texts;
    for (const char* pointer : pointers) texts.emplace_back(pointer != nullptr ? pointer : "");
    if (!pointers.empty()) {
      const Handle space(H5Dget_space(set), H5Sclose);
      H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
    }
    return texts;
  }

  std::string text_attribute(hid_t object, const char* name) const {
    const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    const Handle type = text_type();
    char* pointer = nullptr;
    if (!attribute.good() || H5Aread(attribute, type, &pointer) < 0 || pointer == nullptr) {
      fail(std::string("there is no text attribute '") + name + "'");
    }
    std::string text = pointer;
    H5free_memory(pointer);
    return text;
  }

  std::int64_t number_attribute(hid_t object, const char* name) const {
    const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    std::int64_t number = 0;
    if (!attribute.good() || H5Aread(attribute, H5T_NATIVE_INT64, &number) < 0) {
      fail(std::string("there is no integer attribute '") + name + "'");
    }
    return number;
  }

  FeatureSet::Vectors vectors(hid_t set, const std::string& name) const {
    const std::vector<hsize_t> sizes = sizes_of(set, name, 2);
    check_storage(set, sizes[0] * sizes[1], name);
    FeatureSet::Vectors values(static_cast<Eigen::Index>(sizes[0]),
                               static_cast<Eigen::Index>(sizes[1]));
    if (values.size() > 0 &&
        H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
      fail(name + " cannot be read as numbers");
    }
    return values;
  }

  [[nodiscard]] std::vector<std::string> names(const char* group) const {
    std::vector<std::string> names;
    const auto add = [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
      static_cast<std::vector<std::string>*>(data)->emplace_back(name);
      return 0;
    };
    const Handle opened(H5Gopen2(file_, group, H5P_DEFAULT), H5Gclose);
    if (!opened.good()) fail(std::string("there is no group ") + group);
    H5Literate(opened, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
    return names;
  }

  [[noreturn]] void fail(const std::string& sentence) const {
    throw FileError(path_, "is not a table of 'shape3d describe': " + sentence);
  }
  [[nodiscard]] hid_t file() const { return file_; }

 private:
  // Elements take at least a byte each: a larger count is damage and is not allocated.
  void check_storage(hid_t set, hsize_t count, const std::string& name) const {
    if (count > 0 && count > H5Dget_storage_size(set)) fail(name + " is not stored in full");
  }

  std::string path_;
  Handle file_;
};

}  // namespace

void write_h5(OutputFile& file, const FeatureTable& table) {
  be_silent();
  Writer writer(file);
  writer.attribute(writer.file(), "kind", kKind);
  writer.attribute(writer.file(), "version", H5T_STD_I64LE, H5T_NATIVE_INT64, &kVersion);
  std::vector<std::string> paths;
  std::vector<std::uint64_t> sizes;
  std::vector<std::int64_t> times;
  for (const FeatureFile& entry : table.files) {
    paths.push_back(entry.path);
    sizes.push_back(entry.size);
    times.push_back(entry.time);
  }
  writer.texts("/file", paths);
  writer.dataset("/size", H5T_STD_U64LE, H5T_NATIVE_UINT64, {sizes.size()}, sizes.data());
  writer.dataset("/mtime", H5T_STD_I64LE, H5T_NATIVE_INT64, {times.size()}, times.data());
  if (!table.classes.empty()) writer.texts("/class", table.classes);

  writer.group("/vectors");
  const std::vector<std::string> names = feature_names(table);
  for (std::size_t s = 0; s < table.sets.size(); ++s) {
    const FeatureSet::Vectors& vectors = table.sets[s].vectors;
    const Handle set =
        writer.dataset("/vectors/" + names[s], H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                       {static_cast<hsize_t>(vectors.rows()), static_cast<hsize_t>(vectors.cols())},
                       vectors.data());
    writer.attribute(set, "spec", table.sets[s].spec);
    const auto order = static_cast<std::int64_t>(s);
    writer.attribute(set, "order", H5T_STD_I64LE, H5T_NATIVE_INT64, &order);
  }

  writer.group("/failed");
  std::vector<std::string> failed, reasons;
  for (const auto& [path, reason] : table.failed) {
    failed.push_back(path);
    reasons.push_back(reason);
  }
  writer.texts("/failed/file", failed);
  writer.texts("/failed/reason", reasons);
  writer.flush();
}

FeatureTable read_h5(const std::string& path) {
  be_silent();
  (void)readable_size(path);  // the system's reason when it cannot be opened
  const Reader reader(path);
  if (reader.text_attribute(reader.file(), "kind") != kKind ||
      reader.number_attribute(reader.file(), "version") != kVersion) {
    reader.fail("expected the attributes kind = '" + std::string(kKind) + "' and version = 1");
  }
  FeatureTable table;
  const std::vector<std::string> paths = reader.texts("/file");
  const auto sizes = reader.numbers<std::uint64_t>("/size", H5T_NATIVE_UINT64);
  const auto times = reader.numbers<std::int64_t>("/mtime", H5T_NATIVE_INT64);
  if (sizes.size() != paths.size() || times.size() != paths.size()) {
    reader.fail("/file, /size and /mtime differ in length");
  }
  for (std::size_t i = 0; i < paths.size(); ++i) {
    table.files.push_back({paths[i], sizes[i], times[i]});
  }
  if (reader.has("/class")) {
    table.classes = reader.texts("/class");
    if (table.classes.size() != paths.size()) reader.fail("/file and /class differ in length");
  }
  const std::vector<std::string> names = reader.names("/vectors");
  if (names.empty()) reader.fail("there are no vectors");
  table.sets.resize(names.size());
  for (const std::string& name : names) {
    const Handle set = reader.dataset("/vectors/" + name);
    const std::int64_t order = reader.number_attribute(set, "order");
    if (order < 0 || order >= static_cast<std::int64_t>(names.size())) {
      reader.fail("/vectors/" + name + " has the order " + std::to_string(order));
    }
    FeatureSet& target = table.sets[static_cast<std::size_t>(order)];
    target.spec = reader.text_attribute(set, "spec");
    target.vectors = reader.vectors(set, name);
    if (target.vectors.rows() != static_cast<Eigen::Index>(paths.size())) {
      reader.fail("/vectors/" + name + " has another number of rows than /file");
    }
  }
  const std::vector<std::string> failed = reader.texts("/failed/file");
  const std::vector<std::string> reasons = reader.texts("/failed/reason");
  for (std::size_t i = 0; i < std::min(failed.size(), reasons.size()); ++i) {
    table.failed.emplace_back(failed[i], reasons[i]);
  }
  return table;
}

}  // namespace shape3d::apps::formats
