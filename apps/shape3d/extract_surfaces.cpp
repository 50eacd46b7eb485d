#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>
#include <numeric>
#include <stdexcept>

#include <shape3d/zmc/extract.hpp>

#include "common/error.hpp"
#include "common/memory_limit.hpp"
#include "common/mesh_check.hpp"
#include "common/output_file.hpp"
#include "common/picture.hpp"
#include "common/text.hpp"
#include "extract_arguments.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "stopwatch.hpp"
#include "surface_mesh.hpp"

namespace shape3d::apps {
namespace {

// Bytes of a surface and of its check for each vertex: 24 of coordinates, two triangles of 12, and
// for the check 20 and twice 24.
constexpr std::uint64_t kBytesPerVertex = 24 + 2 * 12 + 20 + 2 * 24;

// One isovalue, from extraction to report.
struct Extracted {
  double isovalue = 0.0;
  AnySurface surface;
  MeshCheck check;
  zmc::Counts counts;
  zmc::Timings timings;
  std::int64_t coincident_as_float = 0;
  std::string output;
  double extract_seconds = 0.0, check_seconds = 0.0, write_seconds = 0.0;
};

class Extraction {
 public:
  Extraction(const ExtractArguments& arguments, const Settings& settings)
      : arguments_(arguments),
        settings_(settings),
        progress_(settings),
        format_(*mesh_format(arguments.output)),
        names_(output_names(arguments.output, arguments.isovalues, format_)) {}

  void run() {
    // The files are opened first: a directory that is missing or full is known before the work.
    std::vector<std::unique_ptr<OutputFile>> files;
    for (const std::string& name : names_) files.push_back(std::make_unique<OutputFile>(name));
    if (!arguments_.picture.empty()) picture_ = std::make_unique<OutputFile>(arguments_.picture);
    if (!settings_.json.empty()) json_ = std::make_unique<OutputFile>(settings_.json);
    Stopwatch watch;
    volume_ = read_volume_of(arguments_.volume, settings_, progress_);
    read_seconds_ = watch.lap();
    view_ = region_of(volume_.view, arguments_.roi);
    for (std::size_t i = 0; i < arguments_.isovalues.size(); ++i) {
      Extracted item = extract(arguments_.isovalues[i]);
      write(item, files, i);
      keep(std::move(item));
    }
    if (format_ == MeshFormat::vtp && arguments_.isovalues.size() > 1) write_collection(*files[0]);
    if (picture_) draw();
    finish_report();
    // All are whole before the first gets its name.
    if (json_) json_->finish();
    for (const auto& file : files) file->commit();
    if (picture_) picture_->commit();
    if (json_) json_->commit();
    progress_.clear();
    if (!settings_.quiet) std::cout << text_;
  }

 private:
  Extracted extract(double isovalue) {
    Extracted item;
    item.isovalue = isovalue;
    zmc::Options options = to_options(arguments_.volume, settings_);
    options.triangulation = arguments_.triangulation;
    options.zero_faces = arguments_.zero_faces;
    options.border = arguments_.cap ? zmc::Border::capped : zmc::Border::open;
    options.progress = [this](double share) {
      progress_.update(share);
      return true;
    };
    progress_.stage("extracting isovalue " + shortest(isovalue));
    Stopwatch watch;
    const zmc::Status status = extract_within_memory(item, options);
    item.extract_seconds = watch.lap();
    if (item.surface.index() == 1) id_bits_ = 64;
    std::visit(
        [&item](const auto& surface) {
          item.counts = surface.counts;
          item.timings = surface.timings;
        },
        item.surface);
    if (status == zmc::Status::empty) {
      warn(settings_, emptiness("the surface", isovalue, view_, arguments_.volume.path));
    }
    progress_.stage("checking isovalue " + shortest(isovalue));
    MeshCheckOptions check_options;
    if (!arguments_.cap) check_options.volume = &view_;
    item.check = check_mesh(apps::view_of(item.surface), check_options);
    if (arguments_.cap)
      item.check.odd_interior_edges = item.check.odd_edges;  // a capped surface has no border
    if (format_ == MeshFormat::stl)
      item.coincident_as_float = coincident_as_float(apps::view_of(item.surface));
    item.check_seconds = watch.lap();
    return item;
  }

