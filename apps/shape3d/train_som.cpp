#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include <shape3d/learning/clustering.hpp>
#include <shape3d/learning/som_maps.hpp>

#include "progress.hpp"
#include "train_arguments.hpp"

namespace shape3d::apps {
namespace {

namespace fs = std::filesystem;
using learning::kUnlabelled;

struct SecondLevelResult {
  std::vector<int> clusters;  // of each unit
  int count = 0;
  double index = 0.0;  // Davies–Bouldin; 0 when there is one cluster
};

learning::Linkage linkage_of(SecondLevel level) {
  switch (level) {
    case SecondLevel::single:
      return learning::Linkage::single;
    case SecondLevel::complete:
      return learning::Linkage::complete;
    case SecondLevel::average:
      return learning::Linkage::average;
    default:
      return learning::Linkage::ward;
  }
}

// Clusters of the units that have items; each other unit joins its nearest of these.
SecondLevelResult second_level(const learning::Som& som, const std::vector<int>& hits,
                               const TrainSomArguments& arguments) {
  std::vector<Eigen::Index> used;
  for (std::size_t u = 0; u < hits.size(); ++u) {
    if (hits[u] > 0) used.push_back(static_cast<Eigen::Index>(u));
  }
  learning::Features M(static_cast<Eigen::Index>(used.size()), som.prototypes.cols());
  for (std::size_t i = 0; i < used.size(); ++i) {
    M.row(static_cast<Eigen::Index>(i)) = som.prototypes.row(used[i]);
  }
  const int n = static_cast<int>(used.size());
  if (arguments.clusters > n) {
    throw UsageError("--clusters " + std::to_string(arguments.clusters) + ": expected at most " +
                     std::to_string(n) + ", the number of units that have models");
  }
  learning::Clusters best;
  SecondLevelResult result;
  if (n < 2 || arguments.clusters == 1) {
    best.assignment.assign(used.size(), 0);
    result.count = 1;
  } else if (arguments.second_level == SecondLevel::kmeans) {
    if (arguments.clusters > 0) {
      best = learning::kmeans(M, arguments.clusters, arguments.seed);
    } else {
      best = learning::kmeans_by_davies_bouldin(M, 0, arguments.seed).clusters;
    }
  } else {
    const auto merges = learning::agglomerate(M, linkage_of(arguments.second_level));
    const int most = std::max(2, static_cast<int>(std::sqrt(static_cast<double>(n))));
    const int first = arguments.clusters > 0 ? arguments.clusters : 2;
    const int last = arguments.clusters > 0 ? arguments.clusters : std::min(most, n);
    double least = 0.0;
    for (int k = first; k <= last; ++k) {
      learning::Clusters cut = learning::cut_tree(M, merges, k);
      const double index = learning::davies_bouldin(M, cut);
      if (k > first && index >= least) continue;
      least = index;
      best = std::move(cut);
    }
  }
  if (best.count() > 0) {
    result.count = best.count();
    result.index = learning::davies_bouldin(M, best);
  }
  result.clusters.resize(hits.size());
  for (std::size_t u = 0; u < hits.size(); ++u) {
    Eigen::Index nearest = 0;
    (M.rowwise() - som.prototypes.row(static_cast<Eigen::Index>(u)))
        .rowwise()
        .squaredNorm()
        .minCoeff(&nearest);
    result.clusters[u] = best.assignment[static_cast<std::size_t>(nearest)];
  }
  return result;
}

// The file nearest to the prototype of each unit, among those of the unit.
std::vector<std::string> unit_names(const learning::BestUnits& best,
                                    const std::vector<std::string>& files, int units) {
  std::vector<std::string> names(static_cast<std::size_t>(units));
  std::vector<double> nearest(names.size(), 0.0);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto unit = static_cast<std::size_t>(best.first[i]);
    const double distance = best.distance(static_cast<Eigen::Index>(i));
    if (!names[unit].empty() && distance >= nearest[unit]) continue;
    names[unit] = fs::path(files[i]).stem().string();
    nearest[unit] = distance;
  }
  return names;
}

Json units_report(const TrainingSet& set, const learning::SomModel& model,
                  const learning::BestUnits& best) {
  const int columns = model.som.grid.columns;
  Json units = Json::array();
  for (std::size_t u = 0; u < model.hits.size(); ++u) {
    const int label = model.labels[u];
    units.push_back(
        {{"row", static_cast<int>(u) / columns},
         {"column", static_cast<int>(u) % columns},
         {"models", model.hits[u]},
         {"class", label == kUnlabelled ? Json(nullptr)
                                        : Json(set.class_names[static_cast<std::size_t>(label)])},
         {"cluster", model.clusters[u]}});
  }
  Json models = Json::array();
  for (std::size_t i = 0; i < set.files.size(); ++i) {
    const int label = set.labels[i];
    models.push_back(
        {{"file", set.files[i]},
         {"class", label == kUnlabelled ? Json(nullptr)
                                        : Json(set.class_names[static_cast<std::size_t>(label)])},
         {"row", best.first[i] / columns},
         {"column", best.first[i] % columns},
         {"distance", best.distance(static_cast<Eigen::Index>(i))}});
  }
  return {{"units", units}, {"models", models}};
}

}  // namespace

