#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>

#include <shape3d/levelset/local_mixture.hpp>
#include <shape3d/zmc/contour.hpp>
#include <shape3d/zmc/extract.hpp>

#include "common/error.hpp"
#include "common/levelset_views.hpp"
#include "common/memory_limit.hpp"
#include "common/mesh_io.hpp"
#include "common/output_file.hpp"
#include "common/polylines.hpp"
#include "common/text.hpp"
#include "common/volume_io.hpp"
#include "common/volume_write.hpp"
#include "progress.hpp"
#include "segment_result.hpp"
#include "surface_mesh.hpp"

namespace shape3d::apps {
namespace {

// Of segment(), with smoothing, and the mask, its measures and ψ beside it.
constexpr std::uint64_t kBytesPerSample = 24 + 16;

std::string words_of(const std::vector<double>& labels) {
  std::string words;
  for (const double label : labels) words += (words.empty() ? "" : " or ") + to_text(label);
  return words;
}

class Segmenting {
 public:
  Segmenting(const SegmentArguments& arguments, const Settings& settings)
      : arguments_(arguments), settings_(settings), progress_(settings) {
    result_.arguments = &arguments;
  }

  void run() {
    wishes_ = contour_wishes(arguments_.contours);
    open_files();
    read();
    segment();
    choose();
    measure();
    write();
    if (!arguments_.plot.empty()) plot();
    finish();
  }

 private:
  // First, so that a folder that is missing or full is known before the work.
  void open_files() {
    const auto open = [this](const std::string& name) {
      files_.push_back(std::make_unique<OutputFile>(name));
      return files_.back().get();
    };
    labels_file_ = open(arguments_.output);
    if (!arguments_.psi.empty()) psi_file_ = open(arguments_.psi);
    if (!arguments_.mesh.empty()) mesh_file_ = open(arguments_.mesh);
    for (const ContourWish& wish : wishes_) contour_files_.push_back(open(wish.path));
    if (!arguments_.plot.empty()) {
      std::error_code error;
      std::filesystem::create_directories(arguments_.plot, error);
      if (error) throw FileError(arguments_.plot, "cannot be made: " + error.message());
    }
    if (!settings_.json.empty()) json_file_ = open(settings_.json);
  }

  Volume read_one(const std::string& path, const std::string& series) {
    progress_.stage("reading " + path);
    VolumeReadOptions options;
    options.series = series;
    Volume volume = read_volume(path, options);
    for (const std::string& sentence : volume.warnings) warn(settings_, sentence);
    return volume;
  }

  void read() {
    volume_ = read_one(arguments_.volume, arguments_.series);
    result_.volume = volume_.view;
    result_.format = volume_.format;
    result_.region = region_of(arguments_, volume_.view);
    result_.roi = zmc::subvolume(volume_.view, result_.region.lower, result_.region.upper);
    const auto& dims = result_.roi.dims;
    require_memory(arguments_.volume,
                   kBytesPerSample * static_cast<std::uint64_t>(dims[0] * dims[1] * dims[2]), 0,
                   "segmenting " + to_text(dims) + " samples");
    for (std::size_t axis = 0; axis < arguments_.seed.size(); ++axis) {
      const double place = arguments_.seed[axis];
      const auto lower = static_cast<double>(result_.region.lower[axis]),
                 last = static_cast<double>(result_.region.upper[axis] - 1);
      if (place < lower || place > last) {
        throw UsageError("--seed-point: " + std::string(1, "xyz"[axis]) + " is " + to_text(place) +
                         ", outside the region, expected " + to_text(lower) + " to " +
                         to_text(last));
      }
      seed_[static_cast<Eigen::Index>(axis)] = place - lower;
    }
    for (const ContourWish& wish : wishes_) {
      const auto axis = static_cast<std::size_t>(wish.axis);
      if (wish.slice < result_.region.lower[axis] || wish.slice >= result_.region.upper[axis]) {
        throw UsageError(std::string("--contours ") + "xyz"[axis] + "=" +
                         std::to_string(wish.slice) + ": outside the region, expected " +
                         std::to_string(result_.region.lower[axis]) + " to " +
                         std::to_string(result_.region.upper[axis] - 1));
      }
    }
    if (!arguments_.truth.empty()) read_truth();
  }

