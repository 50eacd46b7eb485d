#pragma once

#include "program.hpp"

namespace shape3d::apps {

// The sub-commands for collections of meshes; as those of program.hpp.
void add_evaluate(CLI::App& app, Settings& settings);

}  // namespace shape3d::apps
