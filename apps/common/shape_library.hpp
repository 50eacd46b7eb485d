#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "feature_table.hpp"

namespace shape3d::apps {

/// What models are described by when nothing else is said.
inline constexpr const char* kDefaultDescriptor = "hsh:K=8,unit=yes";

/// A mesh of a library.
struct LibraryModel {
  std::int64_t id = 0;  ///< Positive; is never given to another model.
  FeatureFile file;     ///< Absolute path, and the state it was in.
  std::string digest;   ///< MD5 of the file, 32 hexadecimal digits.
  std::int64_t vertices = 0, triangles = 0;
  std::optional<std::string> class_name;  ///< Empty: the class is not known.
};

/// A descriptor that models of a library are described by.
struct LibraryDescriptor {
  std::string spec;         ///< Descriptor::to_string().
  Eigen::Index length = 0;  ///< Numbers of a vector.
  std::int64_t models = 0;  ///< Models that have a vector of it.
};

/// The vectors of one descriptor.
struct LibraryVectors {
  std::string spec;
  std::vector<std::int64_t> ids;     ///< Of the models, ascending.
  std::vector<std::string> classes;  ///< Names, in alphabetic order.
  std::vector<std::int32_t> labels;  ///< Of each model: row of `classes`; −1: not known.
  FeatureSet::Vectors vectors;       ///< A row for each model.
};

/// Something stored under a name: a trained classifier, or an index of vectors.
struct LibraryItem {
  std::string name;
  std::string kind;        ///< "svm", "som", "hnsw" …
  std::uint64_t size = 0;  ///< Bytes.
};

/// One place of damage, or a file that is no longer as it was described.
struct LibraryFault {
  enum class Kind { damage, missing, changed };
  Kind kind = Kind::damage;
  std::int64_t id = 0;  ///< Of the model; 0: of the file as a whole.
  std::string sentence;
};

/// A collection of meshes in one SQLite file: where they are, their classes, feature vectors and
/// thumbnails. docs/notes/shape-library.md describes the file.
///
/// One process writes at a time, any number read; a reader sees the state of its last call. What
/// put() has returned from survives the end of the process at any point. Vectors carry check sums,
/// which reading compares. An object is used by one thread at a time; others open their own.
///
/// Every function throws FileError: the file is damaged, locked by another process for more than
/// 10 s, the disk is full.
class ShapeLibrary {
 public:
  enum class Access { read, write, create };

  /// @param access  create: an empty library is made where there is no file.
  /// @throws FileError  there is no file (read, write) or it is not a shape library, or of a
  /// version this program does not know; the folder cannot be written (create); another process
  /// writes to it (write, create).
  ShapeLibrary(const std::string& path, Access access);
  ~ShapeLibrary();
  ShapeLibrary(ShapeLibrary&&) noexcept;
  ShapeLibrary& operator=(ShapeLibrary&&) noexcept;

  [[nodiscard]] const std::string& path() const;
  [[nodiscard]] int version() const;  ///< Of the layout of the file.

  [[nodiscard]] std::int64_t size() const;  ///< Models.
  /// In the order of their ids.
  [[nodiscard]] std::vector<LibraryModel> models() const;
  [[nodiscard]] std::optional<LibraryModel> model(std::int64_t id) const;
  [[nodiscard]] std::optional<LibraryModel> model_of_path(const std::string& absolute_path) const;
  /// The model of the smallest id whose file had this digest.
  [[nodiscard]] std::optional<LibraryModel> model_of_digest(const std::string& digest) const;
  /// Names and numbers of models, in alphabetic order; models without class are not counted.
  [[nodiscard]] std::vector<std::pair<std::string, std::int64_t>> classes() const;

  /// In the order they were added.
  [[nodiscard]] std::vector<LibraryDescriptor> descriptors() const;
  /// The descriptor that `spec` means among those of the library: equal to it once both are
  /// canonical; an empty text means the first one.
  /// @throws FileError  the library has none, or not this one: the sentence lists those it has and
  /// the first difference. @throws std::invalid_argument  the text is no descriptor.
  [[nodiscard]] LibraryDescriptor descriptor(const std::string& spec) const;
  /// Vectors of a descriptor of descriptors(); of no models when no model has one.
  [[nodiscard]] LibraryVectors vectors(const std::string& spec) const;
  [[nodiscard]] std::optional<Eigen::VectorXd> vector(std::int64_t id,
                                                      const std::string& spec) const;
  /// Ids of the models that have a vector of this descriptor, ascending.
  [[nodiscard]] std::vector<std::int64_t> described_models(const std::string& spec) const;
  /// A PNG, or empty when there is none.
  [[nodiscard]] std::string thumbnail(std::int64_t id) const;
  [[nodiscard]] std::vector<std::int64_t> models_without_thumbnail() const;

  /// Adds a model, or replaces the one of this path, in one step. Vectors of descriptors that are
  /// not given are kept when the digest is as before, and removed otherwise with the thumbnail.
  /// @param model    Its id is not looked at.
  /// @param vectors  Canonical specs with the vectors, finite.
  /// @return the id.
  /// @throws std::invalid_argument  a vector has another length than those of its spec.
  std::int64_t put(const LibraryModel& model,
                   const std::vector<std::pair<std::string, Eigen::VectorXd>>& vectors);
  void set_class(std::int64_t id, const std::optional<std::string>& class_name);
  /// Of several models in one step.
  void put_thumbnails(const std::vector<std::pair<std::int64_t, std::string>>& png);
  /// @return whether there was such a model.
  bool remove(std::int64_t id);

  /// Classifiers and indexes.
  [[nodiscard]] std::vector<LibraryItem> items() const;
  /// @throws FileError  there is none of this name; its check sum is wrong.
  [[nodiscard]] std::string item(const std::string& name) const;
  void put_item(const std::string& name, const std::string& kind, const std::string& bytes);
  bool remove_item(const std::string& name);

  /// A number that grows with every change of models or vectors: tells whether an index is of now.
  [[nodiscard]] std::int64_t generation() const;

  /// Reads everything: SQLite's own check, lengths and check sums of all vectors, thumbnails and
  /// items; with `files`, whether the meshes are where they were, and as they were by their
  /// digests.
  [[nodiscard]] std::vector<LibraryFault> check(bool files) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// MD5 of the bytes, in hexadecimal.
[[nodiscard]] std::string digest_of(std::string_view bytes);

}  // namespace shape3d::apps
