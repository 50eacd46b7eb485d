#include <algorithm>
#include <condition_variable>
#include <exception>
#include <iostream>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <unordered_map>
#include <unordered_set>

#include <sys/stat.h>

#include <shape3d/descriptors/descriptor.hpp>

#include "common/byte_source.hpp"
#include "common/describe_mesh.hpp"
#include "common/error.hpp"
#include "common/mesh_io.hpp"
#include "common/shape_library.hpp"
#include "common/thumbnail.hpp"
#include "descriptor_arguments.hpp"
#include "library_arguments.hpp"
#include "progress.hpp"
#include "report.hpp"

namespace shape3d::apps {
namespace {

using descriptors::Descriptor;

// "a.off: sentence" → "sentence"
std::string without_path(const std::string& sentence, const std::string& path) {
  const std::string prefix = path + ": ";
  return sentence.rfind(prefix, 0) == 0 ? sentence.substr(prefix.size()) : sentence;
}

// What the library knows of a file before the run.
struct Known {
  LibraryModel model;
  std::vector<bool> described;  // by each descriptor of the run
};

// Describes meshes, several at a time, and puts them into the library in the order they are named,
// so that ids do not depend on the number of threads. Each is stored as soon as it and those before
// it are described; how far ahead of the first that is not, meshes are described, is limited. So
// what is in memory, and what a run that is killed loses, does not grow with their number.
class Adder {
 public:
  Adder(ShapeLibrary& library, const std::vector<NamedMesh>& meshes,
        std::vector<Descriptor> descriptors, const Settings& settings)
      : library_(library),
        meshes_(meshes),
        descriptors_(std::move(descriptors)),
        settings_(settings),
        progress_(settings) {
    for (const Descriptor& descriptor : descriptors_) specs_.push_back(descriptor.to_string());
    for (LibraryModel& model : library.models()) {
      std::string path = model.file.path;
      known_.emplace(std::move(path),
                     Known{std::move(model), std::vector<bool>(specs_.size(), false)});
    }
    if (known_.empty()) return;
    for (std::size_t s = 0; s < specs_.size(); ++s) {
      const std::vector<std::int64_t> ids = library.described_models(specs_[s]);
      const std::unordered_set<std::int64_t> set(ids.begin(), ids.end());
      for (auto& [path, entry] : known_) entry.described[s] = set.count(entry.model.id) > 0;
    }
  }

  void run() {
    progress_.stage("describing " + std::to_string(meshes_.size()) + " meshes");
    const auto processors = std::max(1u, std::thread::hardware_concurrency());
    const std::size_t threads =
        settings_.threads > 0 ? static_cast<std::size_t>(settings_.threads) : processors;
    // As many meshes at a time as there are threads; a single one has them all.
    const std::size_t workers = std::min(threads, meshes_.size());
    inner_threads_ =
        static_cast<int>(std::max<std::size_t>(1, workers == 0 ? 1 : threads / workers));
    ahead_ = 4 * workers;
    std::vector<std::thread> pool;
    for (std::size_t i = 1; i < workers; ++i) pool.emplace_back([this] { work(); });
    if (workers > 0) work();
    for (std::thread& thread : pool) thread.join();
    progress_.clear();
    if (failure_) std::rethrow_exception(failure_);
  }

  std::size_t added = 0, described_anew = 0, kept = 0, same_content = 0;
  std::vector<std::pair<std::string, std::string>> failed;

 private:
  struct Outcome {
    LibraryModel model;
    std::vector<std::pair<std::string, Eigen::VectorXd>> vectors;
    std::vector<std::string> warnings;
    bool store = true;
    std::string reason;  // why there are no vectors; empty: there are
  };

  void work() {
    for (;;) {
      std::size_t i = 0;
      {
        std::unique_lock<std::mutex> lock(mutex_);
        advanced_.wait(lock, [&] { return failure_ || next_ < done_ + ahead_; });
        if (failure_ || next_ >= meshes_.size()) return;
        i = next_++;
      }
      const NamedMesh& mesh = meshes_[i];
      Outcome outcome;
      try {
        outcome = describe(mesh);
      } catch (const std::bad_alloc&) {
        outcome.reason = "not enough memory";
      } catch (const std::exception& error) {
        outcome.reason = without_path(error.what(), mesh.path);
      }
      const std::lock_guard<std::mutex> lock(mutex_);
      waiting_.emplace(i, std::move(outcome));
      for (auto first = waiting_.begin();
           first != waiting_.end() && first->first == done_ && !failure_;
           first = waiting_.erase(first)) {
        finish(meshes_[done_], first->second);
        ++done_;
      }
      progress_.update(static_cast<double>(done_) / static_cast<double>(meshes_.size()));
      advanced_.notify_all();
    }
  }

