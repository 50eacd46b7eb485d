#pragma once

#include <functional>
#include <string>

namespace shape3d::apps {

/// How a function ended that ran in a child process.
struct ChildResult {
  bool ok = false;
  std::string output;  ///< What the function returned.
  std::string error;   ///< what() of its exception, or "ended by signal 6 (Aborted)".
};

/// Runs a function in a forked copy of this process and hands back the string it returns, so that
/// a library that aborts takes only the copy with it. What the copy prints is discarded.
///
/// Only the calling thread exists in the copy: the function must not use thread pools started
/// before.
[[nodiscard]] ChildResult run_in_child(const std::function<std::string()>& function);

}  // namespace shape3d::apps
