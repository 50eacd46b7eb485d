#pragma once

#include "program.hpp"

namespace shape3d::apps {

// The sub-commands that train and use models; as those of program.hpp.
void add_train(CLI::App& app, Settings& settings);
void add_classify(CLI::App& app, Settings& settings);
void add_map_collection(CLI::App& app, Settings& settings);

}  // namespace shape3d::apps
