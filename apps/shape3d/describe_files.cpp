#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>

#include <sys/stat.h>

#include <shape3d/descriptors/descriptor.hpp>

#include "common/byte_source.hpp"
#include "common/describe_mesh.hpp"
#include "common/error.hpp"
#include "common/feature_table.hpp"
#include "common/mesh_io.hpp"
#include "common/text.hpp"
#include "describe_arguments.hpp"
#include "describe_journal.hpp"
#include "descriptor_arguments.hpp"
#include "progress.hpp"
#include "report.hpp"

namespace shape3d::apps {
namespace {

using descriptors::Descriptor;

// One mesh on its way into the table.
struct Job {
  DescribedFile result;
  bool kept = false;   // from an earlier run
  std::string reason;  // why there are no vectors; empty: there are
};

// The meshes of the command line, then those of the list; each once.
std::vector<std::string> mesh_paths(const DescribeArguments& arguments, const Settings& settings) {
  std::vector<std::string> paths = arguments.meshes;
  if (!arguments.list.empty()) {
    const MappedFile list(arguments.list);
    std::string_view rest = list.bytes();
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      const std::string_view line = trim(rest.substr(0, end));
      if (!line.empty() && line.front() != '#') paths.emplace_back(line);
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (paths.empty()) throw FileError(arguments.list, "names no mesh");
  }
  if (paths.empty()) throw UsageError("no mesh is named, expected MESH or --list FILE");
  std::set<std::string> seen;
  const auto again = std::remove_if(paths.begin(), paths.end(), [&](const std::string& path) {
    return !seen.insert(path).second;
  });
  if (again != paths.end()) {
    warn(settings, std::to_string(paths.end() - again) + " meshes are named more than once");
    paths.erase(again, paths.end());
  }
  return paths;
}

FeatureFile file_state(const std::string& path) {
  struct stat state {};
  FeatureFile file{path, 0, 0};
  if (stat(path.c_str(), &state) == 0) {
    file.size = static_cast<std::uint64_t>(state.st_size);
    file.time = std::int64_t{state.st_mtim.tv_sec} * 1000000000 + state.st_mtim.tv_nsec;
  }
  return file;
}

// Vectors that the table of an earlier run holds.
std::map<std::string, DescribedFile> earlier_vectors(const std::string& path,
                                                     const std::vector<std::string>& specs) {
  std::map<std::string, DescribedFile> entries;
  if (!std::filesystem::exists(path)) return entries;
  FeatureTable table;
  try {
    table = read_features(path);
  } catch (const FileError& error) {
    throw std::runtime_error(std::string(error.what()) + "; --restart overwrites it");
  }
  std::vector<std::string> found;
  for (const FeatureSet& set : table.sets) found.push_back(set.spec);
  const std::string difference = descriptor_difference(found, specs);
  if (!difference.empty()) throw FileError(path, difference + "; --restart describes anew");
  for (std::size_t row = 0; row < table.files.size(); ++row) {
    DescribedFile entry{table.files[row], {}};
    for (const FeatureSet& set : table.sets) {
      entry.vectors.emplace_back(set.vectors.row(static_cast<Eigen::Index>(row)));
    }
    entries.insert_or_assign(entry.file.path, std::move(entry));
  }
  return entries;
}

// "a.off: sentence" → "sentence"
std::string without_path(const std::string& sentence, const std::string& path) {
  const std::string prefix = path + ": ";
  return sentence.rfind(prefix, 0) == 0 ? sentence.substr(prefix.size()) : sentence;
}

// Describes the jobs that are not done, several at a time.
class Runner {
 public:
  Runner(std::vector<Job>& jobs, const std::vector<Descriptor>& descriptors,
         DescribeJournal& journal, const Settings& settings)
      : jobs_(jobs),
        descriptors_(descriptors),
        journal_(journal),
        settings_(settings),
        progress_(settings) {
    for (Job& job : jobs) {
      if (!job.kept) open_.push_back(&job);
    }
  }

