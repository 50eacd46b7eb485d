#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace shape3d::apps {

/// The command line of `evaluate`.
struct EvaluateArguments {
  std::string folder;                    ///< --db-dir
  std::string train_classes;             ///< --train-cla; empty: none
  std::string test_classes;              ///< --test-cla
  std::string level;                     ///< --classes; empty: the files as they are
  std::string path_pattern;              ///< --path; empty: Princeton's
  std::string layout = "princeton";      ///< or "folders"
  std::vector<std::string> descriptors;  ///< SPEC[@DISTANCE]; empty: the default set
  std::string distance = "L1";           ///< Where a SPEC has none.
  std::string metric = "scaled";         ///< fusion, learned or scaled
  bool svm = false;
  bool weighted = false;
  bool baseline = false;
  int folds = 0;  ///< Cross-validation on the test part; 0: none.
  bool leave_one_out = false;
  std::string fold_by = "model";  ///< or "class"
  std::uint64_t seed = 1;
  std::string output;  ///< Folder of the report.
  bool restart = false;
};

}  // namespace shape3d::apps
