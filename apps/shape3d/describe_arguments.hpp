#pragma once

#include <string>
#include <vector>

#include "program.hpp"

namespace shape3d::apps {

/// The command line of `describe`.
struct DescribeArguments {
  std::vector<std::string> meshes;
  std::string list;
  std::vector<std::string> descriptors;
  std::string output;
  bool keep_going = false;
  bool restart = false;
  std::string show;
  std::string picture;
};

/// Describes all meshes into a table.
void describe_files(const DescribeArguments& arguments, const Settings& settings);

/// Draws how the vector of one mesh comes about.
void show_descriptor(const DescribeArguments& arguments, const Settings& settings);

}  // namespace shape3d::apps
