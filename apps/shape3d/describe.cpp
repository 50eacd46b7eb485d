#include <memory>

#include <CLI/CLI.hpp>

#include "describe_arguments.hpp"

namespace shape3d::apps {
namespace {

void describe(const DescribeArguments& arguments, const Settings& settings) {
  if (arguments.show.empty()) {
    if (!arguments.picture.empty()) {
      throw UsageError("--picture " + arguments.picture + ": expected with --show SPEC");
    }
    describe_files(arguments, settings);
    return;
  }
  for (const auto& [option, given] : {std::pair{"--descriptor", !arguments.descriptors.empty()},
                                      std::pair{"--output", !arguments.output.empty()},
                                      std::pair{"--list", !arguments.list.empty()},
                                      std::pair{"--keep-going", arguments.keep_going},
                                      std::pair{"--restart", arguments.restart}}) {
    if (given) throw UsageError(std::string(option) + ": not used with --show");
  }
  show_descriptor(arguments, settings);
}

}  // namespace

void add_describe(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<DescribeArguments>();
  CLI::App* command = app.add_subcommand("describe", "Compute feature vectors of meshes");
  command->add_option("MESH", arguments->meshes, "Meshes (.ply, .obj, .off, .stl, .vtp)");
  command->add_option("--list", arguments->list, "A text file that names a mesh on each line")
      ->type_name("FILE");
  command
      ->add_option(
          "--descriptor", arguments->descriptors,
          "What to compute: KIND:KEY=VALUE,… of the kinds hsh, csm, d2, egi, panorama, random, and "
          "for closed meshes of genus 0 sni, sci, sgi; may be given several times")
      ->allow_extra_args(false)
      ->type_name("SPEC");
  command
      ->add_option(
          "-o,--output", arguments->output,
          "The table (.csv, .npy, .h5). Vectors of unchanged files that it holds are kept, "
          "and what an interrupted run left in FILE.part is continued")
      ->type_name("FILE");
  command->add_flag("--restart", arguments->restart,
                    "Describe all meshes anew, whatever the table holds");
  command->add_flag("--keep-going", arguments->keep_going,
                    "Exit status 0 even when meshes could not be described");
  command
      ->add_option("--show", arguments->show,
                   "Draw how this descriptor of one mesh comes about, instead of a table")
      ->type_name("SPEC");
  command->add_option("--picture", arguments->picture, "The picture of --show (.png)")
      ->type_name("FILE");
  command->footer(
      "Examples:\n"
      "  shape3d describe a.off b.off --descriptor hsh:K=8 -o vectors.csv\n"
      "  shape3d describe --list meshes.txt --descriptor hsh:K=15,invariants=gram --descriptor d2 "
      "-o vectors.h5\n"
      "  shape3d describe --show hsh:K=8 a.off --picture a.png");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { describe(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