  void run() {
    progress_.stage("describing " + std::to_string(open_.size()) + " meshes");
    const auto processors = std::max(1u, std::thread::hardware_concurrency());
    const std::size_t threads =
        settings_.threads > 0 ? static_cast<std::size_t>(settings_.threads) : processors;
    // As many meshes at a time as there are threads; a single one has them all.
    const std::size_t workers = std::min(threads, open_.size());
    inner_threads_ =
        static_cast<int>(std::max<std::size_t>(1, workers == 0 ? 1 : threads / workers));
    std::vector<std::thread> pool;
    for (std::size_t i = 1; i < workers; ++i) pool.emplace_back([this] { work(); });
    if (workers > 0) work();
    for (std::thread& thread : pool) thread.join();
    progress_.clear();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void work() {
    for (;;) {
      const std::size_t i = next_.fetch_add(1);
      if (i >= open_.size() || stop_) return;
      Job& job = *open_[i];
      std::vector<std::string> warnings;
      try {
        const MeshFile file = read_mesh(job.result.file.path);
        warnings = file.warnings;
        job.result.vectors = describe_mesh(file.mesh, descriptors_, inner_threads_);
      } catch (const std::bad_alloc&) {
        job.reason = "not enough memory";
      } catch (const std::exception& error) {
        job.reason = without_path(error.what(), job.result.file.path);
      }
      finish(job, warnings);
    }
  }

  void finish(Job& job, const std::vector<std::string>& warnings) {
    const std::lock_guard<std::mutex> lock(mutex_);
    try {
      if (job.reason.empty()) journal_.append(job.result);
    } catch (...) {
      if (!failure_) failure_ = std::current_exception();
      stop_ = true;
    }
    if (!settings_.quiet && !warnings.empty()) progress_.clear();
    for (const std::string& sentence : warnings) {
      warn(settings_, job.result.file.path + ": " + sentence);
    }
    if (!job.reason.empty()) {
      progress_.clear();
      std::cerr << "shape3d: " << job.result.file.path << ": " << job.reason << '\n';
    }
    ++done_;
    progress_.update(static_cast<double>(done_) / static_cast<double>(open_.size()));
  }

  std::vector<Job>& jobs_;
  const std::vector<Descriptor>& descriptors_;
  DescribeJournal& journal_;
  const Settings& settings_;
  Progress progress_;
  std::vector<Job*> open_;
  int inner_threads_ = 1;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::exception_ptr failure_;
};

FeatureTable table_of(const std::vector<Job>& jobs, const std::vector<std::string>& specs,
                      const std::vector<Eigen::Index>& lengths) {
  FeatureTable table;
  for (const Job& job : jobs) {
    if (job.reason.empty()) {
      table.files.push_back(job.result.file);
    } else {
      table.failed.emplace_back(job.result.file.path, job.reason);
    }
  }
  for (std::size_t s = 0; s < specs.size(); ++s) {
    FeatureSet set{specs[s], {}};
    set.vectors.resize(static_cast<Eigen::Index>(table.files.size()), lengths[s]);
    Eigen::Index row = 0;
    for (const Job& job : jobs) {
      if (job.reason.empty()) set.vectors.row(row++) = job.result.vectors[s];
    }
    table.sets.push_back(std::move(set));
  }
  return table;
}

}  // namespace

DescribeOutcome describe_to_table(const DescribeArguments& arguments, const Settings& settings) {
  if (arguments.descriptors.empty()) throw UsageError("--descriptor is required");
  const std::vector<Descriptor> descriptors = parse_descriptors(arguments.descriptors);
  if (arguments.output.empty()) throw UsageError("--output is required");
  const std::optional<FeatureFormat> format = feature_format(arguments.output);
  if (!format) {
    throw UsageError("-o " + arguments.output + ": expected a name that ends in " +
                     std::string(kFeatureExtensions));
  }
  DescribeOutcome outcome;
  std::vector<std::string> specs;
  std::vector<Eigen::Index>& lengths = outcome.lengths;
  for (const Descriptor& descriptor : descriptors) {
    specs.push_back(descriptor.to_string());
    lengths.push_back(descriptor.length());
  }
  const std::vector<std::string> paths = mesh_paths(arguments, settings);
  outcome.meshes = paths.size();
  const std::string journal_path = arguments.output + ".part";
  if (arguments.restart) std::filesystem::remove(journal_path);
  std::map<std::string, DescribedFile> known;
  if (!arguments.restart) known = earlier_vectors(arguments.output, specs);
  outcome.file = std::make_unique<OutputFile>(arguments.output);
  outcome.journal = std::make_unique<DescribeJournal>(journal_path, specs, lengths);
  for (const auto& [path, entry] : outcome.journal->entries()) known.insert_or_assign(path, entry);

  Stopwatch watch;
  std::vector<Job> jobs(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    jobs[i].result.file = file_state(paths[i]);
    const auto place = known.find(paths[i]);
    if (place != known.end() && place->second.file == jobs[i].result.file) {
      jobs[i].result = std::move(place->second);
      jobs[i].kept = true;
      ++outcome.kept;
    }
  }
  Runner(jobs, descriptors, *outcome.journal, settings).run();
  outcome.seconds = watch.lap();
  outcome.table = table_of(jobs, specs, lengths);
  write_features(*outcome.file, *format, outcome.table);
  outcome.file->finish();
  return outcome;
}

void DescribeOutcome::commit() {
  file->commit();
  journal->remove();
}

void describe_files(const DescribeArguments& arguments, const Settings& settings) {
  DescribeOutcome outcome = describe_to_table(arguments, settings);
  const FeatureTable& table = outcome.table;
  const std::size_t described = table.files.size() - outcome.kept;
  Json report = report_head("describe");
  report["output"] = arguments.output;
  report["descriptors"] = Json::array();
  for (std::size_t s = 0; s < table.sets.size(); ++s) {
    report["descriptors"].push_back({{"spec", table.sets[s].spec}, {"length", outcome.lengths[s]}});
  }
  report["meshes"] = outcome.meshes;
  report["described"] = described;
  report["kept"] = outcome.kept;
  report["failed"] = Json::array();
  for (const auto& [path, reason] : table.failed) {
    report["failed"].push_back({{"file", path}, {"reason", reason}});
  }
  report["seconds"] = outcome.seconds;
  write_json(settings, report);
  outcome.commit();
  if (!settings.quiet) {
    for (const FeatureSet& set : table.sets) std::cout << line("descriptor", set.spec);
    std::cout << line("described", std::to_string(described));
    if (outcome.kept > 0) std::cout << line("kept", std::to_string(outcome.kept));
    if (!table.failed.empty()) std::cout << line("failed", std::to_string(table.failed.size()));
    std::cout << line("seconds", rounded(outcome.seconds)) << line("output", arguments.output);
  }
  if (!table.failed.empty() && !arguments.keep_going) {
    std::cout.flush();
    throw std::runtime_error(std::to_string(table.failed.size()) + " of " +
                             std::to_string(outcome.meshes) +
                             " meshes could not be described; --keep-going makes that no failure");
  }
}

}  // namespace shape3d::apps