  [[nodiscard]] const Known* known(const std::string& path) const {
    const auto place = known_.find(path);
    return place == known_.end() ? nullptr : &place->second;
  }

  [[nodiscard]] Outcome describe(const NamedMesh& mesh) const {
    const Known* before = known(mesh.path);
    Outcome outcome;
    outcome.model.file.path = mesh.path;
    outcome.model.file.size = readable_size(mesh.path);
    struct stat state {};
    if (stat(mesh.path.c_str(), &state) == 0) {
      outcome.model.file.time =
          std::int64_t{state.st_mtim.tv_sec} * 1000000000 + state.st_mtim.tv_nsec;
    }
    outcome.model.class_name = mesh.class_name;
    if (before != nullptr && !mesh.class_name) {
      outcome.model.class_name = before->model.class_name;
    }
    const bool complete =
        before != nullptr && std::all_of(before->described.begin(), before->described.end(),
                                         [](bool described) { return described; });
    if (complete && before->model.file == outcome.model.file) {
      outcome.model.id = before->model.id;
      outcome.store = false;  // but for the class
      return outcome;
    }
    const MappedFile file(mesh.path);
    outcome.model.digest = digest_of(file.bytes());
    const bool same = before != nullptr && before->model.digest == outcome.model.digest;
    std::vector<Descriptor> open;
    for (std::size_t s = 0; s < specs_.size(); ++s) {
      if (!same || !before->described[s]) open.push_back(descriptors_[s]);
    }
    if (open.empty()) {  // only the time of the file is another
      outcome.model.vertices = before->model.vertices;
      outcome.model.triangles = before->model.triangles;
      return outcome;
    }
    const std::optional<MeshFormat> format = mesh_format(mesh.path);
    if (!format) throw FileError(mesh.path, unknown_mesh_extension(mesh.path));
    MeshFile parsed = parse_mesh(file.bytes(), *format, mesh.path);
    outcome.warnings = std::move(parsed.warnings);
    outcome.model.vertices = parsed.mesh.V.rows();
    outcome.model.triangles = parsed.mesh.F.rows();
    std::vector<Eigen::VectorXd> vectors = describe_mesh(parsed.mesh, open, inner_threads_);
    for (std::size_t s = 0; s < open.size(); ++s) {
      outcome.vectors.emplace_back(open[s].to_string(), std::move(vectors[s]));
    }
    return outcome;
  }

  void finish(const NamedMesh& mesh, const Outcome& outcome) {
    try {
      if (outcome.reason.empty()) store(mesh, outcome);
    } catch (...) {
      failure_ = std::current_exception();
      return;
    }
    if (!settings_.quiet && !outcome.warnings.empty()) progress_.clear();
    for (const std::string& sentence : outcome.warnings) {
      warn(settings_, printable(mesh.path) + ": " + sentence);
    }
    if (outcome.reason.empty()) return;
    progress_.clear();
    std::cerr << "shape3d: " << printable(mesh.path) << ": " << outcome.reason << '\n';
    failed.emplace_back(mesh.path, outcome.reason);
  }

  void store(const NamedMesh& mesh, const Outcome& outcome) {
    const Known* before = known(mesh.path);
    if (!outcome.store) {
      if (outcome.model.class_name != before->model.class_name) {
        library_.set_class(outcome.model.id, outcome.model.class_name);
      }
      ++kept;
      return;
    }
    if (before == nullptr && library_.model_of_digest(outcome.model.digest)) ++same_content;
    library_.put(outcome.model, outcome.vectors);
    ++(before == nullptr ? added : outcome.vectors.empty() ? kept : described_anew);
  }

