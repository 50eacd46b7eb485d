#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/feature_table.hpp"
#include "common/output_file.hpp"
#include "describe_journal.hpp"
#include "program.hpp"

namespace shape3d::apps {

/// The command line of `describe`.
struct DescribeArguments {
  std::vector<std::string> meshes;
  std::string list;
  std::vector<std::string> descriptors;
  std::string output;
  bool keep_going = false;
  bool restart = false;
  std::string show;
  std::string picture;
};

/// A table of described meshes, written but not yet under its name.
struct DescribeOutcome {
  FeatureTable table;
  std::vector<Eigen::Index> lengths;  ///< Numbers of the vectors of each set.
  std::size_t meshes = 0, kept = 0;   ///< Named; of an earlier run.
  double seconds = 0.0;
  std::unique_ptr<OutputFile> file;
  std::unique_ptr<DescribeJournal> journal;

  /// Gives the table its name and removes the journal.
  void commit();
};

/// Describes all meshes into the table arguments.output. Meshes that cannot be described are named
/// on standard error and in the table.
[[nodiscard]] DescribeOutcome describe_to_table(const DescribeArguments& arguments,
                                                const Settings& settings);

/// The same as a sub-command: with its report.
void describe_files(const DescribeArguments& arguments, const Settings& settings);

/// Draws how the vector of one mesh comes about.
void show_descriptor(const DescribeArguments& arguments, const Settings& settings);

}  // namespace shape3d::apps
