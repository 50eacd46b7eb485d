#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <shape3d/learning/model_file.hpp>
#include <shape3d/learning/som.hpp>
#include <shape3d/learning/svm.hpp>

#include "program.hpp"
#include "report.hpp"
#include "training_set.hpp"

namespace shape3d::apps {

/// What all kinds of `train` share.
struct TrainArguments {
  TrainingSource source;
  std::string output;
  std::uint64_t seed = 1;
};

struct TrainSvmArguments : TrainArguments {
  learning::SvmOptions options;
  std::optional<double> C, gamma;  ///< Empty: searched for.
  int folds = 5;
};

enum class SecondLevel { kmeans, single, complete, average, ward };

struct TrainSomArguments : TrainArguments {
  learning::SomOptions options;
  SecondLevel second_level = SecondLevel::kmeans;
  int clusters = 0;  ///< 0: by the Davies–Bouldin index.
};

struct TrainMetricArguments : TrainArguments {
  int components = 100;
  double shrinkage = 1.0;
};

void train_svm(const TrainSvmArguments& arguments, const Settings& settings);
void train_som(const TrainSomArguments& arguments, const Settings& settings);
void train_metric(const TrainMetricArguments& arguments, const Settings& settings);

/// A report with what every training says: source, descriptor, models, classes.
[[nodiscard]] Json training_report(const std::string& kind, const TrainingSet& set);
/// The same for a person.
[[nodiscard]] std::string training_lines(const TrainingSet& set);

/// Writes the model and the report, each in one step.
void write_training(const TrainArguments& arguments, const learning::ModelFile& model,
                    const Json& report, const Settings& settings);

/// "scaling" by its name in options and reports.
[[nodiscard]] std::string scaling_name(learning::ScalingKind kind);

}  // namespace shape3d::apps
