#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "collection_commands.hpp"
#include "common/error.hpp"
#include "common/output_file.hpp"
#include "evaluate_report.hpp"
#include "stopwatch.hpp"

namespace shape3d::apps {
namespace {

namespace fs = std::filesystem;

bool is_fitted(const EvaluateArguments& arguments) {
  return arguments.svm || arguments.weighted || arguments.metric == "learned";
}

void check(const EvaluateArguments& arguments) {
  if (arguments.leave_one_out && arguments.folds != 0) {
    throw UsageError("--folds and --leave-one-out are both given, expected one of them");
  }
  const bool is_cross = arguments.folds != 0 || arguments.leave_one_out;
  if (is_cross && !arguments.train_classes.empty()) {
    throw UsageError(
        "--train-cla is not used with --folds and --leave-one-out: they fit to the "
        "other folds of --test-cla");
  }
  if (arguments.fold_by == "class" && arguments.folds == 0) {
    throw UsageError("--fold-by class: expected with --folds");
  }
  if (arguments.fold_by == "class" && (arguments.svm || arguments.weighted)) {
    throw UsageError(
        "--fold-by class: not used with --svm and --weighted, which cannot predict "
        "classes that they have not seen");
  }
}

void require_something_to_fit_to(const EvaluateArguments& arguments, const EvaluatedSet& set,
                                 const std::vector<int>& folds) {
  if (!is_fitted(arguments) || !folds.empty()) return;
  const char* const option = arguments.svm        ? "--svm"
                             : arguments.weighted ? "--weighted"
                                                  : "--metric learned";
  if (!set.train) {
    throw UsageError(std::string(option) +
                     ": needs models to be fitted to, expected --train-cla, or --folds N or "
                     "--leave-one-out");
  }
  const ClassNames names = joint_classes(set);
  const auto known = [&](int label) {
    return std::find(names.train_labels.begin(), names.train_labels.end(), label) !=
           names.train_labels.end();
  };
  if ((arguments.svm || arguments.weighted) &&
      std::none_of(set.test.labels.begin(), set.test.labels.end(), known)) {
    throw std::runtime_error(std::string(option) + ": no class of " + set.test.source +
                             " has the name of a class of " + set.train->source +
                             ", expected some; --classes chooses a level");
  }
}

std::string protocol_of(const EvaluateArguments& arguments, const EvaluatedSet& set) {
  std::string text = "Each of the " + std::to_string(set.test.size()) + " models of " +
                     set.test.source + " looks for its class among the others.";
  if (!is_fitted(arguments)) {
    return text + (set.train ? " Units of distances are of " + set.train->source + "."
                             : " Nothing is fitted to labels.");
  }
  if (set.train) {
    return text + " What is fitted has seen " + set.train->source + " alone (" +
           std::to_string(set.train->size()) + " models).";
  }
  if (arguments.leave_one_out) {
    return text +
           " What is fitted for a model has seen all others but this one; parameters of "
           "support vector machines were searched once, on all.";
  }
  return text + " What is fitted for a model has seen the other " +
         std::to_string(arguments.folds - 1) + " of " + std::to_string(arguments.folds) +
         " folds alone" +
         (arguments.fold_by == "class"
              ? ": no model of its class, since folds hold whole classes. It looks for its class "
                "in its "
                "own fold, of which nothing that is fitted for it has seen a model."
              : ", parameters included.");
}

// The classifier's result against the labels of a group, models of unknown classes left out.
ClassifierResult judged(ClassificationResult result, const EvaluatedSet& set,
                        const LabelGroup& group, const ClassNames& names) {
  ClassifierResult judged;
  learning::Labels truth = group.labels;
  if (set.train) {
    for (int& label : truth) {
      if (label == learning::kUnlabelled) continue;
      if (std::find(names.train_labels.begin(), names.train_labels.end(), label) ==
          names.train_labels.end()) {
        label = learning::kUnlabelled;
        ++judged.untrained;
      }
    }
  }
  judged.confusion =
      learning::confusion(truth, result.predicted, static_cast<int>(names.names.size()));
  judged.result = std::move(result);
  judged.truth = std::move(truth);
  return judged;
}

std::vector<ComparedClassifiers> compared(const std::vector<ClassifierResult>& classifiers) {
  std::vector<ComparedClassifiers> comparisons;
  for (std::size_t i = 0; i < classifiers.size(); ++i) {
    for (std::size_t j = i + 1; j < classifiers.size(); ++j) {
      const ClassifierResult &a = classifiers[i], &b = classifiers[j];
      // Models that are not counted are right for neither.
      learning::Labels first = a.result.predicted, second = b.result.predicted;
      for (std::size_t m = 0; m < a.truth.size(); ++m) {
        if (a.truth[m] == learning::kUnlabelled) first[m] = second[m] = 0;
      }
      comparisons.push_back({a.result.name, b.result.name, a.result.length == b.result.length,
                             learning::paired_test(a.truth, first, second)});
    }
  }
  return comparisons;
}

// Where folds are libraries of their own, the mean of theirs.
learning::ChanceLevel chance_of(const EvaluateArguments& arguments, const LabelGroup& group,
                                const std::vector<int>& folds) {
  if (arguments.fold_by != "class") return learning::chance_level(group.labels);
  learning::ChanceLevel sum;
  double queries = 0.0;
  for (int fold = 0; fold < arguments.folds; ++fold) {
    learning::Labels labels;
    for (std::size_t i = 0; i < folds.size(); ++i) {
      if (folds[i] == fold) labels.push_back(group.labels[i]);
    }
    const learning::ChanceLevel one = learning::chance_level(labels);
    const auto count = static_cast<double>(labels.size());
    sum.nearest_neighbour += count * one.nearest_neighbour;
    sum.first_tier += count * one.first_tier;
    sum.second_tier += count * one.second_tier;
    queries += count;
  }
  return {sum.nearest_neighbour / queries, sum.first_tier / queries, sum.second_tier / queries};
}

// Methods whose distances are weighted: those that combine descriptors, or the only one.
std::vector<std::size_t> weighted_places(const EvaluatedSet& set,
                                         const std::vector<RetrievalMethod>& methods) {
  const auto count = std::count_if(set.descriptors.begin(), set.descriptors.end(),
                                   [](const EvaluatedDescriptor& one) { return !one.baseline; });
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (!methods[i].descriptor || (count == 1 && !methods[i].baseline)) places.push_back(i);
  }
  return places;
}

void write(const std::string& folder, const std::string& name, const std::string& bytes,
           std::vector<std::unique_ptr<OutputFile>>& files) {
  files.push_back(std::make_unique<OutputFile>((fs::path(folder) / name).string()));
  files.back()->write(bytes);
  files.back()->finish();
}

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    throw FileError(folder, error ? "cannot be made: " + error.message() : "is not a folder");
  }
}