  // With 32-bit ids, and again with 64-bit ones when there are too many vertices for those.
  zmc::Status extract_within_memory(Extracted& item, zmc::Options& options) {
    const std::uint64_t memory = available_memory();
    const auto limit = static_cast<std::int64_t>(
        std::min<std::uint64_t>(memory / kBytesPerVertex, std::uint64_t{1} << 60));
    const std::int64_t narrow_limit = std::numeric_limits<std::int32_t>::max();
    try {
      if (arguments_.id_bits != "64") {
        item.surface.emplace<0>();
        options.max_vertices = std::min(limit, narrow_limit);
        const zmc::Status status =
            zmc::extract(view_, item.isovalue, options, std::get<0>(item.surface));
        if (status != zmc::Status::too_many_vertices) return status;
        if (arguments_.id_bits == "32") {
          throw FileError(arguments_.volume.path,
                          "the surface has more vertices than 32-bit ids can number");
        }
      }
      if (limit > narrow_limit || arguments_.id_bits == "64") {
        item.surface.emplace<1>();
        options.max_vertices = limit;
        const zmc::Status status =
            zmc::extract(view_, item.isovalue, options, std::get<1>(item.surface));
        if (status != zmc::Status::too_many_vertices) return status;
      }
    } catch (const std::invalid_argument& error) {
      fail_for(arguments_.volume.path, error);
    } catch (const std::bad_alloc&) {
      throw FileError(arguments_.volume.path, "the surface of isovalue " + shortest(item.isovalue) +
                                                  " needs more memory than there is; " +
                                                  bytes_to_text(available_memory()) +
                                                  " are available");
    }
    const auto needed = static_cast<std::uint64_t>(limit) * kBytesPerVertex;
    throw FileError(arguments_.volume.path,
                    "the surface of isovalue " + shortest(item.isovalue) + " has more than " +
                        grouped(limit) + " vertices and needs more than " + bytes_to_text(needed) +
                        " of memory; " + bytes_to_text(memory) + " are available");
  }

  void write(Extracted& item, const std::vector<std::unique_ptr<OutputFile>>& files,
             std::size_t i) {
    Stopwatch watch;
    if (arguments_.space == "ras") turn_about_z(item.surface);
    if (format_ == MeshFormat::vtp && arguments_.isovalues.size() > 1) {
      item.output = names_[0];
      collection_.add(item.surface, item.isovalue);
    } else {
      item.output = names_[i];
      progress_.stage("writing " + item.output);
      MeshView mesh = labelled(apps::view_of(item.surface));
      std::vector<MeshArray> vertex_arrays, triangle_arrays;
      if (format_ == MeshFormat::vtp) {
        vertex_arrays = vertex_arrays_of(item.surface, item.isovalue);
        triangle_arrays = triangle_arrays_of(item.surface, item.isovalue);
        mesh.vertex_arrays = &vertex_arrays;
        mesh.triangle_arrays = &triangle_arrays;
      }
      mesh.comments = {"isovalue " + shortest(item.isovalue), "Shape3D " SHAPE3D_VERSION};
      write_mesh(*files[i], format_, mesh);
      files[i]->finish();
    }
    item.write_seconds = watch.lap();
  }

  void write_collection(OutputFile& file) {
    progress_.stage("writing " + file.path());
    Stopwatch watch;
    write_mesh(file, format_, labelled(collection_.view()));
    file.finish();
    items_.back().write_seconds += watch.lap();
  }

  MeshView labelled(MeshView mesh) const {
    mesh.space = arguments_.space == "ras" ? "RAS" : "LPS";
    return mesh;
  }

  // Keeps what the report needs, and the surface only where it is drawn.
  void keep(Extracted item) {
    if (!picture_) item.surface = AnySurface{};
    items_.push_back(std::move(item));
  }

