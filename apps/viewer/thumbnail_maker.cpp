#include "thumbnail_maker.hpp"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include <QOpenGLContext>

#include "common/mesh_io.hpp"
#include "common/scene.hpp"
#include "common/thumbnail.hpp"
#include "document.hpp"

namespace shape3d::apps::viewer {

/// Draws in a window of VTK's own beside those of Qt.
struct ThumbnailMaker::Painter {
  SceneRenderer renderer{kThumbnailSize, kThumbnailSize, kThumbnailPaper};
};

struct ThumbnailMaker::Reader {
  struct Order {
    int round = 0;
    std::int64_t key = 0;
    std::string path;
  };

  explicit Reader(ThumbnailMaker& for_maker) : maker(for_maker), thread([this] { run(); }) {}
  ~Reader() {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      ending = true;
    }
    changed.notify_one();
    thread.join();
  }

  void run() {
    while (true) {
      Order order;
      {
        std::unique_lock<std::mutex> lock(mutex);
        changed.wait(lock, [this] { return ending || !orders.empty(); });
        if (ending) return;
        order = std::move(orders.front());
        orders.pop_front();
      }
      auto mesh = std::make_shared<Mesh>();
      try {
        *mesh = read_mesh(order.path).mesh;
      } catch (const std::exception&) {  // a mesh that is gone has no picture
        *mesh = Mesh{};
      }
      ThumbnailMaker* to = &maker;
      call_later(to, [to, order, mesh] {
        if (order.round != to->round_) return;
        --to->waiting_;
        emit to->made(order.key, to->draw(*mesh));
      });
    }
  }

  ThumbnailMaker& maker;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Order> orders;
  bool ending = false;
  std::thread thread;
};

ThumbnailMaker::ThumbnailMaker() = default;
ThumbnailMaker::~ThumbnailMaker() = default;

void ThumbnailMaker::request(std::int64_t key, const std::string& path) {
  if (!reader_) reader_ = std::make_unique<Reader>(*this);
  ++waiting_;
  {
    const std::lock_guard<std::mutex> lock(reader_->mutex);
    reader_->orders.push_back({round_, key, path});
  }
  reader_->changed.notify_one();
}

void ThumbnailMaker::clear() {
  ++round_;
  waiting_ = 0;
  if (!reader_) return;
  const std::lock_guard<std::mutex> lock(reader_->mutex);
  reader_->orders.clear();
}

QImage ThumbnailMaker::draw(const Mesh& mesh) {
  if (mesh.F.rows() == 0) return {};
  // Qt does not see that VTK makes another context the current one.
  QOpenGLContext* context = QOpenGLContext::currentContext();
  QSurface* surface = context != nullptr ? context->surface() : nullptr;
  if (!painter_) painter_ = std::make_unique<Painter>();
  const Raster raster = thumbnail_raster(mesh, painter_->renderer);
  if (context != nullptr) context->makeCurrent(surface);
  return QImage(raster.rgb.data(), raster.width, raster.height, 3 * raster.width,
                QImage::Format_RGB888)
      .copy();
}

QImage image_of_png(const std::string& png) {
  return QImage::fromData(reinterpret_cast<const uchar*>(png.data()), static_cast<int>(png.size()),
                          "PNG");
}

}  // namespace shape3d::apps::viewer
