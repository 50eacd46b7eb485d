#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "shape3d/learning/export.hpp"

namespace shape3d::learning {

enum class ModelKind { svm, som, metric };

/// "svm", "som" or "metric".
[[nodiscard]] SHAPE3D_LEARNING_EXPORT std::string_view to_string(ModelKind kind);

/// What is kept of something trained: the thing, and what it is for.
struct ModelFile {
  ModelKind kind = ModelKind::svm;
  /// How the vectors it was trained on are made: the canonical text of a descriptor.
  std::string descriptor;
  std::vector<std::string> class_names;  ///< Of class 0, 1 …
  std::string body;                      ///< serialize() of the Svm, SomModel or LinearMetric.
};

/// Bytes of a file: "SHAPE3D MODEL", the version of the format, the parts, CRC-64.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT std::string write_model_file(const ModelFile& model);

/// @throws std::invalid_argument  the bytes are no model; of another version of the format (the
/// message has both); damaged: every changed byte is found.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT ModelFile read_model_file(std::string_view bytes);

}  // namespace shape3d::learning
