#pragma once

#include <limits>
#include <string>

#include "program.hpp"
#include "stopwatch.hpp"

namespace shape3d::apps {

/// One line on standard error that says what is being done, how far it is, how long it took and how
/// long it may still take. Only where standard error is a terminal and the program is not quiet; a
/// stage that is over within half a second shows nothing.
class Progress {
 public:
  explicit Progress(const Settings& settings);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Begins a stage: "reading skull.mhd".
  void stage(std::string name);
  /// @param share  Of the stage, 0 … 1.
  /// @param left   Seconds still to go; NaN: by the share that is done.
  void update(double share, double left = std::numeric_limits<double>::quiet_NaN());
  /// Removes the line, so that a report can be printed.
  void clear();

 private:
  void show(const std::string& line);

  bool active_;
  bool shown_ = false;
  std::string name_;
  Stopwatch stage_watch_, shown_watch_;
};

}  // namespace shape3d::apps
