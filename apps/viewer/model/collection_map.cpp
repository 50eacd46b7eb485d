#include "collection_map.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "common/error.hpp"
#include "common/model_io.hpp"

namespace shape3d::apps::viewer {

std::string CollectionMap::class_of(int unit) const {
  const int label = model.labels[static_cast<std::size_t>(unit)];
  const bool known = label >= 0 && static_cast<std::size_t>(label) < class_names.size();
  return known ? class_names[static_cast<std::size_t>(label)] : std::string();
}

int CollectionMap::shapes() const {
  return std::accumulate(model.hits.begin(), model.hits.end(), 0);
}

CollectionMap read_collection_map(const std::string& path) {
  const learning::ModelFile file = read_model(path);
  if (file.kind != learning::ModelKind::som) {
    throw FileError(path, "is of kind " + std::string(learning::to_string(file.kind)) +
                              ", expected a map by 'shape3d train som'");
  }
  CollectionMap map;
  map.path = path;
  map.descriptor = file.descriptor;
  map.class_names = file.class_names;
  map.model = model_body<learning::SomModel>(file, path);
  map.u_matrix = learning::u_matrix(map.model.som);
  map.places = learning::som_positions(map.model.som.grid);
  return map;
}

std::vector<std::vector<UnitShape>> shapes_of_units(const CollectionMap& map,
                                                    const ShapeLibrary& library) {
  std::vector<std::vector<UnitShape>> shapes(static_cast<std::size_t>(map.units()));
  const LibraryVectors vectors = library.vectors(library.descriptor(map.descriptor).spec);
  if (vectors.ids.empty()) return shapes;
  const learning::BestUnits best = learning::best_units(map.model.som, vectors.vectors);
  std::map<std::int64_t, LibraryModel> models;
  for (LibraryModel& model : library.models()) {
    const std::int64_t id = model.id;
    models[id] = std::move(model);
  }
  for (std::size_t n = 0; n < vectors.ids.size(); ++n) {
    const auto model = models.find(vectors.ids[n]);
    if (model == models.end()) continue;
    shapes[static_cast<std::size_t>(best.first[n])].push_back(
        {model->first, model->second.file.path, model->second.class_name,
         best.distance(static_cast<Eigen::Index>(n))});
  }
  for (std::vector<UnitShape>& unit : shapes) {
    std::stable_sort(unit.begin(), unit.end(), [](const UnitShape& a, const UnitShape& b) {
      return a.distance < b.distance;
    });
  }
  return shapes;
}

}  // namespace shape3d::apps::viewer
