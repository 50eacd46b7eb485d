#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace CLI {
class App;
}

namespace shape3d::apps {

/// The command line contradicts itself or names something that is not there: exit status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What all sub-commands share.
struct Settings {
  bool quiet =
      false;         ///< No report on standard output, no warnings and progress on standard error.
  int threads = 0;   ///< 0: all processors.
  std::string json;  ///< File for the report; empty: none.
  std::function<void()> run;  ///< The chosen sub-command, set while the command line is parsed.
};

// Each adds one sub-command, whose callback sets settings.run; the settings outlive the parser.
void add_info(CLI::App& app, Settings& settings);
void add_extract(CLI::App& app, Settings& settings);
void add_contours(CLI::App& app, Settings& settings);
void add_check(CLI::App& app, Settings& settings);
void add_render(CLI::App& app, Settings& settings);
void add_compare(CLI::App& app, Settings& settings);
void add_describe(CLI::App& app, Settings& settings);
void add_segment(CLI::App& app, Settings& settings);
void add_library(CLI::App& app, Settings& settings);
void add_search(CLI::App& app, Settings& settings);
void add_distance(CLI::App& app, Settings& settings);

/// Prints "shape3d: warning: SENTENCE" on standard error unless settings.quiet.
void warn(const Settings& settings, const std::string& sentence);

/// Parses the command line and runs the sub-command.
/// @return 0, or 2 for a wrong command line, or 1 for a failure, with a sentence on standard error.
int run_program(int argc, char** argv);

}  // namespace shape3d::apps
