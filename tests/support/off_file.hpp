#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "support/closed_meshes.hpp"

namespace shape3d::test {

/// Triangles of an OFF file of well-formed data (any of the prefixes ST, C, N); what follows
/// the coordinates on a line is left out.
inline ClosedMesh read_off(const std::filesystem::path& file) {
  std::ifstream in(file);
  const auto next = [&in, &file] {
    std::string line;
    while (std::getline(in, line)) {
      line = line.substr(0, line.find('#'));
      if (line.find_first_not_of(" \t\r") != std::string::npos) return line;
    }
    throw std::runtime_error(file.string() + " ends too soon");
  };
  std::string head = next();
  if (head.find("OFF") == std::string::npos) throw std::runtime_error(file.string() + ": no OFF");
  long vertices = 0, triangles = 0;
  std::istringstream(next()) >> vertices >> triangles;
  ClosedMesh mesh;
  mesh.V.resize(vertices, 3);
  mesh.F.resize(triangles, 3);
  for (long i = 0; i < vertices; ++i) {
    std::istringstream(next()) >> mesh.V(i, 0) >> mesh.V(i, 1) >> mesh.V(i, 2);
  }
  for (long t = 0; t < triangles; ++t) {
    int corners = 0;
    std::istringstream(next()) >> corners >> mesh.F(t, 0) >> mesh.F(t, 1) >> mesh.F(t, 2);
    if (corners != 3) throw std::runtime_error(file.string() + ": a polygon of other than 3");
  }
  return mesh;
}

}  // namespace shape3d::test