void evaluate(const EvaluateArguments& arguments, const Settings& settings) {
  check(arguments);
  make_folder(arguments.output);
  const EvaluatedSet set = described_set(arguments, settings);
  for (const DescribedPart* part : {set.train ? &*set.train : nullptr, &set.test}) {
    if (part == nullptr) continue;
    for (const std::string& sentence : part->left_out) warn(settings, "left out: " + sentence);
    for (const std::string& sentence : part->notes) warn(settings, part->source + ": " + sentence);
  }
  Stopwatch watch;
  const std::vector<int> folds = folds_of(arguments, set.test);
  require_something_to_fit_to(arguments, set, folds);
  Progress progress(settings);
  const std::vector<RetrievalMethod> methods =
      retrieval_methods(arguments, set, folds, progress, settings.threads);
  Evaluation evaluation;
  evaluation.arguments = &arguments;
  evaluation.set = &set;
  evaluation.protocol = protocol_of(arguments, set);
  const ClassNames names = joint_classes(set);
  evaluation.class_names = names.names;
  std::vector<std::vector<RetrievalMethod>> weighted;  // of each group
  weighted.reserve(2);
  for (const LabelGroup& group : label_groups(set.test)) {
    GroupResult result;
    result.group = group;
    result.chance = chance_of(arguments, group, folds);
    weighted.emplace_back();
    if (arguments.svm || arguments.weighted) {
      for (ClassificationResult& one : classifications(
               arguments, set, group, folds, arguments.weighted, progress, settings.threads)) {
        if (arguments.weighted && one.probabilities.size() > 0) {
          for (const std::size_t place : weighted_places(set, methods)) {
            for (RetrievalMethod& each : weighted_methods(methods[place], one)) {
              weighted.back().push_back(std::move(each));
            }
          }
        }
        result.classification.push_back(judged(std::move(one), set, group, names));
      }
    }
    result.comparisons = compared(result.classification);
    progress.stage("measuring " + group.name);
    std::vector<const RetrievalMethod*> all;
    for (const RetrievalMethod& method : methods) all.push_back(&method);
    for (const RetrievalMethod& method : weighted.back()) all.push_back(&method);
    for (const RetrievalMethod* const method : all) {
      result.retrieval.push_back(
          {method, learning::evaluate_retrieval(method->D, group.labels, {{}, settings.threads})});
    }
    if (result.retrieval.front().retrieval.queries.empty()) {
      if (evaluation.groups.empty()) {
        throw std::runtime_error(set.test.source +
                                 ": no class has two models, expected one at least");
      }
      continue;
    }
    evaluation.groups.push_back(std::move(result));
  }
  evaluation.seconds = watch.lap();
  progress.stage("drawing");
  std::vector<std::unique_ptr<OutputFile>> files;
  const Json report = to_json(evaluation);
  write(arguments.output, "report.json", report.dump(1) + "\n", files);
  write(arguments.output, "report.md", to_markdown(evaluation), files);
  for (const NamedPicture& picture : draw_evaluation(evaluation)) {
    write(arguments.output, picture.name, picture.png, files);
  }
  write_json(settings, report);
  for (const auto& file : files) file->commit();
  progress.clear();
  if (!settings.quiet) {
    std::cout << to_lines(evaluation)
              << line("report", (fs::path(arguments.output) / "report.md").string());
  }
}

}  // namespace

