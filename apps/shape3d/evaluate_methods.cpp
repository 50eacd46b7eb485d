#include "evaluate_methods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <shape3d/learning/classification.hpp>
#include <shape3d/learning/distance.hpp>
#include <shape3d/learning/folds.hpp>
#include <shape3d/learning/fusion.hpp>
#include <shape3d/learning/linear_metric.hpp>
#include <shape3d/learning/weighted_distance.hpp>

namespace shape3d::apps {
namespace {

using learning::Features;
using learning::FeaturesView;
using learning::Labels;

constexpr learning::ClassWeights kWeights{0.25, 1.0};

// The descriptors that are fused.
std::vector<std::size_t> fused_descriptors(const EvaluatedSet& set) {
  std::vector<std::size_t> places;
  for (std::size_t d = 0; d < set.descriptors.size(); ++d) {
    if (!set.descriptors[d].baseline) places.push_back(d);
  }
  return places;
}

Features rows_of(const FeaturesView& X, const std::vector<Eigen::Index>& rows) {
  Features result(static_cast<Eigen::Index>(rows.size()), X.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) = X.row(rows[i]);
  }
  return result;
}

// Models of other folds become infinitely far.
void keep_folds_apart(const std::vector<int>& folds, Eigen::MatrixXd& D) {
  for (Eigen::Index i = 0; i < D.rows(); ++i) {
    for (Eigen::Index j = 0; j < D.cols(); ++j) {
      if (folds[static_cast<std::size_t>(i)] != folds[static_cast<std::size_t>(j)]) {
        D(i, j) = std::numeric_limits<double>::infinity();
      }
    }
  }
}

// Distances after a metric learnt from the train part, or row by row from the other folds.
Eigen::MatrixXd learned_distances(const EvaluatedSet& set, const std::vector<std::size_t>& parts,
                                  const std::vector<int>& folds, int threads) {
  const std::vector<double> units = joint_units(set, parts);
  const Features test = joined_vectors(set, set.test, parts, units);
  if (set.train) {
    const auto metric = learning::learn_linear_metric(joined_vectors(set, *set.train, parts, units),
                                                      set.train->labels);
    const Features y = metric.apply(test);
    return learning::distances(y, y, learning::Distance::L2, threads);
  }
  const int count = *std::max_element(folds.begin(), folds.end()) + 1;
  Eigen::MatrixXd D(test.rows(), test.rows());
  for (int fold = 0; fold < count; ++fold) {
    std::vector<Eigen::Index> in, out;
    Labels labels;
    for (std::size_t i = 0; i < folds.size(); ++i) {
      (folds[i] == fold ? in : out).push_back(static_cast<Eigen::Index>(i));
      if (folds[i] != fold) labels.push_back(set.test.labels[i]);
    }
    const auto metric = learning::learn_linear_metric(rows_of(test, out), labels);
    const Features all = metric.apply(test);
    const Eigen::MatrixXd rows =
        learning::distances(rows_of(all, in), all, learning::Distance::L2, threads);
    for (std::size_t i = 0; i < in.size(); ++i) {
      D.row(in[i]) = rows.row(static_cast<Eigen::Index>(i));
    }
  }
  return D;
}

}  // namespace

std::vector<double> joint_units(const EvaluatedSet& set,
                                const std::vector<std::size_t>& descriptors) {
  std::vector<double> units;
  for (const std::size_t d : descriptors) {
    const Features& X = (set.train ? *set.train : set.test).vectors[d];
    const Eigen::RowVectorXd mean = X.colwise().mean();
    units.push_back(std::sqrt((X.rowwise() - mean).squaredNorm() / static_cast<double>(X.rows())));
  }
  return units;
}

Features joined_vectors(const EvaluatedSet& set, const DescribedPart& part,
                        const std::vector<std::size_t>& descriptors,
                        const std::vector<double>& units) {
  Eigen::Index columns = 0;
  for (const std::size_t d : descriptors) columns += set.descriptors[d].descriptor.length();
  Features joined(static_cast<Eigen::Index>(part.size()), columns);
  Eigen::Index begin = 0;
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    const Features& X = part.vectors[descriptors[i]];
    joined.middleCols(begin, X.cols()) = X * (units[i] > 0.0 ? 1.0 / units[i] : 0.0);
    begin += X.cols();
  }
  return joined;
}

std::vector<LabelGroup> label_groups(const DescribedPart& part) {
  std::vector<LabelGroup> groups{{"all classes", part.labels, -1}};
  const auto place =
      std::find(part.classes.begin(), part.classes.end(), learning::kMiscellaneousClass);
  if (place == part.classes.end()) return groups;
  LabelGroup without = groups.front();
  without.name = "without the class -1";
  const auto miscellaneous = static_cast<int>(place - part.classes.begin());
  without.without = miscellaneous;
  bool found = false;
  for (std::size_t i = 0; i < without.labels.size(); ++i) {
    if (without.labels[i] != miscellaneous) continue;
    without.labels[i] = learning::kUnlabelled;
    found = true;
  }
  if (found) groups.push_back(std::move(without));
  return groups;
}

