#include <memory>

#include <CLI/CLI.hpp>

#include "common/shape_library.hpp"
#include "library_arguments.hpp"

namespace shape3d::apps {
namespace {

// A sub-command of `library` with its arguments, which outlive the parser.
template <class Arguments>
std::pair<CLI::App*, std::shared_ptr<Arguments>> add_command(
    CLI::App& library, Settings& settings, const std::string& name, const std::string& text,
    void (*run)(const Arguments&, const Settings&)) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = library.add_subcommand(name, text);
  command->add_option("LIBRARY", arguments->library, "The library (.db)")->required();
  command->callback([arguments, run, &settings] {
    settings.run = [arguments, run, &settings] { run(*arguments, settings); };
  });
  return {command, arguments};
}

void add_descriptor_option(CLI::App& command, std::vector<std::string>& descriptors,
                           const std::string& text) {
  command.add_option("--descriptor", descriptors, text)->allow_extra_args(false)->type_name("SPEC");
}

void add_add(CLI::App& library, Settings& settings) {
  const auto [command, arguments] = add_command(
      library, settings, "add", "Describe meshes and put them into a library", &library_add);
  command
      ->add_option("MESH", arguments->meshes,
                   "Meshes (.ply, .obj, .off, .stl, .vtp), and folders to look through")
      ->required();
  auto* classes = command->add_option("--classes", arguments->classes,
                                      "Classes of the meshes, in the format of the Princeton "
                                      "Shape Benchmark: its ids are the digits at the end of the "
                                      "meshes' names");
  classes->type_name("FILE.cla");
  command
      ->add_flag("--class-from-folder", arguments->class_from_folder,
                 "The class is the folder below FOLDER that holds the mesh; of a single mesh, its "
                 "folder")
      ->excludes(classes);
  add_descriptor_option(*command, arguments->descriptors,
                        std::string("What to compute, as of 'describe'; may be given several "
                                    "times. Default: what the library has, or ") +
                            kDefaultDescriptor);
  command->add_flag("--no-thumbnails", arguments->no_thumbnails, "Draw no small pictures");
  command->add_flag("--keep-going", arguments->keep_going,
                    "Exit status 0 even when meshes could not be described");
  command->footer(
      "Meshes that are there already and have not changed are kept; what an interrupted run has\n"
      "described is kept, too.\n"
      "Examples:\n"
      "  shape3d library add shapes.db meshes/ --class-from-folder\n"
      "  shape3d library add psb.db db/ --classes train.cla --descriptor hsh:K=8 --descriptor d2");
}

void add_others(CLI::App& library, Settings& settings) {
  {
    const auto [command, arguments] =
        add_command(library, settings, "list", "List the models of a library", &library_list);
    command->add_option("--class", arguments->class_name, "Only those of this class")
        ->type_name("NAME");
  }
  {
    const auto [command, arguments] =
        add_command(library, settings, "info", "Say what a library holds", &library_info);
    command->add_option("--id", arguments->id, "Of one model")
        ->check(CLI::PositiveNumber)
        ->type_name("N");
  }
  {
    const auto [command, arguments] =
        add_command(library, settings, "remove", "Take models out of a library", &library_remove);
    command->add_option("MODEL", arguments->models, "Ids, or paths of their meshes");
    command->add_flag("--missing", arguments->missing, "Also all whose meshes are gone");
  }
  {
    const auto [command, arguments] = add_command(
        library, settings, "check",
        "Read all of a library, and compare its meshes with their digests", &library_check);
    command->add_flag("--no-files", arguments->no_files, "The meshes are not looked at");
  }
  {
    const auto [command, arguments] = add_command(
        library, settings, "export", "Write feature vectors as a table", &library_export);
    command->add_option("--npy", arguments->npy, "For NumPy")->type_name("FILE");
    command->add_option("--csv", arguments->csv, "As text")->type_name("FILE");
    command->add_option("--h5", arguments->h5, "As HDF5")->type_name("FILE");
    add_descriptor_option(*command, arguments->descriptors,
                          "Of which descriptors, several times if need be; default: the first");
  }
}

}  // namespace

void add_library(CLI::App& app, Settings& settings) {
  CLI::App* library = app.add_subcommand("library", "Keep a collection of meshes to be searched");
  library->require_subcommand(1);
  add_add(*library, settings);
  add_others(*library, settings);
  library->footer("'shape3d library COMMAND --help' explains a command.");
}

}  // namespace shape3d::apps
