#pragma once

#include <string>
#include <vector>

#include "common/mesh_io.hpp"
#include "program_run.hpp"
#include "support/test_data.hpp"

namespace shape3d::test {

/// Runs the program in a folder, and checks that VTK wrote no error.
Run run_in(const TemporaryFolder& folder, const std::vector<std::string>& arguments);

apps::Mesh mesh_in(const TemporaryFolder& folder, const std::string& name);
void save(const TemporaryFolder& folder, const std::string& name, const apps::Mesh& mesh);

bool is_png(const std::string& bytes);

/// A lopsided ball of 2 n (n - 1) triangles: n meridians, and n - 1 circles of latitude.
apps::Mesh pear(int n);

/// The same mesh without some triangles.
apps::Mesh without(const apps::Mesh& mesh, Eigen::Index first, Eigen::Index count);

}  // namespace shape3d::test
