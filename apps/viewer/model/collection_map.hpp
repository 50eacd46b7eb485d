#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <shape3d/learning/som_maps.hpp>

#include "common/shape_library.hpp"

namespace shape3d::apps::viewer {

/// A self-organizing map of a collection, as 'shape3d train som' wrote it.
struct CollectionMap {
  std::string path;
  std::string descriptor;                ///< Canonical.
  std::vector<std::string> class_names;  ///< Of the labels.
  learning::SomModel model;
  learning::UMatrix u_matrix;
  Eigen::MatrixX2d places;  ///< som_positions().

  [[nodiscard]] int units() const { return model.som.grid.units(); }
  [[nodiscard]] int row(int unit) const { return unit / model.som.grid.columns; }
  [[nodiscard]] int column(int unit) const { return unit % model.som.grid.columns; }
  /// The class that most of a unit's shapes are of; empty: no shape, or none of a known class.
  [[nodiscard]] std::string class_of(int unit) const;
  [[nodiscard]] int shapes() const;  ///< That the map was trained on.
};

/// @throws FileError  it cannot be read, or is no map.
[[nodiscard]] CollectionMap read_collection_map(const std::string& path);

/// A shape of a library whose best unit is the one it is listed at.
struct UnitShape {
  std::int64_t id = 0;
  std::string path;
  std::optional<std::string> class_name;
  double distance = 0.0;  ///< From the prototype, scaled as the map scales.
};

/// The shapes of a library at each unit, those that are nearest to the prototype first.
/// @throws FileError  the library has no vectors by the map's descriptor.
[[nodiscard]] std::vector<std::vector<UnitShape>> shapes_of_units(const CollectionMap& map,
                                                                  const ShapeLibrary& library);

}  // namespace shape3d::apps::viewer