  void draw() {
    progress_.stage("drawing " + arguments_.picture);
    Stopwatch watch;
    // The innermost surface is opaque, what lies round it is seen through.
    static constexpr std::string_view kPalette[] = {"bone",  "skin",   "blue",
                                                    "green", "orange", "purple"};
    std::vector<std::size_t> order(items_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const bool above = arguments_.volume.inside == zmc::Inside::above;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return above ? items_[a].isovalue > items_[b].isovalue
                   : items_[a].isovalue < items_[b].isovalue;
    });
    std::vector<SceneMesh> scene;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
      SceneMesh mesh;
      mesh.mesh = labelled(apps::view_of(items_[order[rank]].surface));
      mesh.color = *color_named(kPalette[rank % std::size(kPalette)]);
      mesh.opacity = rank == 0 ? 1.0 : 0.35;
      scene.push_back(std::move(mesh));
    }
    const bool anything = std::any_of(items_.begin(), items_.end(), [](const Extracted& item) {
      return item.check.triangles > 0;
    });
    if (!anything) {
      warn(settings_, arguments_.picture + ": there is nothing to draw, no picture was written");
      picture_.reset();
      return;
    }
    picture_->write(draw_png(scene, {}));
    picture_->finish();
    picture_seconds_ = watch.lap();
  }

  Json report_of(const Extracted& item) const {
    const zmc::Counts& counts = item.counts;
    Json json = {{"isovalue", item.isovalue}, {"output", item.output}};
    Json check = to_json(item.check);
    for (auto it = check.begin(); it != check.end(); ++it) {
      json[it.key()] = it.value();
      if (it.key() == "triangles") {
        json["zero_faces"] = counts.zero_faces;
        json["closing_triangles"] = counts.closing_triangles;
        json["zero_vertices"] = counts.zero_vertices;
        json["centroids"] = counts.centroids;
        json["patches"] = counts.patches;
      }
    }
    if (format_ == MeshFormat::stl) json["coincident_vertices_as_float"] = item.coincident_as_float;
    json["cells_with_patch"] = counts.cells_with_patch;
    json["all_zero_cells"] = counts.all_zero_cells;
    json["masked_cells"] = counts.masked_cells;
    json["face_cases"] = counts.faces_by_case;
    json["face_case_shares"] = shares(counts);
    json["seconds"] = {
        {"classify", item.timings.classify}, {"zero_regions", item.timings.zero_regions},
        {"count", item.timings.count},       {"generate", item.timings.generate},
        {"extract", item.extract_seconds},   {"check", item.check_seconds},
        {"write", item.write_seconds}};
    return json;
  }

  // Per cent of the faces of cells with patches, cases 1 to 13.
  static std::array<double, 13> shares(const zmc::Counts& counts) {
    const auto all = static_cast<double>(
        std::accumulate(counts.faces_by_case.begin(), counts.faces_by_case.end(), std::int64_t{0}));
    std::array<double, 13> result{};
    for (std::size_t c = 0; c < 13; ++c)
      result[c] = all > 0 ? 100.0 * static_cast<double>(counts.faces_by_case[c]) / all : 0.0;
    return result;
  }

  std::string text_of(const Extracted& item) const {
    std::string text = line("isovalue", shortest(item.isovalue)) + line("output", item.output) +
                       to_lines(item.check);
    text += line("zero faces", grouped(item.counts.zero_faces));
    text += line("zero vertices", grouped(item.counts.zero_vertices));
    if (item.counts.closing_triangles > 0)
      text += line("closing triangles", grouped(item.counts.closing_triangles));
    if (item.counts.all_zero_cells > 0)
      text += line("all-zero cells", grouped(item.counts.all_zero_cells));
    if (item.counts.masked_cells > 0)
      text += line("masked cells", grouped(item.counts.masked_cells));
    if (item.coincident_as_float > 0)
      text += line("coincident in STL", grouped(item.coincident_as_float));
    if (item.counts.cells_with_patch > 0) {
      std::string cases;
      const std::array<double, 13> percent = shares(item.counts);
      for (std::size_t c = 0; c < 13; ++c) {
        if (item.counts.faces_by_case[c] == 0) continue;
        char share[48];
        std::snprintf(share, sizeof share, "%s%zu: %.2f %%", cases.empty() ? "" : ", ", c + 1,
                      percent[c]);
        cases += share;
      }
      text += line("face cases", cases);
    }
    char seconds[160];
    std::snprintf(seconds, sizeof seconds, "read %.3f, extract %.3f, check %.3f, write %.3f",
                  read_seconds_, item.extract_seconds, item.check_seconds, item.write_seconds);
    return text + line("seconds", seconds);
  }