  void read_truth() {
    const Volume truth = read_one(arguments_.truth, {});
    if (truth.view.dims != volume_.view.dims) {
      throw FileError(arguments_.truth, "has " + to_text(truth.view.dims) + " samples; expected " +
                                            to_text(volume_.view.dims) + ", as " +
                                            arguments_.volume + " has");
    }
    const zmc::VolumeView& view = volume_.view;
    const Eigen::Vector3d corner(static_cast<double>(view.dims[0]),
                                 static_cast<double>(view.dims[1]),
                                 static_cast<double>(view.dims[2]));
    // Half a sample is what a rounded header may be off by.
    const double off = std::max((truth.view.world(corner) - view.world(corner)).norm(),
                                (truth.view.origin - view.origin).norm());
    if (off > 0.5 * view.spacing.minCoeff()) {
      tell(arguments_.truth + " lies up to " + rounded(off) + " mm from " + arguments_.volume +
           "; its samples are compared by index");
    }
    const Mask whole = labelled(truth.view, arguments_.truth_labels);
    result_.truth = labelled(zmc::subvolume(truth.view, result_.region.lower, result_.region.upper),
                             arguments_.truth_labels);
    result_.truth->spacing = view.spacing;
    const auto count = [](const Mask& mask) {
      return std::count(mask.samples.begin(), mask.samples.end(), std::uint8_t{1});
    };
    const auto inside = count(*result_.truth), all = count(whole);
    if (all == 0) {
      throw FileError(arguments_.truth,
                      arguments_.truth_labels.empty()
                          ? "has no sample other than 0; expected an object"
                          : "has no sample of label " + words_of(arguments_.truth_labels));
    }
    result_.truth_outside = all - inside;
    if (result_.truth_outside > 0)
      tell(arguments_.truth + ": " + grouped(result_.truth_outside) + " of " + grouped(all) +
           " samples are outside the region and not compared");
  }

  // Two classes for the nodule at the seed.
  levelset::GaussianMixture classes_at_seed(const levelset::ImageView& image) {
    levelset::LocalMixtureOptions options;
    options.radius = 0.5 * arguments_.radius;
    options.dark = arguments_.inside == "dark";
    options.histogram = arguments_.options.histogram;
    options.threads = settings_.threads;
    levelset::GaussianMixture mixture = levelset::local_mixture(image, seed_, options);
    if (mixture.size() == 0) {
      throw FileError(arguments_.volume,
                      std::string("what is at the seed point is not ") +
                          (options.dark ? "darker" : "brighter") +
                          " than what is round it by more than the noise; expected a seed point in "
                          "a nodule, or --classes");
    }
    return mixture;
  }

  void segment() {
    const levelset::ImageView image = image_of(result_.roi);
    levelset::SegmentOptions options = arguments_.options;
    std::string stage;
    options.progress = [this, &stage](const levelset::Progress& at) {
      if (stage != at.stage) {
        stage = at.stage;
        progress_.stage("segmenting, " + stage);
      }
      progress_.update(at.share, at.seconds_left);
      return true;
    };
    try {
      if (arguments_.local_classes()) options.known_mixture = classes_at_seed(image);
      levelset::Field start;
      if (arguments_.radius > 0.0)
        start = levelset::sphere_front(image.grid(), seed_, arguments_.radius);
      result_.segmentation = levelset::segment(image, options, start);
    } catch (const std::invalid_argument& error) {
      throw FileError(arguments_.volume, error.what());
    }
    for (const std::string& sentence : result_.segmentation.warnings)
      tell(arguments_.volume + ": " + sentence);
    const std::string sentence(levelset::to_string(result_.segmentation.status));
    switch (result_.segmentation.status) {
      case levelset::Status::converged:
        break;
      case levelset::Status::iteration_limit:
      case levelset::Status::front_vanished:
      case levelset::Status::front_filled:
        tell(arguments_.volume + ": " + sentence);
        break;
      case levelset::Status::constant_image:
      case levelset::Status::too_few_bins:
      case levelset::Status::one_sided:
      case levelset::Status::cancelled:
        throw FileError(arguments_.volume, sentence);
    }
  }

  // The mask and ψ of what is kept.
  void choose() {
    progress_.stage("choosing the component");
    Mask& mask = result_.mask;
    mask.dims = result_.roi.dims;
    mask.spacing = result_.roi.spacing;
    levelset::Field& psi = result_.segmentation.evolution.psi;
    mask.samples.resize(static_cast<std::size_t>(psi.size()));
    for (Eigen::Index n = 0; n < psi.size(); ++n)
      mask.samples[static_cast<std::size_t>(n)] = psi[n] <= 0.0F ? 1 : 0;
    if (arguments_.keep_connected || arguments_.nodule) {
      // Beside the object by no more than the start sphere, or three samples.
      const double reach =
          arguments_.radius > 0.0 ? arguments_.radius : 3.0 * mask.spacing.maxCoeff();
      const auto seed = nearest_inside(mask, seed_, reach);
      if (!seed) {
        throw FileError(arguments_.volume, "nothing is inside within " + rounded(reach) +
                                               " mm of the seed point; expected a seed point in "
                                               "the object");
      }
      if (arguments_.nodule) {
        NoduleOptions options;
        options.radius = arguments_.radius;
        result_.nodule = nodule_at(mask, *seed, options);
        mask = result_.nodule->mask;
        if (std::find(mask.samples.begin(), mask.samples.end(), 1) == mask.samples.end())
          tell(arguments_.volume +
               ": at the seed point is a wall or a vessel and no nodule: the "
               "label map is empty");
      } else {
        mask = component_at(mask, *seed);
      }
      // What is left out lies outside, as far as it was inside, but not on the surface.
      const auto least = static_cast<float>(1e-3 * mask.spacing.minCoeff());
      for (Eigen::Index n = 0; n < psi.size(); ++n) {
        if (psi[n] <= 0.0F && mask.samples[static_cast<std::size_t>(n)] == 0)
          psi[n] = std::max(-psi[n], least);
      }
    }
    result_.psi = in_place_of(result_.roi, psi.data());
  }

