#include <map>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/output_file.hpp"
#include "learning_commands.hpp"
#include "train_arguments.hpp"

namespace shape3d::apps {
namespace {

const std::map<std::string, learning::ScalingKind> kScalings{
    {"none", learning::ScalingKind::none},
    {"range", learning::ScalingKind::range},
    {"standard", learning::ScalingKind::standard}};

// A kind of `train` with its arguments, which outlive the parser.
template <class Arguments>
std::pair<CLI::App*, std::shared_ptr<Arguments>> add_kind(
    CLI::App& train, Settings& settings, const std::string& name, const std::string& text,
    void (*run)(const Arguments&, const Settings&)) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = train.add_subcommand(name, text);
  command
      ->add_option("SOURCE", arguments->source.path,
                   "A library (.db), or a table of vectors (.csv, .npy, .h5)")
      ->required();
  command->add_option("-o,--output", arguments->output, "The model")->required()->type_name("FILE");
  command
      ->add_option("--descriptor", arguments->source.descriptor,
                   "Of which vectors; default: the first descriptor there is")
      ->type_name("SPEC");
  command->add_flag("--class-from-folder", arguments->source.class_from_folder,
                    "Of a table: the class is the folder of the mesh, or what holds its folder "
                    "train or test");
  command->callback([arguments, run, &settings] {
    settings.run = [arguments, run, &settings] { run(*arguments, settings); };
  });
  return {command, arguments};
}

void add_seed(CLI::App& command, TrainArguments& arguments) {
  command.add_option("--seed", arguments.seed, "Of all that is random (default 1)")->type_name("N");
}

void add_scaling(CLI::App& command, learning::ScalingKind& scaling, const std::string& preset) {
  command
      .add_option("--scaling", scaling,
                  "Of each component: none, range (to -1 … 1), standard (mean 0, deviation 1); "
                  "default " +
                      preset)
      ->transform(CLI::CheckedTransformer(kScalings))
      ->type_name("NAME");
}

void add_svm(CLI::App& train, Settings& settings) {
  const auto [command, arguments] = add_kind<TrainSvmArguments>(
      train, settings, "svm", "Train a support vector machine", &train_svm);
  const std::map<std::string, learning::SvmKernel> kernels{{"rbf", learning::SvmKernel::rbf},
                                                           {"linear", learning::SvmKernel::linear}};
  command->add_option("--kernel", arguments->options.kernel, "rbf (default) or linear")
      ->transform(CLI::CheckedTransformer(kernels))
      ->type_name("NAME");
  command
      ->add_option("--C", arguments->C,
                   "Price of a slack. C or gamma not given: 2^-5 … 2^15 and 2^-15 … 2^3 are tried "
                   "by cross-validation")
      ->check(CLI::PositiveNumber)
      ->type_name("X");
  command->add_option("--gamma", arguments->gamma, "Of the kernel exp(-gamma |x - y|^2)")
      ->check(CLI::PositiveNumber)
      ->type_name("X");
  command->add_option("--folds", arguments->folds, "Of cross-validation (default 5)")
      ->check(CLI::Range(2, 1000000))
      ->type_name("K");
  command->add_flag("--balanced", arguments->options.balanced,
                    "Errors in rare classes cost more, so that all classes count the same");
  command->add_flag("--probabilities", arguments->options.probabilities,
                    "'classify' then says how probable each class is");
  add_scaling(*command, arguments->options.scaling, "standard");
  add_seed(*command, *arguments);
  command->footer(
      "Example: shape3d train svm vectors.h5 --class-from-folder --probabilities -o svm.model");
}

// "12x6"
std::string parse_grid(const std::string& text, learning::SomGrid& grid) {
  const std::size_t cross = text.find('x');
  int rows = 0;
  int columns = 0;
  if (cross == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, cross), rows) ||
      !CLI::detail::lexical_cast(text.substr(cross + 1), columns)) {
    return "expected ROWSxCOLUMNS such as 12x6";
  }
  grid.rows = rows;
  grid.columns = columns;
  return "";
}

