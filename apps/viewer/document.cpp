#include "document.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include <QMetaObject>

#include "common/byte_source.hpp"
#include "common/error.hpp"
#include "common/mesh_io.hpp"
#include "common/text.hpp"
#include "common/volume_info.hpp"
#include "common/volume_io.hpp"
#include "model/heap.hpp"

namespace shape3d::apps::viewer {

FileKind kind_of(const std::string& path) {
  if (!std::filesystem::is_directory(path)) static_cast<void>(readable_size(path));
  if (lower_case(std::filesystem::path(path).extension().string()) == ".json")
    return FileKind::session;
  if (mesh_format(path)) return FileKind::mesh;
  return detect_volume_format(path) ? FileKind::volume : FileKind::other;
}

std::shared_ptr<const OpenVolume> read_open_volume(const std::string& path) {
  static std::mutex one_at_a_time;  // as VTK's readers need
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  auto open = std::make_shared<OpenVolume>();
  open->path = std::filesystem::absolute(path).lexically_normal().string();
  open->volume = read_volume(path);
  zmc::validate(open->volume.view);
  const VolumeDescription description = describe_volume(open->volume);
  if (description.finite == 0) throw FileError(path, "has no finite sample; expected some");
  open->minimum = description.minimum;
  open->maximum = description.maximum;
  open->automatic = automatic_window(open->volume.view);
  return open;
}

std::shared_ptr<const OpenMesh> read_open_mesh(const std::string& path) {
  auto open = std::make_shared<OpenMesh>();
  open->path = std::filesystem::absolute(path).lexically_normal().string();
  open->mesh = read_mesh(path).mesh;
  if (open->mesh.F.rows() == 0) throw FileError(path, "has no triangle; expected a surface");
  if (open->mesh.space == "RAS") {
    open->mesh.V.leftCols<2>() *= -1.0;  // a half turn: the triangles keep their orientation
    open->mesh.space = "LPS";
  }
  return open;
}

void call_later(QObject* object, std::function<void()> function) {
  QMetaObject::invokeMethod(object, std::move(function), Qt::QueuedConnection);
}

// Reads files one after another: the readers of volumes are not for several threads at a time.
struct Document::Reader {
  explicit Reader(Document& to) : document(to), thread([this] { run(); }) {}
  ~Reader() {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      ending = true;
      paths.clear();
    }
    changed.notify_one();
    thread.join();
  }

  void run() {
    while (true) {
      std::string path;
      {
        std::unique_lock<std::mutex> lock(mutex);
        changed.wait(lock, [this] { return ending || !paths.empty(); });
        if (ending) return;
        path = std::move(paths.front());
        paths.pop_front();
      }
      read(path);
    }
  }

  void read(const std::string& path) {
    std::shared_ptr<const OpenVolume> volume;
    std::shared_ptr<const OpenMesh> mesh;
    std::string error;
    try {
      if (kind_of(path) == FileKind::mesh) {
        mesh = read_open_mesh(path);
      } else {
        volume = read_open_volume(path);
      }
      trim_heap();
    } catch (const std::bad_alloc&) {
      error = path + ": there is not enough memory";
    } catch (const std::exception& failure) {
      error = failure.what();
    }
    Document* to = &document;
    call_later(to, [to, volume, mesh, error] {
      --to->loading_;
      if (!error.empty()) emit to->failed(QString::fromStdString(error));
      if (volume) {
        for (const std::string& warning : volume->volume.warnings)
          emit to->said(QString::fromStdString(warning));
        to->set_volume(volume);
      }
      if (mesh) to->add_mesh(mesh);
      emit to->loading_changed();
    });
  }

  Document& document;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::string> paths;
  bool ending = false;
  std::thread thread;
};

Document::Document() = default;
Document::~Document() = default;

std::vector<std::string> Document::files() const {
  std::vector<std::string> files;
  for (const std::string& path : order_) {
    const bool open = (volume_ && volume_->path == path) || path == library_ ||
                      path == collection_map_ ||
                      std::any_of(meshes_.begin(), meshes_.end(),
                                  [&path](const auto& mesh) { return mesh->path == path; });
    if (open && std::find(files.begin(), files.end(), path) == files.end()) files.push_back(path);
  }
  return files;
}

void Document::open(const std::string& path) {
  if (!reader_) reader_ = std::make_unique<Reader>(*this);
  ++loading_;
  {
    const std::lock_guard<std::mutex> lock(reader_->mutex);
    reader_->paths.push_back(path);
  }
  reader_->changed.notify_one();
  emit loading_changed();
}

void Document::set_volume(std::shared_ptr<const OpenVolume> volume) {
  volume_ = std::move(volume);
  if (volume_) {
    order_.push_back(volume_->path);
    const auto& dims = volume_->volume.view.dims;
    for (std::size_t axis = 0; axis < 3; ++axis)
      cursor_[static_cast<Eigen::Index>(axis)] = static_cast<double>(dims[axis] / 2);
    window_ = volume_->automatic;
  }
  emit volume_changed();
  emit window_changed();
  emit cursor_changed();
}

void Document::add_mesh(std::shared_ptr<const OpenMesh> mesh) {
  order_.push_back(mesh->path);
  meshes_.push_back(std::move(mesh));
  emit meshes_changed();
}

void Document::remove_mesh(const std::string& path) {
  const auto gone = std::remove_if(meshes_.begin(), meshes_.end(),
                                   [&path](const auto& mesh) { return mesh->path == path; });
  if (gone == meshes_.end()) return;
  meshes_.erase(gone, meshes_.end());
  emit meshes_changed();
}

void Document::look_at(const std::string& path) {
  const std::string before = std::exchange(looked_at_, path);
  if (!before.empty() && before != path) remove_mesh(before);
}

void Document::set_library(const std::string& path) {
  library_ = path;
  order_.push_back(path);
  emit collection_changed();
}

void Document::set_collection_map(const std::string& path) {
  collection_map_ = path;
  order_.push_back(path);
  emit collection_changed();
}

void Document::close_all() {
  looked_at_.clear();
  order_.clear();
  meshes_.clear();
  volume_.reset();
  library_.clear();
  collection_map_.clear();
  emit meshes_changed();
  emit volume_changed();
  emit collection_changed();
  trim_heap();
}

void Document::set_cursor(const Eigen::Vector3d& lattice) {
  if (!volume_) return;
  Eigen::Vector3d inside = lattice;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto last = static_cast<double>(volume_->volume.view.dims[axis] - 1);
    auto& place = inside[static_cast<Eigen::Index>(axis)];
    place = std::clamp(place, 0.0, last);
  }
  if (inside == cursor_) return;
  cursor_ = inside;
  emit cursor_changed();
}

void Document::set_window(const Window& window) {
  if (window == window_) return;
  window_ = window;
  emit window_changed();
}

}  // namespace shape3d::apps::viewer
