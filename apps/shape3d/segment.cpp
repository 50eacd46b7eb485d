#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/mesh_io.hpp"
#include "common/text.hpp"
#include "common/volume_write.hpp"
#include "segment_arguments.hpp"

namespace shape3d::apps {
namespace {

constexpr int kMostClasses = 8;
// The half way between what is at the seed and what is round it is known better than a mixture of a
// region: the search stays near it, away from stronger edges of what else is in the box.
constexpr double kLocalScope = 0.1;

int class_count(const std::string& word) {
  if (word.empty()) return levelset::MixtureOptions{}.classes;
  if (word == "auto") return 0;
  const auto count = parse_integer(word);
  if (!count || *count < 1 || *count > kMostClasses)
    throw UsageError("--classes " + word + ": expected auto or a number from 1 to 8");
  return static_cast<int>(*count);
}

levelset::InsideOptions inside_options(const std::string& word) {
  levelset::InsideOptions options;
  if (word == "bright") return options;
  if (word == "dark") {
    options.inside = levelset::Inside::dark;
    return options;
  }
  options.inside = levelset::Inside::classes;
  std::size_t begin = 0;
  while (begin <= word.size()) {
    const std::size_t end = std::min(word.find(',', begin), word.size());
    const auto number = parse_integer(std::string_view(word).substr(begin, end - begin));
    if (!number || *number < 0 || *number >= kMostClasses) {
      throw UsageError("--inside " + word +
                       ": expected bright, dark or numbers of classes from 0 (the darkest), such "
                       "as 1,2");
    }
    options.classes.push_back(static_cast<int>(*number));
    begin = end + 1;
  }
  return options;
}

void check_names(const SegmentArguments& arguments) {
  if (!written_volume_format(arguments.output)) {
    throw UsageError("-o " + arguments.output + ": " + unknown_volume_extension(arguments.output));
  }
  if (!arguments.psi.empty() &&
      lower_case(std::filesystem::path(arguments.psi).extension().string()) != ".nrrd") {
    throw UsageError("--psi " + arguments.psi + ": expected a name that ends in .nrrd");
  }
  if (!arguments.mesh.empty() && !mesh_format(arguments.mesh)) {
    throw UsageError("--mesh " + arguments.mesh + ": " + unknown_mesh_extension(arguments.mesh));
  }
}

void check_numbers(const SegmentArguments& arguments) {
  if (!arguments.roi.empty() && !arguments.roi_mm.empty())
    throw UsageError("--roi and --roi-mm are both given, expected one of them");
  for (const double number : arguments.seed) {
    if (!std::isfinite(number)) throw UsageError("--seed-point: expected three finite numbers");
  }
  if (!std::isfinite(arguments.radius) || arguments.radius < 0.0)
    throw UsageError("--radius " + to_text(arguments.radius) +
                     ": expected a finite positive number of millimetres");
  if (arguments.radius > 0.0 && arguments.seed.empty())
    throw UsageError("--radius needs --seed-point, the centre of the sphere");
  if (arguments.keep_connected && arguments.seed.empty())
    throw UsageError("--keep-connected needs --seed-point, a sample of the component to keep");
  if (arguments.nodule && arguments.seed.empty())
    throw UsageError("--nodule needs --seed-point, a sample near the middle of the nodule");
  const levelset::CalibrationOptions& calibration = arguments.options.calibration;
  if (!std::isfinite(calibration.scope_constant) || calibration.scope_constant <= 0.0)
    throw UsageError("--scope-constant " + to_text(calibration.scope_constant) +
                     ": expected a finite positive number");
  if (!(calibration.max_scope > 0.0 && calibration.max_scope <= 1.0))
    throw UsageError("--max-scope " + to_text(calibration.max_scope) +
                     ": expected a share above 0 and up to 1");
  for (const double label : arguments.truth_labels) {
    if (!std::isfinite(label)) throw UsageError("--truth-label: expected finite numbers");
  }
  const double curvature = arguments.options.evolution.curvature;
  if (!std::isfinite(curvature) || curvature < 0.0)
    throw UsageError("--curvature " + to_text(curvature) +
                     ": expected a finite number of millimetres, 0 or more");
}

void add_model_options(CLI::App& command, SegmentArguments& arguments) {
  levelset::SegmentOptions& options = arguments.options;
  command
      .add_option(
          "--classes", arguments.classes,
          "Gaussians of the intensity model, 1 to 8, or auto: by BIC (default 3; with --nodule "
          "two: what is at the seed point and what is round it)")
      ->type_name("N|auto");
  command
      .add_option("--inside", arguments.inside,
                  "Classes of the object: bright (default), dark, or numbers from 0, the darkest")
      ->type_name("bright|dark|i,j");
  static const std::map<std::string, levelset::MixtureMethod> kEstimators{
      {"em", levelset::MixtureMethod::em}, {"sem", levelset::MixtureMethod::stochastic_em}};
  command
      .add_option("--estimator", options.mixture.method,
                  "Expectation-maximisation, or its stochastic form (default sem)")
      ->transform(CLI::CheckedTransformer(kEstimators))
      ->type_name("em|sem");
  command.add_option("--seed", options.mixture.seed, "Of the random numbers of sem (default 1)")
      ->type_name("S");
  command.add_option("--chain", options.mixture.chain, "Iterations of a run of sem (default 60)")
      ->check(CLI::Range(2, 100000))
      ->type_name("N");
  command
      .add_option("--runs", options.mixture.runs,
                  "Runs of sem, of which the one that fits best is taken (default 5)")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  command
      .add_option("--padding", options.histogram.padding,
                  "Intensity of samples outside the scan, left out of the model (default: found)")
      ->type_name("V");
  command
      .add_option("--smoothing", options.smoothing,
                  "Gaussian that the intensities are smoothed with, in samples (default: by noise)")
      ->check(CLI::Range(0.0, 10.0))
      ->type_name("SIGMA");
}

void add_evolution_options(CLI::App& command, SegmentArguments& arguments) {
  levelset::SegmentOptions& options = arguments.options;
  static const std::map<std::string, levelset::Method> kMethods{
      {"combined", levelset::Method::combined},
      {"intensity", levelset::Method::intensity},
      {"gradient", levelset::Method::gradient}};
  command
      .add_option("--method", options.speed.method,
                  "What moves the front: intensity calibrated by gradients (combined, default), "
                  "intensity alone, or gradient alone")
      ->transform(CLI::CheckedTransformer(kMethods))
      ->type_name("combined|intensity|gradient");
  command.add_flag_callback(
      "--no-calibration", [&options] { options.calibrated = false; },
      "Leave the intensity model as it was estimated");
  command
      .add_option("--scope-constant", options.calibration.scope_constant,
                  "Scope of the calibration per misfit of the model, a share of the log-odds "
                  "(default 100)")
      ->type_name("C");
  command
      .add_option(
          "--max-scope", options.calibration.max_scope,
          "The scope is at most this share: less keeps to boundaries near the one estimated "
          "(default 0.9; with --nodule 0.1)")
      ->type_name("X");
  command
      .add_option("--curvature", options.evolution.curvature, "Weight of curvature, mm (default 0)")
      ->type_name("E");
  static const std::map<std::string, levelset::Curvature> kKinds{
      {"mean", levelset::Curvature::mean}, {"minimal", levelset::Curvature::minimal}};
  command
      .add_option("--curvature-kind", options.evolution.curvature_kind,
                  "Mean curvature shortens vessels; the minimal one (default) keeps tubes")
      ->transform(CLI::CheckedTransformer(kKinds))
      ->type_name("mean|minimal");
  command
      .add_option("--max-iterations", options.evolution.max_iterations,
                  "Stop there when the front still moves (default 1000)")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  command
      .add_option("--coarse-levels", options.evolution.coarse_levels,
                  "Grids of half, a quarter … of the resolution that the front moves on first; 0: "
                  "none (default 2)")
      ->check(CLI::Range(0, 8))
      ->type_name("N");
  command
      .add_option("--tolerance", options.evolution.tolerance,
                  "Stop when the front moves less than this share of its full speed (default 0.01)")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("X");
}

void add_region_options(CLI::App& command, SegmentArguments& arguments) {
  command
      .add_option("--roi", arguments.roi,
                  "Only samples x0 ≤ x < x1, y0 ≤ y < y1, z0 ≤ z < z1, by index: the start front")
      ->delimiter(',')
      ->expected(6)
      ->type_name("x0,x1,y0,y1,z0,z1");
  command
      .add_option("--roi-mm", arguments.roi_mm,
                  "The same by LPS millimetres: the samples in the box, and between them")
      ->delimiter(',')
      ->expected(6)
      ->type_name("x0,x1,y0,y1,z0,z1");
  command.add_option("--seed-point", arguments.seed, "A place in the object, by index, from 0")
      ->delimiter(',')
      ->expected(3)
      ->type_name("x,y,z");
  command
      .add_option("--radius", arguments.radius,
                  "Start from a sphere round the seed point instead of the box, mm; with --nodule: "
                  "the radius of the nodule, about")
      ->type_name("R");
  command.add_flag("--keep-connected", arguments.keep_connected,
                   "Keep only the component at the seed point");
  command.add_flag("--nodule", arguments.nodule,
                   "Cut vessels and wall from the nodule at the seed point");
}

void add_output_options(CLI::App& command, SegmentArguments& arguments) {
  command
      .add_option("-o,--output", arguments.output,
                  "The label map, 1 inside, of the size and place of the volume (.nrrd, .nii.gz, "
                  ".nii, .mha)")
      ->required()
      ->type_name("FILE");
  command.add_option("--psi", arguments.psi, "The level set function of the region, mm")
      ->type_name("FILE.nrrd");
  command
      .add_option("--mesh", arguments.mesh,
                  "The surface ψ = 0 in LPS (.ply, .obj, .off, .stl, .vtp)")
      ->type_name("FILE");
  command
      .add_option("--contours", arguments.contours,
                  "The contour in a plane as a picture; may be given several times")
      ->expected(2)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("z=K FILE.svg");
  command.add_option("--truth", arguments.truth, "A label map to compare with, of the same size")
      ->type_name("MASK");
  command
      .add_option("--truth-label", arguments.truth_labels,
                  "The labels that count in it, such as 1,2 (default: all but 0)")
      ->delimiter(',')
      ->type_name("L,…");
  command
      .add_option("--plot", arguments.plot,
                  "Draw histogram.png, overlap.png and slices.png into this folder")
      ->type_name("DIR");
}

}  // namespace

std::vector<ContourWish> contour_wishes(const std::vector<std::string>& words) {
  std::vector<ContourWish> wishes;
  for (std::size_t n = 0; n + 1 < words.size(); n += 2) {
    const std::string& plane = words[n];
    ContourWish wish;
    const std::size_t axis = plane.empty() ? std::string::npos : std::string("xyz").find(plane[0]);
    const auto slice = plane.size() > 2 && plane[1] == '='
                           ? parse_integer(std::string_view(plane).substr(2))
                           : std::nullopt;
    if (axis == std::string::npos || !slice)
      throw UsageError("--contours " + plane +
                       ": expected x=, y= or z= and an index, such as z=26");
    wish.axis = static_cast<int>(axis);
    wish.slice = *slice;
    wish.path = words[n + 1];
    if (std::filesystem::path(wish.path).extension() != ".svg")
      throw UsageError("--contours " + plane + " " + wish.path +
                       ": expected a name that ends in .svg");
    wishes.push_back(std::move(wish));
  }
  return wishes;
}

void add_segment(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<SegmentArguments>();
  CLI::App* command = app.add_subcommand(
      "segment", "Find an object by its intensities and gradients, as a label map and a surface");
  command
      ->add_option("VOLUME", arguments->volume,
                   "A folder of DICOM slices, .nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd or .vti")
      ->required();
  command
      ->add_option("--series", arguments->series,
                   "The DICOM series: its UID, or its number in the list")
      ->type_name("UID|N");
  add_output_options(*command, *arguments);
  add_region_options(*command, *arguments);
  add_model_options(*command, *arguments);
  add_evolution_options(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  shape3d segment chest/ --roi 110,400,120,500,0,62 -o lungs.nii.gz --inside dark\n"
      "  shape3d segment chest.nrrd --seed-point 220,200,32 --radius 6 --nodule -o nodule.nrrd\n"
      "      --mesh nodule.ply --truth drawn.nrrd --plot plots\n"
      "The front starts as the box of the region (or a sphere) and moves until it stands still "
      "where the classes of intensity,\n"
      "calibrated by the gradients of the volume, part. A front that vanishes or fills the region "
      "is a warning; the files are\n"
      "written all the same.");
  command->callback([arguments, command, &settings] {
    settings.run = [arguments, command, &settings] {
      if (arguments->local_classes() && command->count("--max-scope") == 0)
        arguments->options.calibration.max_scope = kLocalScope;
      check_names(*arguments);
      check_numbers(*arguments);
      arguments->options.mixture.classes = class_count(arguments->classes);
      arguments->options.inside = inside_options(arguments->inside);
      arguments->options.threads = settings.threads;
      segment_volume(*arguments, settings);
    };
  });
}

}  // namespace shape3d::apps