  ShapeLibrary& library_;
  const std::vector<NamedMesh>& meshes_;
  std::vector<Descriptor> descriptors_;
  std::vector<std::string> specs_;
  const Settings& settings_;
  Progress progress_;
  std::unordered_map<std::string, Known> known_;
  int inner_threads_ = 1;
  std::mutex mutex_;
  std::condition_variable advanced_;
  std::map<std::size_t, Outcome> waiting_;  // described, but one before them is not
  std::size_t next_ = 0, done_ = 0, ahead_ = 1;
  std::exception_ptr failure_;
};

// The descriptors of the command line, else those of the library, else the default.
std::vector<Descriptor> descriptors_for(const LibraryAddArguments& arguments,
                                        const ShapeLibrary& library) {
  if (!arguments.descriptors.empty()) return parse_descriptors(arguments.descriptors);
  std::vector<std::string> specs;
  for (const LibraryDescriptor& stored : library.descriptors()) specs.push_back(stored.spec);
  if (specs.empty()) specs.emplace_back(kDefaultDescriptor);
  return parse_descriptors(specs);
}

// Draws the pictures of models that have none, a batch at a time. @return their number.
std::size_t draw_thumbnails(ShapeLibrary& library, const Settings& settings) {
  const std::vector<std::int64_t> ids = library.models_without_thumbnail();
  if (ids.empty()) return 0;
  Progress progress(settings);
  progress.stage("drawing " + std::to_string(ids.size()) + " thumbnails");
  constexpr std::size_t kBatch = 64;
  ThumbnailPainter painter(settings.threads);
  std::size_t drawn = 0;
  for (std::size_t first = 0; first < ids.size(); first += kBatch) {
    const std::size_t last = std::min(ids.size(), first + kBatch);
    std::vector<std::string> paths;
    for (std::size_t i = first; i < last; ++i) paths.push_back(library.model(ids[i])->file.path);
    const std::vector<std::string> png = painter.draw(paths);
    std::vector<std::pair<std::int64_t, std::string>> stored;
    for (std::size_t i = first; i < last; ++i) {
      if (!png[i - first].empty()) stored.emplace_back(ids[i], png[i - first]);
    }
    library.put_thumbnails(stored);
    drawn += stored.size();
    progress.update(static_cast<double>(last) / static_cast<double>(ids.size()));
  }
  return drawn;
}

}  // namespace

void library_add(const LibraryAddArguments& arguments, const Settings& settings) {
  static_cast<void>(parse_descriptors(arguments.descriptors));  // refused before anything is made
  Stopwatch watch;
  const std::vector<NamedMesh> meshes = named_meshes(arguments, settings);
  ShapeLibrary library(arguments.library, ShapeLibrary::Access::create);
  Adder adder(library, meshes, descriptors_for(arguments, library), settings);
  adder.run();
  const double describe_seconds = watch.lap();
  std::size_t thumbnails = 0;
  if (!arguments.no_thumbnails) {
    try {
      thumbnails = draw_thumbnails(library, settings);
    } catch (const PictureError& error) {
      warn(settings, std::string("there are no thumbnails: ") + error.what());
    }
  }
  const double thumbnail_seconds = watch.lap();

  Json report = report_head("library add");
  report["library"] = arguments.library;
  report["meshes"] = meshes.size();
  report["added"] = adder.added;
  report["described_anew"] = adder.described_anew;
  report["kept"] = adder.kept;
  report["same_content"] = adder.same_content;
  report["thumbnails"] = thumbnails;
  report["failed"] = Json::array();
  for (const auto& [path, reason] : adder.failed) {
    report["failed"].push_back({{"file", path}, {"reason", reason}});
  }
  report["models"] = library.size();
  report["seconds"] = {{"describe", describe_seconds}, {"thumbnails", thumbnail_seconds}};
  write_json(settings, report);
  if (!settings.quiet) {
    const auto count = [](const char* name, std::size_t number) {
      return number == 0 ? std::string() : line(name, grouped(static_cast<std::int64_t>(number)));
    };
    std::cout << line("library", arguments.library) << line("added", std::to_string(adder.added))
              << count("described anew", adder.described_anew) << count("kept", adder.kept)
              << count("same content as others", adder.same_content)
              << count("thumbnails", thumbnails) << count("failed", adder.failed.size())
              << line("models", grouped(library.size()))
              << line("seconds", rounded(describe_seconds + thumbnail_seconds));
  }
  if (!adder.failed.empty() && !arguments.keep_going) {
    std::cout.flush();
    throw std::runtime_error(std::to_string(adder.failed.size()) + " of " +
                             std::to_string(meshes.size()) +
                             " meshes could not be described; --keep-going makes that no failure");
  }
}

}  // namespace shape3d::apps
