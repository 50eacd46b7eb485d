#include <algorithm>
#include <map>
#include <stdexcept>

#include <shape3d/learning/folds.hpp>
#include <shape3d/learning/linear_metric.hpp>
#include <shape3d/learning/svm.hpp>
#include <shape3d/learning/svm_search.hpp>

#include "evaluate_methods.hpp"

namespace shape3d::apps {
namespace {

using Eigen::Index;
using learning::Features;
using learning::FeaturesView;
using learning::kUnlabelled;
using learning::Labels;
using learning::SvmOptions;

// γ in units of one over the variance of all columns together.
const learning::SvmGrid kGrid{{2.0, 8.0}, {0.5, 1.0, 2.0}};
constexpr int kSearchFolds = 3;
constexpr int kMostNestedSearches = 10;
constexpr int kMostColumns = 100;

// Options found by cross-validation on the rows that have a label; the middle of the grid where
// fewer than two classes have two members.
SvmOptions searched_options(const FeaturesView& X, const Labels& labels, bool are_components,
                            bool probabilities, std::uint64_t seed, int threads) {
  SvmOptions options;
  options.seed = seed;
  learning::SvmGrid grid = kGrid;
  double variance = static_cast<double>(X.cols());  // of standardised columns together
  if (are_components) {  // the small ones of which would be as large as the others
    options.scaling = learning::ScalingKind::none;
    const Eigen::RowVectorXd mean = X.colwise().mean();
    variance = (X.rowwise() - mean).squaredNorm() / static_cast<double>(X.rows());
  }
  if (variance > 0.0) {
    for (double& gamma : grid.gamma) gamma /= variance;
  }
  options.C = grid.C.back();
  options.gamma = grid.gamma[1];
  options.probabilities = probabilities;
  std::map<int, int> members;
  for (const int label : labels) {
    if (label != kUnlabelled) ++members[label];
  }
  const auto is_searchable = [](const auto& one) { return one.second > 1; };
  if (std::count_if(members.begin(), members.end(), is_searchable) < 2) return options;
  const int folds = std::min<int>(kSearchFolds, static_cast<int>(labels.size()));
  const auto search = learning::search_svm(
      X, labels, learning::stratified_folds(labels, folds, seed), options, grid, threads);
  options.C = search.C;
  options.gamma = search.gamma;
  return options;
}

// Predictions for models of the test part.
struct Predictions {
  Labels labels;
  Features probabilities;  // columns: classes of the test part, then those of the train part alone
  SvmOptions options;
};

void require_two_classes(const Labels& labels, const std::string& source) {
  std::map<int, int> members;
  for (const int label : labels) {
    if (label != kUnlabelled) ++members[label];
  }
  if (members.size() < 2) {
    throw std::runtime_error(source + ": has models of " + std::to_string(members.size()) +
                             " classes, expected 2 or more for --svm and --weighted");
  }
}

Features in_columns(const Features& P, const std::vector<int>& classes, int count) {
  Features result = Features::Zero(P.rows(), count);
  for (std::size_t c = 0; c < classes.size(); ++c) {
    result.col(classes[c]) = P.col(static_cast<Index>(c));
  }
  return result;
}

// Long vectors are given in their principal components, found on what is trained on.
Predictions trained(Features train, const Labels& labels, Features test, int classes,
                    bool probabilities, std::uint64_t seed, int threads) {
  const bool is_long = train.cols() > kMostColumns;
  if (is_long) {
    const auto components = learning::principal_components(train, kMostColumns);
    train = components.apply(train);
    test = components.apply(test);
  }
  Predictions result;
  result.options = searched_options(train, labels, is_long, probabilities, seed, threads);
  const auto svm = learning::Svm::train(train, labels, result.options, threads);
  result.labels = svm.predict(test, threads);
  if (probabilities) {
    result.probabilities = in_columns(svm.probabilities(test, threads), svm.classes(), classes);
  }
  return result;
}

Features chosen_rows(const FeaturesView& X, const std::vector<Index>& rows) {
  Features result(static_cast<Index>(rows.size()), X.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) result.row(static_cast<Index>(i)) = X.row(rows[i]);
  return result;
}

// Each fold by a machine whose parameters, and principal components, come from the other folds,
// too; where there are too many folds for that, these come from all models.
Predictions cross_validated(Features X, const Labels& labels, const std::vector<int>& folds,
                            int classes, bool probabilities, std::uint64_t seed, int threads) {
  const int count = *std::max_element(folds.begin(), folds.end()) + 1;
  Predictions result;
  if (count > kMostNestedSearches) {
    const bool is_long = X.cols() > kMostColumns;
    if (is_long) {
      X = learning::principal_components(X, kMostColumns).apply(X);
    }
    result.options = searched_options(X, labels, is_long, probabilities, seed, threads);
    learning::SvmPredictions found =
        learning::cross_validate_svm(X, labels, folds, result.options, threads);
    result.labels = std::move(found.labels);
    if (probabilities)
      result.probabilities = in_columns(found.probabilities, found.classes, classes);
    return result;
  }
  result.labels.assign(labels.size(), kUnlabelled);
  if (probabilities) result.probabilities = Features::Zero(X.rows(), classes);
  for (int fold = 0; fold < count; ++fold) {
    std::vector<Index> in, out;
    Labels others;
    for (std::size_t i = 0; i < folds.size(); ++i) {
      (folds[i] == fold ? in : out).push_back(static_cast<Index>(i));
      if (folds[i] != fold) others.push_back(labels[i]);
    }
    const Predictions part = trained(chosen_rows(X, out), others, chosen_rows(X, in), classes,
                                     probabilities, seed, threads);
    for (std::size_t i = 0; i < in.size(); ++i) {
      result.labels[static_cast<std::size_t>(in[i])] = part.labels[i];
      if (probabilities) {
        result.probabilities.row(in[i]) = part.probabilities.row(static_cast<Index>(i));
      }
    }
    result.options = part.options;
  }
  return result;
}

// What machines are trained on: vectors of one descriptor, or of several together.
struct Input {
  std::string name;
  bool baseline = false;
  Features train, test;
};

std::vector<Input> inputs_of(const EvaluatedSet& set) {
  std::vector<Input> inputs;
  std::vector<std::size_t> together;
  for (std::size_t d = 0; d < set.descriptors.size(); ++d) {
    inputs.push_back({set.descriptors[d].name, set.descriptors[d].baseline,
                      set.train ? set.train->vectors[d] : Features(), set.test.vectors[d]});
    if (!set.descriptors[d].baseline) together.push_back(d);
  }
  if (together.size() > 1) {
    const std::vector<double> units = joint_units(set, together);
    inputs.push_back({"all together", false,
                      set.train ? joined_vectors(set, *set.train, together, units) : Features(),
                      joined_vectors(set, set.test, together, units)});
  }
  return inputs;
}

}  // namespace

ClassNames joint_classes(const EvaluatedSet& set) {
  ClassNames names{set.test.classes, {}};
  if (!set.train) return names;
  std::map<std::string, int> places;
  for (std::size_t c = 0; c < names.names.size(); ++c) {
    places[names.names[c]] = static_cast<int>(c);
  }
  std::vector<int> of_train;
  for (const std::string& name : set.train->classes) {
    const auto [place, is_new] = places.insert({name, static_cast<int>(names.names.size())});
    if (is_new) names.names.push_back(name);
    of_train.push_back(place->second);
  }
  for (const int label : set.train->labels) {
    names.train_labels.push_back(of_train[static_cast<std::size_t>(label)]);
  }
  return names;
}

std::vector<ClassificationResult> classifications(const EvaluateArguments& arguments,
                                                  const EvaluatedSet& set, const LabelGroup& group,
                                                  const std::vector<int>& folds, bool probabilities,
                                                  Progress& progress, int threads) {
  const ClassNames names = joint_classes(set);
  const auto classes = static_cast<int>(names.names.size());
  Labels train_labels = names.train_labels;
  if (group.without >= 0) {
    std::replace(train_labels.begin(), train_labels.end(), group.without, kUnlabelled);
  }
  require_two_classes(set.train ? train_labels : group.labels,
                      set.train ? set.train->source : set.test.source);
  const std::vector<Input> inputs = inputs_of(set);
  std::vector<ClassificationResult> results;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Input& input = inputs[i];
    progress.stage("training support vector machines on " + input.name);
    progress.update(static_cast<double>(i) / static_cast<double>(inputs.size()));
    const bool wanted = probabilities && i + 1 == inputs.size();
    Predictions found = set.train ? trained(input.train, train_labels, input.test, classes, wanted,
                                            arguments.seed, threads)
                                  : cross_validated(input.test, group.labels, folds, classes,
                                                    wanted, arguments.seed, threads);
    results.push_back({input.name, input.baseline, input.test.cols(), found.options.C,
                       found.options.gamma, std::move(found.labels),
                       std::move(found.probabilities)});
  }
  return results;
}

}  // namespace shape3d::apps