  // The keys of a single surface stand at the top; of several surfaces the sums, and each in
  // `surfaces`.
  void finish_report() {
    text_ =
        line("volume", arguments_.volume.path + " (" + volume_.format + ", " + to_text(view_.dims) +
                           " " + std::string(zmc::to_string(view_.type)) + ")");
    Json surfaces = Json::array();
    for (const Extracted& item : items_) {
      surfaces.push_back(report_of(item));
      text_ += (items_.size() > 1 ? "\n" : "") + text_of(item);
    }
    Json report = report_head("extract");
    report["input"] = {{"file", arguments_.volume.path},
                       {"format", volume_.format},
                       {"dims", volume_.view.dims},
                       {"type", zmc::to_string(volume_.view.type)},
                       {"warnings", volume_.warnings}};
    report["options"] = {
        {"inside", to_string(arguments_.volume.inside)},
        {"ties", to_string(arguments_.volume.ties)},
        {"triangulation",
         arguments_.triangulation == zmc::Triangulation::compact ? "compact" : "centroid"},
        {"zero_faces", arguments_.zero_faces == zmc::ZeroFaces::boundary ? "boundary" : "mating"},
        {"non_finite", arguments_.volume.non_finite == zmc::NonFinite::error ? "error" : "mask"},
        {"cap", arguments_.cap},
        {"roi", arguments_.roi.empty() ? Json(nullptr) : Json(arguments_.roi)},
        {"space", arguments_.space},
        {"id_bits", id_bits_}};
    Json totals = surfaces[0];
    if (surfaces.size() > 1) {
      for (const char* key : {"isovalue", "output", "genus", "closed", "oriented", "volume",
                              "largest_components", "face_case_shares"}) {
        totals.erase(key);
      }
      for (std::size_t i = 1; i < surfaces.size(); ++i) add_numbers(totals, surfaces[i]);
    }
    report.update(totals);
    report["seconds"]["read"] = read_seconds_;
    if (picture_) report["seconds"]["picture"] = picture_seconds_;
    report["surfaces"] = std::move(surfaces);
    if (json_) json_->write(report.dump(2) + "\n");
  }

  static void add_numbers(Json& to, const Json& from) {
    for (auto it = to.begin(); it != to.end(); ++it) {
      const Json& more = from.at(it.key());
      if (it->is_structured()) {
        if (it->is_array()) {
          for (std::size_t i = 0; i < it->size(); ++i)
            (*it)[i] = (*it)[i].get<std::int64_t>() + more[i].get<std::int64_t>();
        } else {
          add_numbers(*it, more);
        }
      } else if (it->is_number_integer()) {
        *it = it->get<std::int64_t>() + more.get<std::int64_t>();
      } else if (it->is_number()) {
        *it = it->get<double>() + more.get<double>();
      }
    }
  }

  const ExtractArguments& arguments_;
  const Settings& settings_;
  Progress progress_;
  MeshFormat format_;
  std::vector<std::string> names_;
  std::unique_ptr<OutputFile> picture_, json_;
  Volume volume_;
  zmc::VolumeView view_;
  SurfaceCollection collection_;
  std::vector<Extracted> items_;
  double read_seconds_ = 0.0, picture_seconds_ = 0.0;
  std::string text_;
  int id_bits_ = 32;
};

}  // namespace

void extract_surfaces(const ExtractArguments& arguments, const Settings& settings) {
  Extraction(arguments, settings).run();
}

}  // namespace shape3d::apps
