#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "common/mesh_check.hpp"
#include "common/mesh_io.hpp"
#include "common/volume_info.hpp"
#include "program.hpp"

namespace shape3d::apps {

using Json = nlohmann::ordered_json;

/// The name and version of the program, and the sub-command: what each report begins with.
[[nodiscard]] Json report_head(const std::string& command);

/// Integers, flags and areas of a check under the names of MeshCheck; null for what is not defined.
[[nodiscard]] Json to_json(const MeshCheck& check);
[[nodiscard]] Json to_json(const VolumeDescription& volume);

/// Lines of text for a person, each ended.
[[nodiscard]] std::string to_lines(const MeshCheck& check);
[[nodiscard]] std::string to_lines(const VolumeDescription& volume);

/// "name              value\n".
[[nodiscard]] std::string line(const std::string& name, const std::string& value);

/// 1234567 as "1 234 567".
[[nodiscard]] std::string grouped(std::int64_t number);
/// With a sensible number of digits: "657 705.6", "0.0123".
[[nodiscard]] std::string rounded(double number);

/// Writes the report to settings.json, if that is not empty, and gives it its name.
/// @throws FileError
void write_json(const Settings& settings, const Json& report);

}  // namespace shape3d::apps
