#pragma once

#include <string>
#include <vector>

#include <shape3d/learning/classification.hpp>

namespace shape3d::apps {

/// Models of a classified collection that are there as files.
struct Collection {
  struct Model {
    std::string id;    ///< As the class file names it; in folders, the path below the folder.
    std::string path;  ///< Of the mesh.
    int of_class = 0;  ///< Place in `classes`.
  };
  std::string source;                ///< The class file or folder it is of, for messages.
  std::vector<std::string> classes;  ///< Full names; those of a class file in its order.
  std::vector<Model> models;         ///< In the order of the class file, or of their paths.
  std::vector<std::string> missing;  ///< Sentences: models that have no file.
  std::vector<std::string> empty;    ///< Classes of a class file none of whose models has a file.
};

/// Reads a class file, and names it in what is wrong with it.
/// @throws FileError  it cannot be read or is no class file.
[[nodiscard]] learning::Classification read_classification(const std::string& path);

/// The path of a model below a folder: {id} is the model, {id/N} the whole number in it divided by
/// N, {class} the name of its class, {class_path} the name with its parents.
/// @throws UsageError  the pattern has another word in braces, no {id}, or {id/N} where the id is
/// no number.
[[nodiscard]] std::string model_path(const std::string& pattern, const std::string& id,
                                     const learning::Classification::Class& of_class);

/// Of the Princeton Shape Benchmark, below its folder db.
inline constexpr const char* kPrincetonPattern = "{id/100}/m{id}/m{id}.off";

/// The models of a class file that are files below `folder` by the pattern. Where nothing is below
/// `folder`, they are looked for below its folder "db".
/// @throws FileError  as read_classification(); the folder is none, or has none of the models.
[[nodiscard]] Collection princeton_collection(const std::string& class_file,
                                              const std::string& folder,
                                              const std::string& pattern);

/// A collection whose folders are its classes, in two parts.
struct FolderCollections {
  Collection train, test;
};

/// Meshes in folders: the class is the first folder below `folder` that is not named train or test,
/// and a folder of either name above or below it says to which part a mesh belongs. Meshes below
/// neither are of the test part. Paths are in alphabetical order.
/// @throws FileError  the folder is none or has no mesh in a folder of a class.
[[nodiscard]] FolderCollections folder_collections(const std::string& folder);

/// The class file of another level of the same part of the benchmark, as its folders have them:
/// base/train.cla → coarse2/coarse2Train.cla. The file itself when it is of that level already.
/// @throws UsageError  there is none; the sentence says where it was looked for.
[[nodiscard]] std::string class_file_of_level(const std::string& class_file,
                                              const std::string& level);

}  // namespace shape3d::apps
