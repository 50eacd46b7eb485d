#include <iostream>

#include <shape3d/learning/linear_metric.hpp>

#include "train_arguments.hpp"

namespace shape3d::apps {

void train_metric(const TrainMetricArguments& arguments, const Settings& settings) {
  const TrainingSet set = read_training_set(arguments.source);
  require_classes(set, settings);
  learning::LinearMetricOptions options;
  options.components = arguments.components;
  options.shrinkage = arguments.shrinkage;
  const learning::LinearMetric metric =
      learning::learn_linear_metric(set.vectors, set.labels, options);
  Json report = training_report("metric", set);
  report["shrinkage"] = options.shrinkage;
  report["components"] = metric.transform.rows();
  write_training(arguments,
                 {learning::ModelKind::metric, set.spec, set.class_names, metric.serialize()},
                 report, settings);
  if (settings.quiet) return;
  std::cout << training_lines(set) << line("components", std::to_string(metric.transform.rows()))
            << line("output", arguments.output);
}

}  // namespace shape3d::apps
