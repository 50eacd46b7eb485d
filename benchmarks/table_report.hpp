#pragma once

#include <string>
#include <vector>

#include "comparison.hpp"

namespace shape3d::bench {

/// The machine and the build, as far as times depend on them.
struct Environment {
  std::string processor;
  int processors = 0;
  double load = 0.0;  ///< Mean number of running processes in the last minute, at the start.
  std::string compiler, flags, vtk, scikit_image, huge_pages;
};

[[nodiscard]] Environment environment();

/// A page in Markdown: surfaces, times, ratios, memory, floor, growth, each as a table.
///
/// @param picture  File name of the plot, relative to the page; empty: no plot.
[[nodiscard]] std::string table_report(const Environment& environment,
                                       const std::vector<VolumeResult>& results,
                                       const std::string& picture);

}  // namespace shape3d::bench
