#pragma once

#include <string>

#include <shape3d/learning/model_file.hpp>

namespace shape3d::apps {

/// Extension of models.
inline constexpr const char* kModelExtension = ".model";

/// @throws FileError  it cannot be read, is no model, of another version, or damaged.
[[nodiscard]] learning::ModelFile read_model(const std::string& path);

/// What is inside, by its own deserialize().
/// @throws FileError  it is damaged.
template <class Model>
[[nodiscard]] Model model_body(const learning::ModelFile& file, const std::string& path);

}  // namespace shape3d::apps
