#pragma once

#include <string>
#include <vector>

#include "evaluate_methods.hpp"
#include "report.hpp"

namespace shape3d::apps {

/// Retrieval by one method with the labels of one group.
struct MethodResult {
  const RetrievalMethod* method = nullptr;
  learning::RetrievalResult retrieval;
};

/// A classifier with the labels of one group.
struct ClassifierResult {
  ClassificationResult result;
  learning::Confusion confusion;  ///< Classes of joint_classes().
  learning::Labels truth;         ///< kUnlabelled: not counted.
  int untrained = 0;  ///< Models of classes that were not trained, which are not counted.
};

/// Two classifiers on the same models.
struct ComparedClassifiers {
  std::string first, second;
  bool equal_length = false;  ///< Of vectors of as many numbers.
  learning::PairedTest test;
};

struct GroupResult {
  LabelGroup group;
  learning::ChanceLevel chance;
  std::vector<MethodResult> retrieval;
  std::vector<ClassifierResult> classification;
  std::vector<ComparedClassifiers> comparisons;  ///< All pairs.
};

/// All that is reported.
struct Evaluation {
  const EvaluateArguments* arguments = nullptr;
  const EvaluatedSet* set = nullptr;
  std::string protocol;                  ///< Sentences: who looks for what, what is fitted to what.
  std::vector<std::string> class_names;  ///< joint_classes()
  std::vector<GroupResult> groups;
  double seconds = 0.0;  ///< After describing.
};

/// report.json
[[nodiscard]] Json to_json(const Evaluation& evaluation);
/// report.md: tables of measures, of classes and of confusions.
[[nodiscard]] std::string to_markdown(const Evaluation& evaluation);
/// Tables for a terminal.
[[nodiscard]] std::string to_lines(const Evaluation& evaluation);

/// A picture of a report.
struct NamedPicture {
  std::string name;  ///< "precision-recall.png"
  std::string png;
};
/// Precision–recall curves of all methods, and of each class; correct classification rates and
/// confusions where there are classifiers.
[[nodiscard]] std::vector<NamedPicture> draw_evaluation(const Evaluation& evaluation);

}  // namespace shape3d::apps
