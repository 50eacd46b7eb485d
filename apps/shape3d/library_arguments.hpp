#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "program.hpp"

namespace shape3d::apps {

/// The command line of `library add`.
struct LibraryAddArguments {
  std::string library;
  std::vector<std::string> meshes;  ///< Files, and folders that are looked through.
  std::string classes;              ///< A .cla file; empty: none.
  bool class_from_folder = false;
  std::vector<std::string> descriptors;
  bool no_thumbnails = false;
  bool keep_going = false;
};

/// A mesh to be added.
struct NamedMesh {
  std::string path;  ///< Absolute.
  std::optional<std::string> class_name;
};

/// What the command line names, each file once: those of a folder in the order of their names.
/// @throws UsageError  nothing is named. @throws FileError  a folder cannot be read or holds no
/// mesh; the class file cannot be understood.
[[nodiscard]] std::vector<NamedMesh> named_meshes(const LibraryAddArguments& arguments,
                                                  const Settings& settings);

void library_add(const LibraryAddArguments& arguments, const Settings& settings);

struct LibraryListArguments {
  std::string library;
  std::optional<std::string> class_name;
};
void library_list(const LibraryListArguments& arguments, const Settings& settings);

struct LibraryInfoArguments {
  std::string library;
  std::int64_t id = 0;  ///< 0: the library as a whole.
};
void library_info(const LibraryInfoArguments& arguments, const Settings& settings);

struct LibraryRemoveArguments {
  std::string library;
  std::vector<std::string> models;  ///< Ids or paths.
  bool missing = false;             ///< Those whose files are gone.
};
void library_remove(const LibraryRemoveArguments& arguments, const Settings& settings);

struct LibraryCheckArguments {
  std::string library;
  bool no_files = false;
};
void library_check(const LibraryCheckArguments& arguments, const Settings& settings);

struct LibraryExportArguments {
  std::string library;
  std::string npy, csv, h5;
  std::vector<std::string> descriptors;
};
void library_export(const LibraryExportArguments& arguments, const Settings& settings);

}  // namespace shape3d::apps
