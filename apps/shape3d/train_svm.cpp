#include <algorithm>
#include <cmath>
#include <iostream>

#include <shape3d/learning/folds.hpp>
#include <shape3d/learning/svm_search.hpp>

#include "common/error.hpp"
#include "common/text.hpp"
#include "progress.hpp"
#include "train_arguments.hpp"

namespace shape3d::apps {
namespace {

using learning::kUnlabelled;
using learning::SvmKernel;

// Rows that cross-validation predicts and that can be judged, and how many of them are right.
struct Held {
  int judged = 0, right = 0;
  [[nodiscard]] double rate() const {
    return judged == 0 ? 0.0 : static_cast<double>(right) / judged;
  }
};

Held judge(const TrainingSet& set, const learning::Labels& predicted) {
  const std::vector<int> sizes = class_sizes(set);
  Held held;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const int label = set.labels[i];
    if (label == kUnlabelled || sizes[static_cast<std::size_t>(label)] < 2) continue;
    ++held.judged;
    if (predicted[i] == label) ++held.right;
  }
  return held;
}

Json confusion_table(const TrainingSet& set, const learning::Labels& predicted) {
  const std::size_t k = set.class_names.size();
  std::vector<std::vector<int>> table(k, std::vector<int>(k, 0));
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    if (set.labels[i] == kUnlabelled || predicted[i] == kUnlabelled) continue;
    ++table[static_cast<std::size_t>(set.labels[i])][static_cast<std::size_t>(predicted[i])];
  }
  return table;
}

// Folds of the rows that have a label; the others are in a fold of their own that nobody looks at.
std::vector<int> folds_of(const TrainingSet& set, int k, std::uint64_t seed) {
  learning::Labels labelled;
  for (const int label : set.labels) {
    if (label != kUnlabelled) labelled.push_back(label);
  }
  const std::vector<int> dealt = learning::stratified_folds(labelled, k, seed);
  std::vector<int> folds;
  std::size_t next = 0;
  for (const int label : set.labels) folds.push_back(label == kUnlabelled ? k : dealt[next++]);
  return folds;
}

}  // namespace

void train_svm(const TrainSvmArguments& arguments, const Settings& settings) {
  const TrainingSet set = read_training_set(arguments.source);
  require_classes(set, settings);
  const auto labelled = std::count_if(set.labels.begin(), set.labels.end(),
                                      [](int label) { return label != kUnlabelled; });
  const std::vector<int> sizes = class_sizes(set);
  if (*std::max_element(sizes.begin(), sizes.end()) < 2) {
    throw FileError(set.source, "every class has a single model, expected classes of two or more");
  }
  if (labelled < arguments.folds) {
    throw UsageError("--folds " + std::to_string(arguments.folds) + ": expected at most " +
                     std::to_string(labelled) + ", the number of models with a class");
  }
  const std::vector<int> folds = folds_of(set, arguments.folds, arguments.seed);

  learning::SvmOptions options = arguments.options;
  options.seed = arguments.seed;
  Json report = training_report("svm", set);
  Progress progress(settings);
  if (!arguments.C || (options.kernel == SvmKernel::rbf && !arguments.gamma)) {
    learning::SvmGrid grid = learning::default_svm_grid(options.kernel);
    if (arguments.C) grid.C = {*arguments.C};
    if (arguments.gamma) grid.gamma = {*arguments.gamma};
    progress.stage("searching C and gamma");
    const learning::SvmSearch search = learning::search_svm(
        set.vectors, set.labels, folds, options, grid, settings.threads, [&](double share) {
          progress.update(share);
          return true;
        });
    options.C = search.C;
    options.gamma = search.gamma;
    Json rates = Json::array();
    for (Eigen::Index c = 0; c < search.correct_rate.rows(); ++c) {
      for (Eigen::Index g = 0; g < search.correct_rate.cols(); ++g) {
        Json rate = {{"C", grid.C[static_cast<std::size_t>(c)]}};
        if (options.kernel == SvmKernel::rbf)
          rate["gamma"] = grid.gamma[static_cast<std::size_t>(g)];
        rate["correct_rate"] = search.correct_rate(c, g);
        rates.push_back(rate);
      }
    }
    report["search"] = rates;
  } else {
    options.C = *arguments.C;
    options.gamma = arguments.gamma.value_or(0.0);
  }
  if (options.kernel == SvmKernel::linear) options.gamma = 0.0;

  progress.stage("cross-validating");
  learning::SvmOptions plain = options;
  plain.probabilities = false;
  const learning::Labels predicted =
      learning::cross_validate_svm(set.vectors, set.labels, folds, plain, settings.threads).labels;
  const Held held = judge(set, predicted);
  progress.stage("training");
  const learning::Svm svm =
      learning::Svm::train(set.vectors, set.labels, options, settings.threads);
  progress.clear();

  report["kernel"] = options.kernel == SvmKernel::rbf ? "rbf" : "linear";
  report["C"] = options.C;
  if (options.kernel == SvmKernel::rbf) report["gamma"] = svm.options().gamma;
  report["scaling"] = scaling_name(options.scaling);
  report["balanced"] = options.balanced;
  report["probabilities"] = options.probabilities;
  report["support_vectors"] = svm.support_vectors();
  report["folds"] = arguments.folds;
  report["seed"] = arguments.seed;
  report["cross_validation"] = {{"models", held.judged},
                                {"correct", held.right},
                                {"correct_rate", held.rate()},
                                {"confusion", confusion_table(set, predicted)}};
  write_training(arguments, {learning::ModelKind::svm, set.spec, set.class_names, svm.serialize()},
                 report, settings);
  if (settings.quiet) return;
  std::cout << training_lines(set) << line("C", to_text(options.C));
  if (options.kernel == SvmKernel::rbf) std::cout << line("gamma", to_text(svm.options().gamma));
  std::cout << line("support vectors", std::to_string(svm.support_vectors()))
            << line("correct", rounded(100.0 * held.rate()) + " % of " +
                                   std::to_string(held.judged) + " in " +
                                   std::to_string(arguments.folds) + "-fold cross-validation")
            << line("output", arguments.output);
}

}  // namespace shape3d::apps
