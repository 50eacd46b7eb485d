#pragma once

#include <cstdint>
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
/// before. The copy leaves no core file.
/// @param cpu_seconds  of processor time after which it is ended; 0: no limit.
[[nodiscard]] ChildResult run_in_child(const std::function<std::string()>& function,
                                       std::uint64_t cpu_seconds = 0);

}  // namespace shape3d::apps
