#pragma once

#include "program.hpp"

namespace shape3d::apps {

// The sub-commands for meshes; as those of program.hpp.
void add_map(CLI::App& app, Settings& settings);
void add_align(CLI::App& app, Settings& settings);
void add_repair(CLI::App& app, Settings& settings);
void add_simplify(CLI::App& app, Settings& settings);
void add_wrap(CLI::App& app, Settings& settings);

}  // namespace shape3d::apps