void train_som(const TrainSomArguments& arguments, const Settings& settings) {
  const TrainingSet set = read_training_set(arguments.source);
  learning::SomOptions options = arguments.options;
  options.seed = arguments.seed;
  try {
    learning::check_grid(options.grid);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--grid: ") + error.what());
  }
  Progress progress(settings);
  progress.stage("training a map of " + std::to_string(set.files.size()) + " models");
  options.progress = [&](double share) {
    progress.update(share);
    return true;
  };
  learning::SomModel model;
  model.som = learning::train_som(set.vectors, options, settings.threads);
  progress.clear();
  const learning::BestUnits best = learning::best_units(model.som, set.vectors, settings.threads);
  const int units = options.grid.units();
  model.hits.assign(static_cast<std::size_t>(units), 0);
  for (const int unit : best.first) ++model.hits[static_cast<std::size_t>(unit)];
  model.labels = learning::vote_labels(best.first, set.labels, units);
  model.names = unit_names(best, set.files, units);
  const SecondLevelResult second = second_level(model.som, model.hits, arguments);
  model.clusters = second.clusters;
  const learning::SomQuality quality = learning::som_quality(model.som, best);
  const double purity = learning::purity(best.first, set.labels, units);
  const auto used =
      std::count_if(model.hits.begin(), model.hits.end(), [](int n) { return n > 0; });

  Json report = training_report("som", set);
  report["rows"] = options.grid.rows;
  report["columns"] = options.grid.columns;
  report["lattice"] =
      options.grid.lattice == learning::SomLattice::hexagonal ? "hexagonal" : "rectangular";
  report["shape"] = options.grid.shape == learning::SomShape::toroid ? "toroid" : "sheet";
  report["training"] = options.training == learning::SomTraining::batch ? "batch" : "sequential";
  report["start"] = options.start == learning::SomStart::pca ? "pca" : "random";
  report["epochs"] = options.epochs;
  report["scaling"] = scaling_name(options.scaling);
  report["seed"] = arguments.seed;
  report["quantization_error"] = quality.quantization_error;
  report["topographic_error"] = quality.topographic_error;
  report["units_with_models"] = used;
  report["purity"] = set.class_names.empty() ? Json(nullptr) : Json(purity);
  report["clusters"] = second.count;
  report["davies_bouldin"] = second.count < 2 ? Json(nullptr) : Json(second.index);
  report.update(units_report(set, model, best));
  write_training(arguments,
                 {learning::ModelKind::som, set.spec, set.class_names, model.serialize()}, report,
                 settings);
  if (settings.quiet) return;
  std::cout << training_lines(set)
            << line("units", std::to_string(options.grid.rows) + " x " +
                                 std::to_string(options.grid.columns) + ", " +
                                 std::to_string(used) + " with models")
            << line("quantization", rounded(quality.quantization_error))
            << line("topographic", rounded(quality.topographic_error));
  if (!set.class_names.empty()) std::cout << line("purity", rounded(100.0 * purity) + " %");
  std::cout << line("clusters", std::to_string(second.count)) << line("output", arguments.output);
}

}  // namespace shape3d::apps
