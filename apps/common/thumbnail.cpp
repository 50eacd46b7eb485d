#include "thumbnail.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <thread>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include "mesh_io.hpp"
#include "offscreen.hpp"
#include "scene.hpp"
#include "vtk_messages.hpp"

namespace shape3d::apps {
namespace {

constexpr Color kClay{0.80, 0.82, 0.86};

std::string picture_of(const Mesh& mesh, SceneRenderer& renderer) {
  return to_png(thumbnail_raster(mesh, renderer));
}

void append(std::string& bytes, const std::string& part) {
  const auto size = static_cast<std::uint64_t>(part.size());
  bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
  bytes += part;
}

// In the process that draws: the pictures one after another, each after its length.
std::string pictures_of(const std::string* paths, std::size_t count) {
  SceneRenderer renderer(kThumbnailSize, kThumbnailSize, kThumbnailPaper);
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) {
    std::string png;
    try {
      const Mesh mesh = read_mesh(paths[i]).mesh;
      if (mesh.F.rows() > 0) png = picture_of(mesh, renderer);
    } catch (const std::exception&) {  // a mesh that is gone has no picture
    }
    append(bytes, png);
  }
  return bytes;
}

void split(const std::string& bytes, std::string* png, std::size_t count) {
  const char* at = bytes.data();
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t size = 0;
    std::memcpy(&size, at, sizeof size);
    png[i].assign(at + sizeof size, size);
    at += sizeof size + size;
  }
}

// Halves a batch whose process fails until the mesh that makes it fail is alone.
void draw_batch(const std::string& display, const std::string* paths, std::string* png,
                std::size_t count) {
  if (count == 0) return;
  const ChildResult result = draw_on(display, [&] { return pictures_of(paths, count); });
  if (result.ok) {
    split(result.output, png, count);
  } else if (count > 1) {
    draw_batch(display, paths, png, count / 2);
    draw_batch(display, paths + count / 2, png + count / 2, count - count / 2);
  }
}

}  // namespace

Raster thumbnail_raster(const Mesh& mesh, SceneRenderer& renderer) {
  std::vector<SceneMesh> items(1);
  items[0].mesh = view_of(mesh);
  items[0].mesh.vertex_arrays = nullptr;
  items[0].mesh.triangle_arrays = nullptr;
  items[0].color = kClay;
  items[0].shading = 0.97;  // not 1: ambient occlusion takes longer than all else
  return renderer.render(items, View::upright);
}

ThumbnailPainter::ThumbnailPainter(int threads)
    : processes_(threads > 0 ? static_cast<std::size_t>(threads)
                             : std::max(1U, std::thread::hardware_concurrency())) {
  const auto works = [](const std::string& display) {
    return draw_on(display,
                   [] {
                     static_cast<void>(
                         SceneRenderer(32, 32, kThumbnailPaper).render({}, View::upright));
                     return std::string();
                   })
        .ok;
  };
  if (const char* display = std::getenv("DISPLAY"); display != nullptr && *display != '\0') {
    if (works(display)) display_ = display;
  }
  if (!display_.empty()) return;
  own_display_ = std::make_unique<PrivateDisplay>();
  display_ = own_display_->name();
  if (!works(display_)) throw PictureError("the display " + display_ + " draws nothing");
}

ThumbnailPainter::~ThumbnailPainter() = default;

std::vector<std::string> ThumbnailPainter::draw(const std::vector<std::string>& paths) {
  std::vector<std::string> png(paths.size());
  const std::size_t parts = std::min(processes_, paths.size());
  std::vector<std::thread> pool;
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t first = part * paths.size() / parts;
    const std::size_t last = (part + 1) * paths.size() / parts;
    pool.emplace_back([this, &paths, &png, first, last] {
      draw_batch(display_, paths.data() + first, png.data() + first, last - first);
    });
  }
  for (std::thread& thread : pool) thread.join();
  return png;
}

std::string draw_thumbnail(const Mesh& mesh) {
  if (mesh.F.rows() == 0) throw PictureError("there is no triangle to draw");
  return draw_offscreen([&] {
    SceneRenderer renderer(kThumbnailSize, kThumbnailSize, kThumbnailPaper);
    return picture_of(mesh, renderer);
  });
}

Raster decode_png_raster(const std::string& png) {
  const VtkMessages messages;
  vtkNew<vtkPNGReader> reader;
  reader->SetMemoryBuffer(png.data());
  reader->SetMemoryBufferLength(static_cast<vtkIdType>(png.size()));
  if (png.size() < 8 || png.compare(1, 3, "PNG") != 0) throw PictureError("is no PNG");
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  int dims[3];
  image->GetDimensions(dims);
  if (dims[0] < 1 || dims[1] < 1 || image->GetNumberOfScalarComponents() != 3 ||
      image->GetScalarType() != VTK_UNSIGNED_CHAR) {
    throw PictureError("is no PNG of red, green and blue bytes");
  }
  Raster raster = make_raster(dims[0], dims[1], kThumbnailPaper);
  for (int y = 0; y < dims[1]; ++y) {  // VTK's images begin at the foot
    std::memcpy(
        raster.rgb.data() + 3 * static_cast<std::size_t>(dims[0]) * static_cast<std::size_t>(y),
        image->GetScalarPointer(0, dims[1] - 1 - y, 0), 3 * static_cast<std::size_t>(dims[0]));
  }
  return raster;
}

}  // namespace shape3d::apps
