#include "offscreen.hpp"

#include <cstddef>
#include <cstdlib>
#include <utility>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include "child_process.hpp"
#include "private_display.hpp"

namespace shape3d::apps {
namespace {

ChildResult draw_on(const std::string& display, const std::function<std::string()>& draw) {
  return run_in_child([&] {
    setenv("DISPLAY", display.c_str(), 1);
    vtkSMPTools::Initialize(1);
    vtkSMPTools::SetBackend("Sequential");
    return draw();
  });
}

// Mean of samples × samples pixels.
vtkSmartPointer<vtkImageData> shrink(vtkImageData* large, int samples) {
  int dims[3];
  large->GetDimensions(dims);
  const int width = dims[0] / samples, height = dims[1] / samples;
  auto small = vtkSmartPointer<vtkImageData>::New();
  small->SetDimensions(width, height, 1);
  small->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto* from = static_cast<const unsigned char*>(large->GetScalarPointer());
  auto* to = static_cast<unsigned char*>(small->GetScalarPointer());
  const int stride = 3 * dims[0];
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < 3 * width; ++x) {
      int sum = 0;
      for (int sy = 0; sy < samples; ++sy) {
        for (int sx = 0; sx < samples; ++sx) {
          sum += from[static_cast<std::ptrdiff_t>(samples * y + sy) * stride +
                      3 * (samples * (x / 3) + sx) + x % 3];
        }
      }
      *to++ = static_cast<unsigned char>((sum + samples * samples / 2) / (samples * samples));
    }
  }
  return small;
}

}  // namespace

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

std::string png_of(vtkRenderWindow* window, int samples) {
  vtkNew<vtkWindowToImageFilter> capture;
  capture->SetInput(window);
  capture->ReadFrontBufferOff();
  capture->SetInputBufferTypeToRGB();
  capture->Update();
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(shrink(capture->GetOutput(), samples));
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)),
          static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

}  // namespace shape3d::apps