  void measure() {
    progress_.stage("measuring");
    const auto view_of_mask = [](const Mask& mask) {
      return MaskView{mask.samples.data(), mask.dims, mask.spacing};
    };
    result_.components = count_components(result_.mask);
    result_.size = measure_mask(view_of_mask(result_.mask));
    if (!result_.truth) return;
    result_.agreement = compare_masks(view_of_mask(result_.mask), view_of_mask(*result_.truth));
    result_.truth_size = measure_mask(view_of_mask(*result_.truth));
  }

  void write() {
    progress_.stage("writing " + arguments_.output);
    const auto& dims = volume_.view.dims;
    std::vector<std::uint8_t> labels(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]), 0);
    const Region& region = result_.region;
    for (std::int64_t k = 0; k < result_.mask.dims[2]; ++k) {
      for (std::int64_t j = 0; j < result_.mask.dims[1]; ++j) {
        const auto row = result_.mask.samples.begin() + result_.mask.index({0, j, k});
        std::copy(row, row + result_.mask.dims[0],
                  labels.begin() + region.lower[0] +
                      dims[0] * (j + region.lower[1] + dims[1] * (k + region.lower[2])));
      }
    }
    write_volume(*labels_file_, *written_volume_format(arguments_.output),
                 in_place_of(volume_.view, labels.data()));
    if (psi_file_ != nullptr) write_volume(*psi_file_, VolumeFormat::nrrd, result_.psi);
    if (mesh_file_ != nullptr) write_surface();
    for (std::size_t n = 0; n < wishes_.size(); ++n) write_contour(wishes_[n], *contour_files_[n]);
  }

  void write_surface() {
    progress_.stage("writing " + arguments_.mesh);
    zmc::Options options;
    options.inside = zmc::Inside::below;
    options.border = zmc::Border::capped;
    options.threads = settings_.threads;
    AnySurface surface;
    zmc::Status status = zmc::extract(result_.psi, 0.0, options, surface.emplace<0>());
    if (status == zmc::Status::too_many_vertices)
      status = zmc::extract(result_.psi, 0.0, options, surface.emplace<1>());
    if (status == zmc::Status::empty) tell(arguments_.mesh + ": the surface is empty");
    MeshView mesh = view_of(surface);
    mesh.space = "LPS";
    mesh.comments = {"Shape3D " SHAPE3D_VERSION};
    result_.mesh_vertices = mesh.vertex_count;
    result_.mesh_triangles = mesh.triangle_count;
    write_mesh(*mesh_file_, *mesh_format(arguments_.mesh), mesh);
  }

  void write_contour(const ContourWish& wish, OutputFile& file) {
    zmc::Options options;
    options.inside = zmc::Inside::below;
    const auto axis = static_cast<std::size_t>(wish.axis);
    const zmc::Contour contour =
        zmc::contour(result_.psi, 0.0, wish.axis, wish.slice - result_.region.lower[axis], options);
    write_svg(file, contour, join_edges(contour), SlicePlane(result_.roi, wish.axis),
              "Front at " + std::string(1, "xyz"[axis]) + " = " + std::to_string(wish.slice));
  }

  void plot() {
    progress_.stage("drawing into " + arguments_.plot);
    for (const Plot& plot : plot_segmentation(result_)) {
      const std::filesystem::path path = std::filesystem::path(arguments_.plot) / plot.name;
      files_.push_back(std::make_unique<OutputFile>(path.string()));
      files_.back()->write(plot.png);
    }
  }

  void finish() {
    if (json_file_ != nullptr) json_file_->write(to_json(result_).dump(2) + "\n");
    // All are whole before the first gets its name.
    for (const auto& file : files_) file->finish();
    for (const auto& file : files_) file->commit();
    progress_.clear();
    if (!settings_.quiet) std::cout << to_lines(result_);
  }

  void tell(const std::string& sentence) {
    progress_.clear();
    warn(settings_, sentence);
    result_.warnings.push_back(sentence);
  }

  const SegmentArguments& arguments_;
  const Settings& settings_;
  Progress progress_;
  Volume volume_;
  SegmentResult result_;
  std::vector<ContourWish> wishes_;
  Eigen::Vector3d seed_ = Eigen::Vector3d::Zero();  // in samples of the region
  std::vector<std::unique_ptr<OutputFile>> files_;
  OutputFile *labels_file_ = nullptr, *psi_file_ = nullptr, *mesh_file_ = nullptr,
             *json_file_ = nullptr;
  std::vector<OutputFile*> contour_files_;
};

}  // namespace

void segment_volume(const SegmentArguments& arguments, const Settings& settings) {
  Segmenting(arguments, settings).run();
}

}  // namespace shape3d::apps
