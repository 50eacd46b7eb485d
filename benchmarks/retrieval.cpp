// Retrieval on a classified collection, each model searching for its class among the others:
// shape3d_retrieval --help.
#include <chrono>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <CLI/CLI.hpp>

#include "common/error.hpp"
#include "common/mesh_io.hpp"
#include "common/output_file.hpp"
#include "markdown_table.hpp"
#include "shape3d/collection.hpp"
#include "shape3d/descriptors/descriptor.hpp"
#include "shape3d/learning/distance.hpp"
#include "shape3d/learning/retrieval.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::bench;
using learning::Distance;
using Clock = std::chrono::steady_clock;

/// A row of the table: "name | SPEC | distance".
struct Entry {
  std::string name, spec;
  Distance distance = Distance::L2;
};

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

std::vector<Entry> read_entries(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw apps::FileError(path, "cannot be opened for reading");
  std::vector<Entry> entries;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    const auto first = line.find('|'), second = line.find('|', first + 1);
    const std::string distance =
        second == std::string::npos ? "" : trimmed(line.substr(second + 1));
    const auto kind = learning::distance_named(distance);
    if (!kind) {
      throw apps::FileError(path, "line " + std::to_string(number) + " is '" + line +
                                      "', expected: name | descriptor | distance");
    }
    entries.push_back({trimmed(line.substr(0, first)),
                       trimmed(line.substr(first + 1, second - first - 1)), *kind});
  }
  return entries;
}

struct Library {
  std::vector<apps::Mesh> meshes;
  learning::Labels labels;
  std::vector<std::string> left_out;  ///< Sentences.
  double reading = 0.0;               ///< Seconds.
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Library read_library(const apps::Collection& collection) {
  const auto start = Clock::now();
  const std::size_t count = collection.models.size();
  std::vector<apps::Mesh> meshes(count);
  std::vector<std::string> failures(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    try {
      meshes[i] = apps::read_mesh(collection.models[i].path).mesh;
    } catch (const apps::FileError& error) {
      failures[i] = error.what();
    }
  });
  Library library;
  library.left_out = collection.missing;
  for (std::size_t i = 0; i < count; ++i) {
    if (!failures[i].empty()) {
      library.left_out.push_back(failures[i]);
      continue;
    }
    library.meshes.push_back(std::move(meshes[i]));
    library.labels.push_back(collection.models[i].of_class);
  }
  library.reading = seconds_since(start);
  return library;
}

/// The part of a descriptor's text that says how voxels are made; all of it when there are none.
std::string voxels_of(const descriptors::Descriptor& descriptor) {
  const descriptors::VoxelizeOptions* const options = descriptor.voxels();
  if (options == nullptr) return descriptor.to_string();
  const std::string text = descriptor.to_string();
  return text.substr(text.find(",voxels=" + std::to_string(options->side)));
}

/// Vectors by each descriptor, one row a mesh. Descriptors of equal voxels share them.
std::vector<Eigen::MatrixXd> describe(const Library& library,
                                      const std::vector<descriptors::Descriptor>& wanted) {
  std::map<std::string, std::vector<std::size_t>> groups;
  std::vector<Eigen::MatrixXd> vectors;
  for (std::size_t d = 0; d < wanted.size(); ++d) {
    groups[voxels_of(wanted[d])].push_back(d);
    vectors.emplace_back(static_cast<Eigen::Index>(library.meshes.size()), wanted[d].length());
  }
  for (const auto& group : groups) {
    const std::vector<std::size_t>& members = group.second;
    tbb::parallel_for(std::size_t{0}, library.meshes.size(), [&](std::size_t i) {
      const apps::Mesh& mesh = library.meshes[i];
      const auto row = static_cast<Eigen::Index>(i);
      const descriptors::Descriptor& first = wanted[members.front()];
      if (first.voxels() == nullptr) {
        vectors[members.front()].row(row) = first.compute(mesh.V, mesh.F, 1).transpose();
        return;
      }
      descriptors::VoxelizeOptions options = *first.voxels();
      options.threads = 1;
      const descriptors::Voxels voxels = descriptors::voxelize(mesh.V, mesh.F, options);
      for (const std::size_t d : members) {
        vectors[d].row(row) = wanted[d].compute(voxels, 1).transpose();
      }
    });
    if (wanted[members.front()].voxels() == nullptr) {
      for (const std::size_t d : members) vectors[d] = vectors[members.front()];
    }
  }
  return vectors;
}

int run(int argc, char** argv) {
  CLI::App program("Measures retrieval by descriptors as the Princeton Shape Benchmark does.");
  std::string classes, models, list, output;
  int threads = 0;
  program.add_option("--classes", classes, "Classification, a .cla file")->required();
  program.add_option("--models", models, "Folder of the models: <id/100>/m<id>/m<id>.off")
      ->required();
  program.add_option("--list", list, "Rows: name | descriptor | distance")->required();
  program.add_option("-o,--output", output, "Markdown table; standard output without it");
  program.add_option("--threads", threads, "Threads; 0 is all processors")
      ->check(CLI::NonNegativeNumber);
  CLI11_PARSE(program, argc, argv);
  std::unique_ptr<tbb::global_control> limit;
  if (threads > 0) {
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(threads));
  }

  const std::vector<Entry> entries = read_entries(list);
  std::vector<descriptors::Descriptor> parsed;  // all of them before the long work
  for (const Entry& entry : entries) parsed.push_back(descriptors::Descriptor::parse(entry.spec));
  const Library library =
      read_library(apps::princeton_collection(classes, models, apps::kPrincetonPattern));
  if (library.meshes.size() < 2) throw apps::FileError(models, "has fewer than two of the models");

  const auto start = Clock::now();
  const std::vector<Eigen::MatrixXd> vectors = describe(library, parsed);
  const double describing = seconds_since(start);
  MarkdownTable table(
      {"descriptor", "numbers", "distance", "NN", "1st tier", "2nd tier", "E", "DCG"});
  int queries = 0;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const learning::Features X = vectors[e];
    const learning::RetrievalMeans means =
        learning::evaluate_retrieval(learning::distances(X, X, entries[e].distance, threads),
                                     library.labels, {{}, threads})
            .micro;
    const learning::RetrievalMeasures& measures = means.measures;
    queries = means.queries;
    const auto percent = [](double share) { return fixed(100.0 * share, 1); };
    table.add({entries[e].name, std::to_string(parsed[e].length()),
               std::string(learning::to_string(entries[e].distance)),
               percent(measures.nearest_neighbour), percent(measures.first_tier),
               percent(measures.second_tier), percent(measures.e_measure), percent(measures.dcg)});
    std::cerr << entries[e].name << ": NN " << percent(measures.nearest_neighbour) << ", DCG "
              << percent(measures.dcg) << '\n';
  }

  std::string text = table.text();
  text += "\n" + std::to_string(library.meshes.size()) + " models, " + std::to_string(queries) +
          " queries; read in " + fixed(library.reading, 1) + " s, described by all of these in " +
          fixed(describing, 1) + " s.";
  if (!library.left_out.empty()) {
    text += " Left out: " + std::to_string(library.left_out.size()) + ".\n";
    for (const std::string& sentence : library.left_out)
      std::cerr << "left out: " << sentence << '\n';
  }
  text += "\n\nDescriptors in full:\n\n";
  for (std::size_t e = 0; e < entries.size(); ++e) {
    text += "- " + entries[e].name + ": `" + parsed[e].to_string() + "`\n";
  }
  if (output.empty()) {
    std::cout << text;
  } else {
    apps::OutputFile file(output);
    file.write(text);
    file.commit();
  }
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "shape3d_retrieval: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
