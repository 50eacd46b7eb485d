#include "program.hpp"

#include <algorithm>
#include <exception>
#include <iostream>
#include <new>
#include <vector>

#include <CLI/CLI.hpp>

#include "collection_commands.hpp"
#include "common/interrupt.hpp"
#include "common/memory_limit.hpp"
#include "common/text.hpp"
#include "learning_commands.hpp"
#include "mesh_commands.hpp"

namespace shape3d::apps {
namespace {

constexpr int kFailure = 1, kUsage = 2;

int fail(const std::string& sentence, int status) {
  std::cerr << "shape3d: " << sentence << '\n';
  return status;
}

std::vector<CLI::App*> commands_of(CLI::App& app) {
  return app.get_subcommands([](CLI::App*) { return true; });
}

bool has_command(CLI::App& app, const std::string& name) {
  const auto commands = commands_of(app);
  return std::any_of(commands.begin(), commands.end(),
                     [&name](const CLI::App* command) { return command->get_name() == name; });
}

// "info, extract or check"
std::string command_names(CLI::App& app) {
  const auto commands = commands_of(app);
  std::string names;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (i > 0) names += i + 1 == commands.size() ? " or " : ", ";
    names += commands[i]->get_name();
  }
  return names;
}

// "unknown command 'extrude', expected info, extract or check", also of a command that has
// commands; empty if the first words are names.
std::string wrong_command(CLI::App& app, int words, char** word) {
  if (words < 1 || word[0][0] == '-') return {};
  if (!has_command(app, word[0])) {
    return std::string("unknown command '") + word[0] + "', expected " + command_names(app);
  }
  CLI::App& command = *app.get_subcommand(word[0]);
  if (commands_of(command).empty()) return {};
  if (words > 1) return wrong_command(command, words - 1, word + 1);
  return "'" + command.get_name() + "' is not all of a command, expected " +
         command_names(command) + " behind it";
}

std::string memory_left() { return bytes_to_text(available_memory()) + " are available"; }

// TBB says so by a runtime_error of this text; the stack of the thread is what there is no room
// for.
bool thread_not_started(const std::string& sentence) {
  return sentence.find("pthread_create") != std::string::npos;
}

void add_shared_options(CLI::App& app, Settings& settings) {
  if (!commands_of(app).empty()) {
    for (CLI::App* command : commands_of(app)) add_shared_options(*command, settings);
    return;
  }
  app.add_flag("-q,--quiet", settings.quiet, "No report, no warnings, no progress; errors only");
  app.add_option("--threads", settings.threads,
                 "Threads to use; 0 stands for all processors (the default)")
      ->check(CLI::Range(0, 4096))
      ->type_name("N");
  app.add_option("--json", settings.json, "Write the report as JSON")->type_name("FILE");
}

}  // namespace

void warn(const Settings& settings, const std::string& sentence) {
  if (!settings.quiet) std::cerr << "shape3d: warning: " << sentence << '\n';
}

int run_program(int argc, char** argv) {
  install_interrupt_handler();
  Settings settings;
  CLI::App app(
      "3D shape analysis: surfaces from volumes, and what is computed of surfaces and volumes.");
  app.name("shape3d");
  app.set_version_flag("--version", "shape3d " SHAPE3D_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer(
      "Examples:\n"
      "  shape3d info scan/                         what a DICOM folder holds\n"
      "  shape3d extract scan/ --iso 226 -o bone.ply\n"
      "  shape3d check bone.ply\n"
      "  shape3d render bone.ply -o bone.png\n"
      "  shape3d map spot.off -o sphere.off         a sphere that keeps angles\n"
      "  shape3d library add shapes.db meshes/      a library of shapes to search\n"
      "  shape3d search shapes.db query.off --sheet found.png\n"
      "'shape3d COMMAND --help' explains a command.");
  add_info(app, settings);
  add_extract(app, settings);
  add_contours(app, settings);
  add_check(app, settings);
  add_render(app, settings);
  add_compare(app, settings);
  add_describe(app, settings);
  add_map(app, settings);
  add_align(app, settings);
  add_repair(app, settings);
  add_simplify(app, settings);
  add_wrap(app, settings);
  add_segment(app, settings);
  add_evaluate(app, settings);
  add_library(app, settings);
  add_search(app, settings);
  add_distance(app, settings);
  add_train(app, settings);
  add_classify(app, settings);
  add_map_collection(app, settings);
  add_shared_options(app, settings);
  const std::string wrong = wrong_command(app, argc - 1, argv + 1);
  if (!wrong.empty()) return fail(wrong, kUsage);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return 0;
  } catch (const CLI::CallForVersion& version) {
    std::cout << version.what() << '\n';
    return 0;
  } catch (const CLI::ParseError& error) {
    return fail(std::string(error.what()) + "; 'shape3d --help' lists the commands", kUsage);
  }
  try {
    settings.run();
    std::cout.flush();
    if (!std::cout) return fail("standard output cannot be written", kFailure);
    return 0;
  } catch (const UsageError& error) {
    return fail(error.what(), kUsage);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory; " + memory_left(), kFailure);
  } catch (const std::exception& error) {
    const std::string sentence = error.what();
    if (!thread_not_started(sentence)) return fail(sentence, kFailure);
    return fail("not enough memory for a thread (" + sentence + "); " + memory_left(), kFailure);
  }
}

}  // namespace shape3d::apps