void add_som(CLI::App& train, Settings& settings) {
  const auto [command, shared] = add_kind<TrainSomArguments>(
      train, settings, "som", "Train a self-organizing map", &train_som);
  TrainSomArguments* arguments = shared.get();
  learning::SomOptions& options = arguments->options;
  command
      ->add_option_function<std::string>(
          "--grid",
          [&options](const std::string& text) {
            const std::string wrong = parse_grid(text, options.grid);
            if (!wrong.empty()) throw CLI::ValidationError("--grid " + text, wrong);
          },
          "Rows and columns of units (default 12x6)")
      ->type_name("RxC");
  const std::map<std::string, learning::SomLattice> lattices{
      {"hexagonal", learning::SomLattice::hexagonal},
      {"rectangular", learning::SomLattice::rectangular}};
  command->add_option("--lattice", options.grid.lattice, "hexagonal (default) or rectangular")
      ->transform(CLI::CheckedTransformer(lattices))
      ->type_name("NAME");
  command->add_flag_callback(
      "--toroid", [&options] { options.grid.shape = learning::SomShape::toroid; },
      "The first and last row, and column, are neighbours");
  command->add_flag_callback(
      "--sequential", [&options] { options.training = learning::SomTraining::sequential; },
      "Models are shown one by one, not all at once");
  command->add_flag_callback(
      "--random-start", [&options] { options.start = learning::SomStart::random; },
      "Prototypes begin at random places, not on the plane of the principal axes");
  command->add_option("--epochs", options.epochs, "Times that all models are shown (default 50)")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  command
      ->add_option("--sigma-first", options.sigma_first,
                   "Radius of the neighbourhood at first (default: half the longer side)")
      ->check(CLI::PositiveNumber)
      ->type_name("X");
  command->add_option("--sigma-last", options.sigma_last, "And at last (default 0.5)")
      ->check(CLI::PositiveNumber)
      ->type_name("X");
  add_scaling(*command, options.scaling, "none");
  const std::map<std::string, SecondLevel> levels{{"kmeans", SecondLevel::kmeans},
                                                  {"single", SecondLevel::single},
                                                  {"complete", SecondLevel::complete},
                                                  {"average", SecondLevel::average},
                                                  {"ward", SecondLevel::ward}};
  command
      ->add_option(
          "--second-level", arguments->second_level,
          "How units are clustered: kmeans (default), or agglomerated by single, complete, "
          "average or ward linkage")
      ->transform(CLI::CheckedTransformer(levels))
      ->type_name("NAME");
  command
      ->add_option("--clusters", arguments->clusters,
                   "Number of clusters of units (default: by the Davies-Bouldin index)")
      ->check(CLI::Range(1, 10000))
      ->type_name("K");
  add_seed(*command, *arguments);
  command->footer(
      "Example: shape3d train som vectors.h5 --class-from-folder --grid 12x6 -o map.model");
}

void add_metric(CLI::App& train, Settings& settings) {
  const auto [command, arguments] = add_kind<TrainMetricArguments>(
      train, settings, "metric", "Learn a linear metric that tells classes apart", &train_metric);
  command
      ->add_option("--components", arguments->components,
                   "Principal components that are looked at (default 100); 0: all")
      ->check(CLI::Range(0, 1000000))
      ->type_name("N");
  command
      ->add_option("--shrinkage", arguments->shrinkage,
                   "How near the metric stays to that of the components (default 1)")
      ->check(CLI::PositiveNumber)
      ->type_name("X");
  command->footer("Example: shape3d train metric vectors.h5 --class-from-folder -o metric.model");
}

}  // namespace

void add_train(CLI::App& app, Settings& settings) {
  CLI::App* train = app.add_subcommand("train", "Train classifiers, maps and metrics on vectors");
  train->require_subcommand(1);
  add_svm(*train, settings);
  add_som(*train, settings);
  add_metric(*train, settings);
  train->footer(
      "Examples:\n"
      "  shape3d train svm shapes.db --probabilities -o shapes.model\n"
      "  shape3d train som shapes.db --descriptor sni:K=16 --grid 12x6 -o map.model\n"
      "  shape3d train som vectors.h5 --class-from-folder -o map.model\n"
      "'shape3d train KIND --help' explains a kind.");
}

Json training_report(const std::string& kind, const TrainingSet& set) {
  Json report = report_head("train " + kind);
  report["source"] = set.source;
  report["descriptor"] = set.spec;
  report["length"] = set.vectors.cols();
  report["models"] = set.files.size();
  report["classes"] = Json::array();
  const std::vector<int> sizes = class_sizes(set);
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    report["classes"].push_back({{"name", set.class_names[c]}, {"models", sizes[c]}});
  }
  return report;
}

std::string training_lines(const TrainingSet& set) {
  return line("descriptor", set.spec) + line("models", std::to_string(set.files.size())) +
         line("classes", std::to_string(set.class_names.size()));
}

void write_training(const TrainArguments& arguments, const learning::ModelFile& model,
                    const Json& report, const Settings& settings) {
  OutputFile file(arguments.output);
  file.write(learning::write_model_file(model));
  file.finish();
  write_json(settings, report);
  file.commit();
}

std::string scaling_name(learning::ScalingKind kind) {
  for (const auto& [name, value] : kScalings) {
    if (value == kind) return name;
  }
  return "";
}

}  // namespace shape3d::apps
