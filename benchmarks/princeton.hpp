#pragma once

#include <string>
#include <vector>

namespace shape3d::bench {

/// A classification of the Princeton Shape Benchmark: the classes that have models.
struct Classification {
  struct Model {
    int id = 0;
    std::size_t of_class = 0;  ///< Place in `classes`.
  };
  std::vector<std::string> classes;  ///< "airplane/biplane": name with its parents.
  std::vector<Model> models;         ///< In the order of the file.
};

/// Reads a .cla file: "PSB 1", the numbers of classes and models, then for each class its name, its
/// parent (0 for none) and its number of models, and their numbers.
/// @throws apps::FileError  it cannot be read, or is not such a file: the sentence names the line.
[[nodiscard]] Classification read_classification(const std::string& path);

/// Where a model of the benchmark is: <folder>/<id/100>/m<id>/m<id>.off.
[[nodiscard]] std::string model_path(const std::string& folder, int id);

}  // namespace shape3d::bench
