#include "offscreen.hpp"

#include <cstddef>
#include <cstdlib>
#include <utility>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkSMPTools.h>
#include <vtkWindowToImageFilter.h>

#include "private_display.hpp"

namespace shape3d::apps {
ChildResult draw_on(const std::string& display, const std::function<std::string()>& draw) {
  return run_in_child([&] {
    setenv("DISPLAY", display.c_str(), 1);
    vtkSMPTools::Initialize(1);
    vtkSMPTools::SetBackend("Sequential");
    return draw();
  });
}

std::string draw_offscreen(const std::function<std::string()>& draw, bool private_display) {
  if (const char* display = std::getenv("DISPLAY");
      display != nullptr && *display != '\0' && !private_display) {
    ChildResult result = draw_on(display, draw);
    if (result.ok) return std::move(result.output);
  }
  const PrivateDisplay display;
  ChildResult result = draw_on(display.name(), draw);
  if (!result.ok) throw PictureError("the picture could not be drawn: " + result.error);
  return std::move(result.output);
}

Raster raster_of(vtkRenderWindow* window, int samples) {
  vtkNew<vtkWindowToImageFilter> capture;
  capture->SetInput(window);
  capture->ReadFrontBufferOff();
  capture->SetInputBufferTypeToRGB();
  capture->Update();
  vtkImageData* large = capture->GetOutput();
  int dims[3];
  large->GetDimensions(dims);
  Raster small = make_raster(dims[0] / samples, dims[1] / samples, {1.0, 1.0, 1.0});
  const auto* from = static_cast<const unsigned char*>(large->GetScalarPointer());
  std::uint8_t* to = small.rgb.data();
  const int stride = 3 * dims[0];
  for (int y = small.height - 1; y >= 0; --y) {  // VTK's images begin at the foot
    for (int x = 0; x < 3 * small.width; ++x) {
      int sum = 0;
      for (int sy = 0; sy < samples; ++sy) {
        for (int sx = 0; sx < samples; ++sx) {
          sum += from[static_cast<std::ptrdiff_t>(samples * y + sy) * stride +
                      3 * (samples * (x / 3) + sx) + x % 3];
        }
      }
      *to++ = static_cast<std::uint8_t>((sum + samples * samples / 2) / (samples * samples));
    }
  }
  return small;
}

std::string png_of(vtkRenderWindow* window, int samples) {
  return to_png(raster_of(window, samples));
}

}  // namespace shape3d::apps