void add_evaluate(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand(
      "evaluate", "Measure retrieval and classification on a classified collection");
  command->add_option("--db-dir", arguments->folder, "Folder of the models")
      ->required()
      ->type_name("DIR");
  command
      ->add_option(
          "--train-cla", arguments->train_classes,
          "Class file (.cla) of the models that things are fitted to; may be left out when "
          "nothing is")
      ->type_name("FILE");
  command
      ->add_option("--test-cla", arguments->test_classes,
                   "Class file of the models that are evaluated")
      ->type_name("FILE");
  command
      ->add_option("--classes", arguments->level,
                   "Level of the classification (base, coarse1, coarse2, coarse3): the class files "
                   "beside the given ones, as the Princeton Shape Benchmark has them")
      ->type_name("LEVEL");
  command
      ->add_option("--path", arguments->path_pattern,
                   std::string("Where a model is below the folder, with {id}, {id/N}, {class} and "
                               "{class_path}; without it ") +
                       kPrincetonPattern)
      ->type_name("PATTERN");
  command
      ->add_option("--layout", arguments->layout,
                   "folders: classes are folders of meshes, and folders train and test say what is "
                   "what; princeton: class files (the default)")
      ->check(CLI::IsMember({"princeton", "folders"}))
      ->type_name("LAYOUT");
  command
      ->add_option("--descriptor", arguments->descriptors,
                   "What vectors are compared, as of 'describe'; with @L1, @L2, @L2_squared, "
                   "@chi_squared or @cosine behind, by which distance; may be given several times. "
                   "Without it, the set that finds most")
      ->allow_extra_args(false)
      ->type_name("SPEC[@DISTANCE]");
  command->add_option("--distance", arguments->distance, "Distance where a SPEC has none (L1)")
      ->type_name("NAME");
  command
      ->add_option("--metric", arguments->metric,
                   "fusion: distances of the descriptors, added; scaled: these in units of their "
                   "neighbourhoods, without labels (the default); learned: also a linear map that "
                   "is fitted")
      ->check(CLI::IsMember({"fusion", "scaled", "learned"}))
      ->type_name("METRIC");
  command->add_flag("--svm", arguments->svm,
                    "Also classify by support vector machines on each descriptor");
  command->add_flag("--weighted", arguments->weighted,
                    "Also weigh distances by predicted classes (5.19), hard and soft");
  command->add_flag("--baseline", arguments->baseline,
                    "Also random numbers, D2, EGI, concentric spheres and HSH of 45 numbers");
  command
      ->add_option("--folds", arguments->folds,
                   "Cross-validate on --test-cla: what is fitted for a model comes from the other "
                   "folds")
      ->check(CLI::Range(2, 1000))
      ->type_name("N");
  command->add_flag("--leave-one-out", arguments->leave_one_out, "As many folds as models");
  command
      ->add_option("--fold-by", arguments->fold_by, "model, or class: whole classes are held out")
      ->check(CLI::IsMember({"model", "class"}))
      ->type_name("WHAT");
  command->add_option("--seed", arguments->seed, "Of the folds (1)")->type_name("N");
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder of the report: report.json, report.md, pictures, and vectors.h5, from "
                   "which the next run goes on")
      ->required()
      ->type_name("DIR");
  command->add_flag("--restart", arguments->restart, "Describe all models anew");
  command->footer(
      "Examples:\n"
      "  shape3d evaluate --db-dir psb/db --train-cla base/train.cla --test-cla base/test.cla -o "
      "report\n"
      "  shape3d evaluate --db-dir psb/db --train-cla base/train.cla --test-cla base/test.cla \\\n"
      "    --classes coarse2 --svm --weighted --baseline -o report\n"
      "  shape3d evaluate --db-dir shrec11 --test-cla train.cla --path '{class}/train/T{id}.obj' "
      "-o "
      "report\n"
      "  shape3d evaluate --db-dir modelnet10 --layout folders -o report");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { evaluate(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
