#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

#include <CLI/CLI.hpp>

#include <shape3d/learning/som_maps.hpp>

#include "common/error.hpp"
#include "common/model_io.hpp"
#include "common/output_file.hpp"
#include "learning_commands.hpp"
#include "report.hpp"
#include "som_picture.hpp"

namespace shape3d::apps {
namespace {

enum class UnitText { classes, models };

struct MapCollectionArguments {
  std::string model, picture;
  UnitText text = UnitText::classes;
};

Json rows_of(const Eigen::MatrixXd& M) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < M.cols(); ++j) row.push_back(M(i, j));
    rows.push_back(row);
  }
  return rows;
}

void map_collection(const MapCollectionArguments& arguments, const Settings& settings) {
  const learning::ModelFile file = read_model(arguments.model);
  if (file.kind != learning::ModelKind::som) {
    throw FileError(arguments.model, "is of kind " + std::string(learning::to_string(file.kind)) +
                                         ", expected a map by 'shape3d train som'");
  }
  const auto model = model_body<learning::SomModel>(file, arguments.model);
  SomPictureOptions options;
  const bool classes = arguments.text == UnitText::classes && !file.class_names.empty();
  for (std::size_t u = 0; u < model.hits.size(); ++u) {
    const int label = model.labels[u];
    const bool named = label >= 0 && static_cast<std::size_t>(label) < file.class_names.size();
    options.groups.push_back(named ? label : -1);
    options.labels.push_back(!classes ? model.names[u]
                             : named  ? file.class_names[static_cast<std::size_t>(label)]
                                      : "");
  }
  const Raster raster = draw_som(model, options);
  OutputFile picture(arguments.picture);
  picture.write(to_png(raster));
  picture.finish();

  const learning::UMatrix u = learning::u_matrix(model.som);
  const auto used =
      std::count_if(model.hits.begin(), model.hits.end(), [](int hits) { return hits > 0; });
  const int clusters = 1 + *std::max_element(model.clusters.begin(), model.clusters.end());
  Json report = report_head("map-collection");
  report["model"] = arguments.model;
  report["descriptor"] = file.descriptor;
  report["rows"] = model.som.grid.rows;
  report["columns"] = model.som.grid.columns;
  report["units_with_models"] = used;
  report["clusters"] = clusters;
  report["u_matrix"] = rows_of(u.values);
  Json hits = Json::array();
  for (int r = 0; r < model.som.grid.rows; ++r) {
    const auto first = model.hits.begin() + r * model.som.grid.columns;
    hits.push_back(std::vector<int>(first, first + model.som.grid.columns));
  }
  report["hits"] = hits;
  report["picture"] = arguments.picture;
  write_json(settings, report);
  picture.commit();
  if (settings.quiet) return;
  std::cout << line("descriptor", file.descriptor)
            << line("units", std::to_string(model.som.grid.rows) + " x " +
                                 std::to_string(model.som.grid.columns) + ", " +
                                 std::to_string(used) + " with models")
            << line("clusters", std::to_string(clusters)) << line("picture", arguments.picture);
}

}  // namespace

void add_map_collection(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<MapCollectionArguments>();
  CLI::App* command =
      app.add_subcommand("map-collection", "Draw a collection on its self-organizing map");
  command->add_option("MODEL", arguments->model, "Made by 'train som'")->required();
  command->add_option("--picture", arguments->picture, "U-matrix and labels side by side (.png)")
      ->required()
      ->type_name("FILE");
  const std::map<std::string, UnitText> texts{{"class", UnitText::classes},
                                              {"model", UnitText::models}};
  command
      ->add_option("--labels", arguments->text,
                   "What stands in a unit: the class of most of its models (default), or the model "
                   "nearest to its prototype, as where there are no classes")
      ->transform(CLI::CheckedTransformer(texts))
      ->type_name("NAME");
  command->footer("Example: shape3d map-collection map.model --picture umatrix.png");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { map_collection(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