std::vector<int> folds_of(const EvaluateArguments& arguments, const DescribedPart& part) {
  const auto models = static_cast<int>(part.size());
  if (arguments.leave_one_out) {
    std::vector<int> folds(part.size());
    for (int i = 0; i < models; ++i) folds[static_cast<std::size_t>(i)] = i;
    return folds;
  }
  if (arguments.folds == 0) return {};
  std::vector<int> members(part.classes.size());
  for (const int label : part.labels) ++members[static_cast<std::size_t>(label)];
  const auto classes = static_cast<int>(
      std::count_if(members.begin(), members.end(), [](int count) { return count > 0; }));
  const int most = arguments.fold_by == "class" ? classes : models;
  if (arguments.folds > most) {
    throw UsageError("--folds " + std::to_string(arguments.folds) + ": expected at most " +
                     std::to_string(most) + ", the number of " +
                     (arguments.fold_by == "class" ? "classes" : "models") + " of " + part.source);
  }
  return arguments.fold_by == "class"
             ? learning::grouped_folds(part.labels, arguments.folds, arguments.seed)
             : learning::stratified_folds(part.labels, arguments.folds, arguments.seed);
}

std::vector<RetrievalMethod> retrieval_methods(const EvaluateArguments& arguments,
                                               const EvaluatedSet& set,
                                               const std::vector<int>& folds, Progress& progress,
                                               int threads) {
  progress.stage("comparing " + std::to_string(set.test.size()) + " models");
  std::vector<RetrievalMethod> methods;
  std::vector<learning::FusionPart> parts;
  for (std::size_t d = 0; d < set.descriptors.size(); ++d) {
    const EvaluatedDescriptor& one = set.descriptors[d];
    const Features& X = set.test.vectors[d];
    RetrievalMethod method;
    method.name = one.name;
    method.explanation = std::string(learning::to_string(one.distance)) + " distance";
    method.D = learning::distances(X, X, one.distance, threads);
    method.descriptor = d;
    method.baseline = one.baseline;
    if (!one.baseline) {
      const double unit =
          set.train ? learning::mean_distance(learning::distances(
                          set.train->vectors[d], set.train->vectors[d], one.distance, threads))
                    : learning::mean_distance(method.D);
      parts.push_back({method.D, unit, one.weight});
    }
    methods.push_back(std::move(method));
    progress.update(static_cast<double>(d + 1) / static_cast<double>(set.descriptors.size()));
  }
  const std::string unit_of = set.train ? "of the train part" : "of the collection";
  RetrievalMethod fusion;
  fusion.name = "fusion";
  fusion.explanation = "sum of the distances by " + std::to_string(parts.size()) +
                       " descriptors, each in units of its mean " + unit_of;
  fusion.D = learning::fused(parts);
  if (arguments.fold_by == "class") {
    // A metric treats models that it was learnt from otherwise than new ones: among the classes
    // that it has seen, those of one fold would be found by that alone.
    keep_folds_apart(folds, fusion.D);
    for (RetrievalMethod& method : methods) keep_folds_apart(folds, method.D);
  }
  const auto scaled = [](const RetrievalMethod& method) {
    RetrievalMethod result;
    result.name = method.name + ", scaled";
    result.explanation = method.explanation +
                         "; in units of the mean distances of both models to their " +
                         std::to_string(kScalingNeighbours) + " nearest";
    result.D = learning::locally_scaled(method.D, kScalingNeighbours);
    return result;
  };
  std::vector<RetrievalMethod> combined;
  if (parts.size() == 1) {  // nothing to add
    fusion.name = methods[fused_descriptors(set).front()].name;
    fusion.explanation = methods[fused_descriptors(set).front()].explanation;
  } else {
    combined.push_back(fusion);
  }
  if (arguments.metric != "fusion") combined.push_back(scaled(fusion));
  if (arguments.metric == "learned") {
    RetrievalMethod learned;
    learned.name = "learned metric";
    learned.explanation =
        "Euclidean distance of the descriptors together after a linear map learnt from " +
        (set.train ? set.train->source : "the other folds");
    learned.D = learned_distances(set, fused_descriptors(set), folds, threads);
    if (arguments.fold_by == "class") keep_folds_apart(folds, learned.D);
    combined.push_back(learned);
    combined.push_back(scaled(learned));
  }
  for (RetrievalMethod& method : combined) methods.push_back(std::move(method));
  return methods;
}

std::vector<RetrievalMethod> weighted_methods(const RetrievalMethod& method,
                                              const ClassificationResult& classes) {
  const auto count = static_cast<int>(classes.probabilities.cols());
  const Features hard = learning::hard_probabilities(classes.predicted, count);
  std::vector<RetrievalMethod> methods;
  for (const bool is_soft : {false, true}) {
    const Features& P = is_soft ? classes.probabilities : hard;
    RetrievalMethod weighted;
    weighted.name = method.name + ", weighted " + (is_soft ? "softly" : "hard");
    weighted.explanation = method.explanation + "; (5.19) with " +
                           (is_soft ? "probabilities" : "classes") + " predicted from " +
                           classes.name;
    weighted.D = learning::class_weighted(method.D, P, P, kWeights);
    methods.push_back(std::move(weighted));
  }
  return methods;
}

}  // namespace shape3d::apps
