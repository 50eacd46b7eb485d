#pragma once

#include <string>

#include "program.hpp"

namespace shape3d::apps {

/// Reads a mesh, checks it, prints the report and writes it as JSON: what `check` does, and `info`
/// for a mesh.
/// @throws FileError
void report_mesh(const std::string& command, const std::string& path, const Settings& settings);

}  // namespace shape3d::apps
