#pragma once

#include <optional>
#include <string>
#include <vector>

#include <shape3d/descriptors/descriptor.hpp>
#include <shape3d/learning/distance.hpp>
#include <shape3d/learning/features.hpp>

#include "collection.hpp"
#include "evaluate_arguments.hpp"
#include "program.hpp"

namespace shape3d::apps {

/// A descriptor that is evaluated, and how its vectors are compared.
struct EvaluatedDescriptor {
  std::string name;  ///< In tables: short, no two equal.
  descriptors::Descriptor descriptor;
  learning::Distance distance = learning::Distance::L1;
  double weight = 1.0;    ///< In the fusion.
  bool baseline = false;  ///< Beside the others, not in their fusion.
};

/// Reads "SPEC[@DISTANCE]".
/// @throws UsageError
[[nodiscard]] EvaluatedDescriptor parse_evaluated(const std::string& text,
                                                  const std::string& distance);

/// What is evaluated without --descriptor.
[[nodiscard]] std::vector<EvaluatedDescriptor> default_descriptors();
/// What --baseline adds: random numbers, D2, EGI, concentric spheres of 45 numbers.
[[nodiscard]] std::vector<EvaluatedDescriptor> baseline_descriptors();

/// Models of one part with a vector by each descriptor.
struct DescribedPart {
  std::string source;  ///< Class file or folder.
  std::vector<std::string> classes;
  std::vector<std::string> ids;
  learning::Labels labels;                  ///< Of `classes`.
  std::vector<learning::Features> vectors;  ///< One matrix a descriptor, a row a model.
  std::vector<std::string> left_out;        ///< Sentences: models without file, or not described.
  std::vector<std::string> notes;           ///< Sentences: classes of one member, of none.

  [[nodiscard]] std::size_t size() const { return ids.size(); }
};

/// Everything that is evaluated.
struct EvaluatedSet {
  std::vector<EvaluatedDescriptor> descriptors;
  std::optional<DescribedPart> train;
  DescribedPart test;
  double describing = 0.0;              ///< Seconds.
  std::size_t described = 0, kept = 0;  ///< Meshes now, and from an earlier run.
};

/// Finds the models and describes them; vectors are kept in FOLDER/vectors.h5 of the report, so
/// that a second run, or one after an interruption, goes on from them.
[[nodiscard]] EvaluatedSet described_set(const EvaluateArguments& arguments,
                                         const Settings& settings);

}  // namespace shape3d::apps
