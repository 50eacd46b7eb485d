#include "model_io.hpp"

#include <stdexcept>

#include <shape3d/learning/som_maps.hpp>
#include <shape3d/learning/svm.hpp>

#include "byte_source.hpp"
#include "error.hpp"

namespace shape3d::apps {

learning::ModelFile read_model(const std::string& path) {
  const MappedFile file(path);
  try {
    return learning::read_model_file(file.bytes());
  } catch (const std::invalid_argument& error) {
    throw FileError(path, std::string(error.what()) + "; 'shape3d train' makes models");
  }
}

template <class Model>
Model model_body(const learning::ModelFile& file, const std::string& path) {
  try {
    return Model::deserialize(file.body);
  } catch (const std::invalid_argument& error) {
    throw FileError(path, error.what());
  }
}

template learning::Svm model_body(const learning::ModelFile& file, const std::string& path);
template learning::SomModel model_body(const learning::ModelFile& file, const std::string& path);

}  // namespace shape3d::apps
