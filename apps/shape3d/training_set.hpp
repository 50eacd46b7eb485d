#pragma once

#include <string>
#include <vector>

#include <shape3d/learning/features.hpp>

#include "program.hpp"

namespace shape3d::apps {

/// Feature vectors that something is trained on.
struct TrainingSet {
  std::string source;              ///< The library or table, for messages.
  std::string spec;                ///< Canonical text of their descriptor.
  std::vector<std::string> files;  ///< The mesh of each vector.
  std::vector<std::string>
      class_names;          ///< Of class 0, 1 …, in alphabetic order; each has members.
  learning::Labels labels;  ///< Of each vector; kUnlabelled: no class is known.
  learning::Features vectors;
};

/// Where vectors and their classes are taken from.
struct TrainingSource {
  std::string path;                ///< A library (.db) or a table (.csv, .npy, .h5).
  std::string descriptor;          ///< Empty: the first one there is.
  bool class_from_folder = false;  ///< The class is the folder of the mesh, or the one above a
                                   ///< folder "train" or "test". Of a table alone.
};

/// @throws UsageError  the name has another extension, a descriptor cannot be understood, or
/// class_from_folder is given with a library.
/// @throws FileError   the source cannot be read, has no vectors, or none of this descriptor.
[[nodiscard]] TrainingSet read_training_set(const TrainingSource& source);

/// Members of each class.
[[nodiscard]] std::vector<int> class_sizes(const TrainingSet& set);

/// Refuses a set that does not have two classes, with what can be done about it; warns of classes
/// of a single member.
/// @throws FileError
void require_classes(const TrainingSet& set, const Settings& settings);

}  // namespace shape3d::apps
