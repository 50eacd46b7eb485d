#pragma once

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/feature_table.hpp"

namespace shape3d::apps {

/// Vectors of one file, one for each descriptor.
struct DescribedFile {
  FeatureFile file;
  std::vector<Eigen::VectorXd> vectors;
};

/// What a run of `describe` has computed, on disk at once, so that a run that was interrupted is
/// continued by the next one. Records carry a check sum: reading ends at the first that is not
/// whole, and the rest is cut off.
class DescribeJournal {
 public:
  /// Opens the journal or begins one, and locks it against a second run.
  /// @param specs    Of the descriptors in turn. @param lengths  Numbers of their vectors.
  /// @throws FileError  it cannot be written, is of another run at the same time, is not a journal,
  /// or is of other descriptors.
  DescribeJournal(std::string path, const std::vector<std::string>& specs,
                  std::vector<Eigen::Index> lengths);
  ~DescribeJournal();
  DescribeJournal(const DescribeJournal&) = delete;
  DescribeJournal& operator=(const DescribeJournal&) = delete;

  /// What earlier runs have computed, by path; the latest where a path occurs again.
  [[nodiscard]] const std::map<std::string, DescribedFile>& entries() const { return entries_; }

  /// @throws FileError  writing failed.
  void append(const DescribedFile& entry);

  /// Removes the file: its content is in the table.
  void remove();

 private:
  void read(const std::vector<std::string>& specs);

  std::string path_;
  std::vector<Eigen::Index> lengths_;
  std::map<std::string, DescribedFile> entries_;
  int descriptor_ = -1;
};

/// A sentence when vectors of the descriptors `found` are not those of `wanted`; else empty.
[[nodiscard]] std::string descriptor_difference(const std::vector<std::string>& found,
                                                const std::vector<std::string>& wanted);

}  // namespace shape3d::apps
