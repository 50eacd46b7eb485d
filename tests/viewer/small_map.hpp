#pragma once

#include <string>

#include <shape3d/learning/model_file.hpp>
#include <shape3d/learning/som_maps.hpp>

#include "common/output_file.hpp"
#include "small_library.hpp"

namespace shape3d::test {

/// Trains a map of 4 × 3 units on a library of boxes and writes it beside the library.
/// @return its path.
inline std::string write_map(const SmallLibrary& small,
                             const std::string& descriptor = SmallLibrary::spec()) {
  const apps::ShapeLibrary library(small.path, apps::ShapeLibrary::Access::read);
  const apps::LibraryVectors vectors = library.vectors(SmallLibrary::spec());
  learning::SomOptions options;
  options.grid = {4, 3, learning::SomLattice::hexagonal, learning::SomShape::sheet};
  learning::SomModel model;
  model.som = learning::train_som(vectors.vectors, options, 1);
  const auto best = learning::best_units(model.som, vectors.vectors, 1);
  const auto units = static_cast<std::size_t>(options.grid.units());
  model.hits.assign(units, 0);
  model.names.assign(units, "");
  learning::Labels labels(vectors.labels.begin(), vectors.labels.end());
  for (std::size_t n = 0; n < best.first.size(); ++n) {
    const auto unit = static_cast<std::size_t>(best.first[n]);
    ++model.hits[unit];
    model.names[unit] =
        std::filesystem::path(library.model(vectors.ids[n])->file.path).stem().string();
  }
  model.labels = learning::vote_labels(best.first, labels, options.grid.units());
  model.clusters.assign(units, 0);
  for (std::size_t unit = 0; unit < units; ++unit) model.clusters[unit] = unit < units / 2 ? 0 : 1;
  const std::string path = (small.folder / "boxes.model").string();
  apps::OutputFile file(path);
  const std::string bytes = learning::write_model_file(
      {learning::ModelKind::som, descriptor, vectors.classes, model.serialize()});
  file.write(bytes.data(), bytes.size());
  file.commit();
  return path;
}

}  // namespace shape3d::test
