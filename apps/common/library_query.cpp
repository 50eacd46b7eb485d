#include "library_query.hpp"

#include <algorithm>
#include <exception>

#include <shape3d/descriptors/descriptor.hpp>

#include "byte_source.hpp"
#include "describe_mesh.hpp"
#include "error.hpp"
#include "mesh_io.hpp"

namespace shape3d::apps {

Query query_of_id(const ShapeLibrary& library, std::int64_t id) {
  Query query;
  query.name = std::to_string(id);
  query.model = library.model(id);
  if (!query.model) throw FileError(library.path(), "has no model " + std::to_string(id));
  query.class_name = query.model->class_name;
  return query;
}

Query query_of_mesh(const ShapeLibrary& library, const std::string& path,
                    std::vector<std::string>& warnings) {
  Query query;
  query.name = path;
  const std::optional<MeshFormat> format = mesh_format(path);
  if (!format) throw FileError(path, unknown_mesh_extension(path));
  const MappedFile file(path);
  query.model = library.model_of_digest(digest_of(file.bytes()));
  if (query.model) query.class_name = query.model->class_name;
  MeshFile parsed = parse_mesh(file.bytes(), *format, path);
  warnings.insert(warnings.end(), parsed.warnings.begin(), parsed.warnings.end());
  query.mesh = std::move(parsed.mesh);
  return query;
}

Eigen::VectorXd vector_of(const ShapeLibrary& library, const Query& query, const std::string& spec,
                          int threads) {
  if (query.model) {
    const std::optional<Eigen::VectorXd> stored = library.vector(query.model->id, spec);
    if (stored) return *stored;
    if (!query.mesh) {
      throw FileError(library.path(),
                      "has no vector of model " + query.name + " by '" + spec +
                          "'; 'shape3d library add' of its mesh with this descriptor makes one");
    }
  }
  try {
    return describe_mesh(*query.mesh, {descriptors::Descriptor::parse(spec)}, threads).front();
  } catch (const std::exception& error) {
    throw FileError(query.name, error.what());
  }
}

std::vector<std::int64_t> left_out(const Query& query) {
  return query.model ? std::vector<std::int64_t>{query.model->id} : std::vector<std::int64_t>{};
}

WeightedMatches weighted_matches(const SearchSet& set, const Query& query,
                                 const Eigen::VectorXd& vector, std::size_t count,
                                 const std::string& library_path, int threads) {
  const bool labelled = std::any_of(set.labels().begin(), set.labels().end(),
                                    [](std::int32_t label) { return label >= 0; });
  if (!labelled) {
    throw FileError(
        library_path,
        "knows no class of a model, which the class-weighted distance needs; 'shape3d library add' "
        "with --classes or --class-from-folder says them");
  }
  WeightedMatches result;
  const std::vector<double> shares = set.class_probabilities(vector, left_out(query), 10, threads);
  for (std::size_t c = 0; c < shares.size(); ++c) {
    if (shares[c] > 0.0) result.classes.emplace_back(set.classes()[c], shares[c]);
  }
  std::stable_sort(result.classes.begin(), result.classes.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  result.matches = set.nearest_weighted(vector, count, shares, left_out(query), 0.25, 1.0, threads);
  return result;
}

MatchKind match_kind(const Query& query, const LibraryModel& model) {
  if (!query.class_name || !model.class_name) return MatchKind::unknown;
  return *query.class_name == *model.class_name ? MatchKind::same_class : MatchKind::other_class;
}

Color frame_color(MatchKind kind) {
  switch (kind) {
    case MatchKind::same_class:
      return kSameClassFrame;
    case MatchKind::other_class:
      return kOtherClassFrame;
    default:
      return kUnknownFrame;
  }
}

}  // namespace shape3d::apps
