#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shape3d/learning/confusion.hpp>
#include <shape3d/learning/features.hpp>
#include <shape3d/learning/retrieval.hpp>

#include "evaluate_arguments.hpp"
#include "evaluate_set.hpp"
#include "program.hpp"
#include "progress.hpp"

namespace shape3d::apps {

/// Neighbours whose mean distance is the unit of locally scaled distances.
inline constexpr int kScalingNeighbours = 12;

/// Distances between all models of the test part.
struct RetrievalMethod {
  std::string name;
  std::string explanation;
  Eigen::MatrixXd D;
  std::optional<std::size_t> descriptor;  ///< Whose vectors alone it compares.
  bool baseline = false;
};

/// Models predicted by a support vector machine.
struct ClassificationResult {
  std::string name;  ///< Of the descriptor.
  bool baseline = false;
  Eigen::Index length = 0;           ///< Numbers of a vector.
  double C = 0.0, gamma = 0.0;       ///< Of the last machine that was trained.
  learning::Labels predicted;        ///< In joint_classes().
  learning::Features probabilities;  ///< Models by joint_classes(); may be empty.
};

/// Which labels are evaluated: all, or without the miscellaneous class.
struct LabelGroup {
  std::string name;
  learning::Labels labels;  ///< kUnlabelled: in the library, but no query.
  int without = -1;         ///< The class that is left out; −1: none.
};

/// All classes; and when the class "-1" is there and has members, also without it.
[[nodiscard]] std::vector<LabelGroup> label_groups(const DescribedPart& part);

/// The folds of cross-validation; empty when there is none.
[[nodiscard]] std::vector<int> folds_of(const EvaluateArguments& arguments,
                                        const DescribedPart& part);

/// Each descriptor by itself, their fusion, and what arguments.metric adds.
[[nodiscard]] std::vector<RetrievalMethod> retrieval_methods(const EvaluateArguments& arguments,
                                                             const EvaluatedSet& set,
                                                             const std::vector<int>& folds,
                                                             Progress& progress, int threads);

/// Names of the classes of the test part, then of those of the train part alone; and the labels of
/// the train part in them.
struct ClassNames {
  std::vector<std::string> names;
  learning::Labels train_labels;
};
[[nodiscard]] ClassNames joint_classes(const EvaluatedSet& set);

/// Root mean squares of the vectors of each descriptor about their mean, in the train part where
/// there is one: the units in which descriptors stand beside each other.
[[nodiscard]] std::vector<double> joint_units(const EvaluatedSet& set,
                                              const std::vector<std::size_t>& descriptors);

/// Vectors of several descriptors side by side, each divided by its unit.
[[nodiscard]] learning::Features joined_vectors(const EvaluatedSet& set, const DescribedPart& part,
                                                const std::vector<std::size_t>& descriptors,
                                                const std::vector<double>& units);

/// Support vector machines on each descriptor and on all that are no baseline together, trained on
/// the train part or on the other folds.
[[nodiscard]] std::vector<ClassificationResult> classifications(
    const EvaluateArguments& arguments, const EvaluatedSet& set, const LabelGroup& group,
    const std::vector<int>& folds, bool probabilities, Progress& progress, int threads);

/// Class-weighted distances (5.19), hard and soft, of the method.
[[nodiscard]] std::vector<RetrievalMethod> weighted_methods(const RetrievalMethod& method,
                                                            const ClassificationResult& classes);

}  // namespace shape3d::apps
