// Table 3.1 of the dissertation, run again beside other extractors: shape3d_table_3_1 --help.
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <malloc.h>
#include <CLI/CLI.hpp>

#include "common/output_file.hpp"
#include "common/private_display.hpp"
#include "comparison.hpp"
#include "growth_plot.hpp"
#include "statistics.hpp"
#include "subjects.hpp"
#include "table_report.hpp"
#include "volume_list.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::bench;

void write_file(const std::filesystem::path& path, const std::string& bytes) {
  apps::OutputFile file(path.string());
  file.write(bytes);
  file.commit();
}

/// The plot beside the page; its file name, or empty when it cannot be drawn.
std::string write_plot(const std::filesystem::path& page,
                       const std::vector<VolumeResult>& results) {
  std::filesystem::path path = page;
  path.replace_extension(".png");
  try {
    write_file(path, growth_plot(results));
    return path.filename().string();
  } catch (const apps::PictureError& error) {
    std::cerr << "warning: no plot: " << error.what() << '\n';
    return {};
  }
}

void print_summary(const VolumeResult& result) {
  std::cerr << "  " << result.counts.zero_vertices << " zero vertices\n";
  for (const SubjectResult& subject : result.subjects) {
    std::cerr << "  " << to_string(subject.name.method) << ", " << subject.name.threads << ": ";
    if (!subject.missing.empty()) {
      std::cerr << subject.missing << '\n';
      continue;
    }
    std::cerr << subject.last.triangles << " triangles, wall " << spread(subject.wall).median
              << " s, processor " << spread(subject.cpu).median << " s, " << subject.wall.size()
              << " runs\n";
  }
}

int run(int argc, char** argv) {
  CLI::App program("Compares extractors at the sizes of Table 3.1, and on volumes of your own.");
  std::vector<std::string> paths;
  std::string output;
  ComparisonOptions options;
  bool no_generated = false, no_lewiner = false;
  program.add_option("volumes", paths,
                     "PATH or PATH@ISOVALUE: a volume, or a folder of MetaImages and DICOM series; "
                     "those of the environment variable SHAPE3D_DATA are added");
  program.add_option("-o,--output", output, "Page to write, in Markdown; a plot goes beside it");
  program.add_option("--rounds", options.least_rounds, "Least number of rounds")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  program
      .add_option("--slow-rounds", options.slow_rounds,
                  "Least number for vtkMarchingCubes and scikit-image")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  program.add_option("--seconds", options.seconds, "Time for each volume, once rounds are enough")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  program.add_flag("--no-generated", no_generated, "Leave the generated volumes out");
  program.add_flag("--no-scikit-image", no_lewiner, "Leave scikit-image out");
  CLI11_PARSE(program, argc, argv);
  options.lewiner = !no_lewiner;
  options.most_rounds = std::max(options.most_rounds, options.least_rounds);

  std::vector<ListedVolume> volumes;
  if (!no_generated) volumes = generated_volumes();
  if (const char* data = std::getenv("SHAPE3D_DATA"); data != nullptr && *data != '\0') {
    paths.emplace_back(data);
  }
  for (const std::string& path : paths) {
    for (ListedVolume& volume : volumes_at(path)) volumes.push_back(std::move(volume));
  }
  const Environment machine = environment();
  std::vector<VolumeResult> results;
  for (const ListedVolume& listed : volumes) {
    const LoadedVolume volume = listed.load();
    std::cerr << volume.name << " at " << volume.isovalue << '\n';
    results.push_back(compare(volume, options));
    results.back().published = listed.generated;
    print_summary(results.back());
  }
  if (output.empty()) {
    std::cout << table_report(machine, results, {});
  } else {
    const std::string page = table_report(machine, results, write_plot(output, results));
    write_file(output, page);
    std::cout << page;
  }
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  // Large blocks come fresh from the system every time. By default glibc's malloc changes its mind
  // after the first one is freed, and extractors would find the pages of those that ran before.
  mallopt(M_MMAP_THRESHOLD, 1 << 17);
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (!arguments.empty() && arguments[0] == "own-process") {
      return run_as_own_process({arguments.begin() + 1, arguments.end()});
    }
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
