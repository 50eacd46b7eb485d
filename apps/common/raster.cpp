#include "raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
#include <vtkUnsignedCharArray.h>

namespace shape3d::apps {
namespace {

std::array<std::uint8_t, 3> bytes_of(const Color& color) {
  std::array<std::uint8_t, 3> bytes{};
  for (std::size_t c = 0; c < 3; ++c)
    bytes[c] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(color[c], 0.0, 1.0)));
  return bytes;
}

std::size_t offset(const Raster& raster, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(raster.width) +
              static_cast<std::size_t>(x));
}

/// A new pixel of a row is Σ weights[i] · old pixel first + i.
struct Mixture {
  int first = 0;
  std::vector<double> weights;
};

std::vector<Mixture> mixtures(int from, int to) {
  // The weight of the old pixel at distance d of the new pixel's centre: a hat of half width 1,
  // or of a new pixel's width when that is larger.
  const double step = static_cast<double>(from) / to, reach = std::max(1.0, step);
  std::vector<Mixture> result;
  for (int i = 0; i < to; ++i) {
    const double centre = (i + 0.5) * step - 0.5;
    Mixture mixture;
    mixture.first = std::clamp(static_cast<int>(std::ceil(centre - reach + 1e-9)), 0, from - 1);
    double sum = 0.0;
    for (int k = mixture.first; k < from && (k < centre + reach || mixture.weights.empty()); ++k) {
      mixture.weights.push_back(std::max(1e-12, 1.0 - std::abs(k - centre) / reach));
      sum += mixture.weights.back();
    }
    for (double& weight : mixture.weights) weight /= sum;
    result.push_back(std::move(mixture));
  }
  return result;
}

constexpr int kDpi = 72;  // a point of a font is a pixel

void set_font(vtkTextProperty* font, int size, bool bold) {
  font->SetFontFamilyToArial();
  font->SetFontSize(std::max(1, static_cast<int>(std::lround(0.8 * size))));
  font->SetBold(bold ? 1 : 0);
  font->SetColor(1.0, 1.0, 1.0);
  font->SetBackgroundOpacity(0.0);
}

}  // namespace

Raster make_raster(int width, int height, const Color& color) {
  Raster raster{width, height, {}};
  raster.rgb.resize(offset(raster, 0, height));
  fill(raster, 0, 0, width, height, color);
  return raster;
}

void paste(Raster& target, const Raster& source, int x, int y) {
  const int left = std::max(0, x), right = std::min(target.width, x + source.width);
  if (left >= right) return;
  for (int row = std::max(0, y); row < std::min(target.height, y + source.height); ++row) {
    std::memcpy(target.rgb.data() + offset(target, left, row),
                source.rgb.data() + offset(source, left - x, row - y),
                3 * static_cast<std::size_t>(right - left));
  }
}

void fill(Raster& target, int x, int y, int width, int height, const Color& color) {
  const std::array<std::uint8_t, 3> bytes = bytes_of(color);
  for (int row = std::max(0, y); row < std::min(target.height, y + height); ++row) {
    for (int column = std::max(0, x); column < std::min(target.width, x + width); ++column)
      std::copy(bytes.begin(), bytes.end(), target.rgb.data() + offset(target, column, row));
  }
}

Raster resized(const Raster& source, int width, int height) {
  Raster result{width, height, {}};
  result.rgb.resize(offset(result, 0, height));
  for (int y = 0; y < height; ++y) {
    const auto from_y = static_cast<int>((y + 0.5) * source.height / height);
    for (int x = 0; x < width; ++x) {
      const auto from_x = static_cast<int>((x + 0.5) * source.width / width);
      std::memcpy(result.rgb.data() + offset(result, x, y),
                  source.rgb.data() + offset(source, from_x, from_y), 3);
    }
  }
  return result;
}

Raster resampled(const Raster& source, int width, int height) {
  const std::vector<Mixture> columns = mixtures(source.width, width);
  const std::vector<Mixture> rows = mixtures(source.height, height);
  Raster result{width, height, {}};
  result.rgb.reserve(offset(result, 0, height));
  for (const Mixture& row : rows) {
    for (const Mixture& column : columns) {
      std::array<double, 3> sum{};
      for (std::size_t y = 0; y < row.weights.size(); ++y) {
        for (std::size_t x = 0; x < column.weights.size(); ++x) {
          const std::uint8_t* pixel =
              source.rgb.data() +
              offset(source, column.first + static_cast<int>(x), row.first + static_cast<int>(y));
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += row.weights[y] * column.weights[x] * pixel[c];
        }
      }
      for (const double part : sum)
        result.rgb.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(part, 0.0, 255.0))));
    }
  }
  return result;
}

void draw_text(Raster& target, const std::string& text, int x, int y, int size, TextAlign align,
               const Color& color, bool bold) {
  if (text.empty()) return;
  vtkNew<vtkTextProperty> font;
  set_font(font, size, bold);
  vtkNew<vtkImageData> image;
  int dims[2] = {0, 0};
  vtkTextRenderer* renderer = vtkTextRenderer::GetInstance();
  if (renderer == nullptr || !renderer->RenderString(font, text, image, dims, kDpi)) return;
  int extent[6];
  image->GetExtent(extent);
  const int width = dims[0], height = dims[1];
  int bounding[4];
  renderer->GetBoundingBox(font, text, bounding, kDpi);
  const int left = align == TextAlign::left     ? x
                   : align == TextAlign::centre ? x - width / 2
                                                : x - width;
  const std::array<std::uint8_t, 3> ink = bytes_of(color);
  for (int row = 0; row < height; ++row) {  // from the foot
    const int to_y = y - (bounding[2] + row);
    if (to_y < 0 || to_y >= target.height) continue;
    for (int column = 0; column < width; ++column) {
      const int to_x = left + column;
      if (to_x < 0 || to_x >= target.width) continue;
      const auto* pixel = static_cast<const unsigned char*>(
          image->GetScalarPointer(extent[0] + column, extent[2] + row, extent[4]));
      std::uint8_t* out = target.rgb.data() + offset(target, to_x, to_y);
      for (std::size_t c = 0; c < 3; ++c)
        out[c] =
            static_cast<std::uint8_t>((out[c] * (255 - pixel[3]) + ink[c] * pixel[3] + 127) / 255);
    }
  }
}

int text_width(const std::string& text, int size, bool bold) {
  if (text.empty()) return 0;
  vtkNew<vtkTextProperty> font;
  set_font(font, size, bold);
  int box[4] = {0, 0, 0, 0};
  vtkTextRenderer* renderer = vtkTextRenderer::GetInstance();
  if (renderer == nullptr || !renderer->GetBoundingBox(font, text, box, kDpi)) return 0;
  return box[1] - box[0] + 1;
}

std::string to_png(const Raster& raster) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(raster.width, raster.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* to = static_cast<unsigned char*>(image->GetScalarPointer());
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(raster.width);
  for (int y = raster.height - 1; y >= 0; --y) {  // VTK's images begin at the foot
    std::memcpy(to, raster.rgb.data() + offset(raster, 0, y), row_bytes);
    to += row_bytes;
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)),
          static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

}  // namespace shape3d::apps
