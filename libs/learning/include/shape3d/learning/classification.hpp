#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"

namespace shape3d::learning {

/// The class of the Princeton Shape Benchmark whose members are of no class: they are in the
/// library, but nobody looks for them.
inline constexpr std::string_view kMiscellaneousClass = "-1";

/// A classification of models: a tree of classes, and the models of each.
struct Classification {
  struct Class {
    std::string name;       ///< "biplane".
    std::string full_name;  ///< With its parents: "aircraft/airplane/biplane".
    int parent = -1;        ///< Place in `classes`; −1: none.
    int models = 0;         ///< Of its own, without those of classes below; may be 0.
  };
  struct Model {
    std::string id;
    int of_class = 0;  ///< Place in `classes`.
  };
  std::vector<Class> classes;  ///< In the order of the file, with those that have no models.
  std::vector<Model> models;   ///< In the order of the file.

  /// The class of each model.
  [[nodiscard]] Labels labels() const;
};

/// Reads the format .cla of the Princeton Shape Benchmark: "PSB 1", the numbers of classes and of
/// models, then for each class its name, its parent (0: none) and its number of models, and their
/// ids, words without spaces. Blank lines, and what follows a '#', are passed over; line ends of
/// Windows and a byte order mark are no matter. A parent stands before its children; where a name
/// occurs again, the latest is meant.
/// @throws std::invalid_argument  "line 7 …" with what is there and what was expected: the head, a
/// count that is not met or exceeded, an unknown parent, a model that occurs twice, two classes of
/// one full name.
/// O(length).
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Classification parse_classification(std::string_view text);

}  // namespace shape3d::learning
