#include "slice_picture.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkRect.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>
#include <shape3d/zmc/contour.hpp>

#include "offscreen.hpp"
#include "polylines.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

constexpr float kTitleHeight = 34.0F, kLegendHeight = 32.0F, kGap = 10.0F;

template <class T>
double sample_as(const zmc::VolumeView& view, std::int64_t element) {
  return static_cast<double>(static_cast<const T*>(view.data)[element]);
}

double sample(const zmc::VolumeView& view, const std::array<std::int64_t, 3>& p) {
  const std::array<std::int64_t, 3> strides = view.effective_strides();
  const std::int64_t element = p[0] * strides[0] + p[1] * strides[1] + p[2] * strides[2];
  switch (view.type) {
    case zmc::SampleType::int8:
      return sample_as<std::int8_t>(view, element);
    case zmc::SampleType::uint8:
      return sample_as<std::uint8_t>(view, element);
    case zmc::SampleType::int16:
      return sample_as<std::int16_t>(view, element);
    case zmc::SampleType::uint16:
      return sample_as<std::uint16_t>(view, element);
    case zmc::SampleType::int32:
      return sample_as<std::int32_t>(view, element);
    case zmc::SampleType::float32:
      return sample_as<float>(view, element);
    case zmc::SampleType::float64:
      return sample_as<double>(view, element);
  }
  return 0.0;
}

// Where a slice stands in the window: pixels from the lower left corner.
struct Frame {
  float x, y, width, height;
};

// The slice at the resolution of the window, with linear interpolation. Columns run right, rows up.
vtkSmartPointer<vtkImageData> grey_image(const SlicePanel& panel, const SlicePlane& plane,
                                         const Frame& frame) {
  const int width = std::max(2, static_cast<int>(frame.width)),
            height = std::max(2, static_cast<int>(frame.height));
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(width, height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto [across, down] = plane.size();
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Eigen::Vector3d place = plane.lattice(
          {(column + 0.5) / width * across, (1.0 - (row + 0.5) / height) * down}, panel.slice);
      std::array<std::int64_t, 3> base{};
      Eigen::Vector3d part = Eigen::Vector3d::Zero();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        base[axis] = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(place[a])), 0,
                                              panel.volume.dims[axis] - 2);
        part[a] = std::clamp(place[a] - static_cast<double>(base[axis]), 0.0, 1.0);
      }
      double value = 0.0;
      for (int corner = 0; corner < 8; ++corner) {
        double weight = 1.0;
        std::array<std::int64_t, 3> p = base;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const bool upper = (corner >> axis & 1) != 0;
          const double t = part[static_cast<Eigen::Index>(axis)];
          weight *= upper ? t : 1.0 - t;
          p[axis] += upper ? 1 : 0;
        }
        if (weight > 0.0) value += weight * sample(panel.volume, p);
      }
      const double grey = std::clamp((value - panel.black) / (panel.white - panel.black), 0.0, 1.0);
      auto* pixel = static_cast<unsigned char*>(image->GetScalarPointer(column, row, 0));
      std::fill(pixel, pixel + 3, static_cast<unsigned char>(std::lround(255.0 * grey)));
    }
  }
  return image;
}

// One panel as an item of VTK's 2D scene.
class SliceItem : public vtkContextItem {
 public:
  static SliceItem* New() {
    auto* item = new SliceItem;
    item->InitializeObjectBase();
    return item;
  }
  SliceItem(const SliceItem&) = delete;
  SliceItem& operator=(const SliceItem&) = delete;

  void set(const SlicePanel& panel, const Frame& cell) {
    panel_ = &panel;
    cell_ = cell;
    const SlicePlane plane(panel.volume, panel.axis);
    size_ = plane.size();
    const float free_width = cell.width - 2 * kGap,
                free_height = cell.height - kTitleHeight - kLegendHeight - kGap;
    scale_ = std::min(free_width / static_cast<float>(size_[0]),
                      free_height / static_cast<float>(size_[1]));
    frame_.width = scale_ * static_cast<float>(size_[0]);
    frame_.height = scale_ * static_cast<float>(size_[1]);
    frame_.x = cell.x + (cell.width - frame_.width) / 2;
    frame_.y = cell.y + kLegendHeight + (free_height - frame_.height) / 2;
    image_ = grey_image(panel, plane, frame_);
  }

  bool Paint(vtkContext2D* painter) override {
    painter->DrawImage(vtkRectf(frame_.x, frame_.y, frame_.width, frame_.height), image_);
    vtkTextProperty* text = painter->GetTextProp();
    text->SetColor(0.0, 0.0, 0.0);
    text->SetFontSize(20);
    text->SetJustificationToCentered();
    text->SetVerticalJustificationToCentered();
    painter->DrawString(cell_.x + cell_.width / 2, frame_.y + frame_.height + kTitleHeight / 2,
                        panel_->title.c_str());
    float legend = frame_.x;
    for (const SliceOutline& outline : panel_->outlines) {
      painter->GetPen()->SetColorF(outline.color[0], outline.color[1], outline.color[2]);
      painter->GetPen()->SetWidth(1.6F);
      painter->GetPen()->SetLineType(vtkPen::SOLID_LINE);
      for (const auto& line : outline.lines) draw(painter, line);
      if (outline.label.empty()) continue;
      painter->GetPen()->SetWidth(3.0F);
      const float y = frame_.y - kLegendHeight / 2;
      painter->DrawLine(legend, y, legend + 24.0F, y);
      text->SetFontSize(17);
      text->SetJustificationToLeft();
      painter->DrawString(legend + 30.0F, y, outline.label.c_str());
      float bounds[4];
      painter->ComputeStringBounds(outline.label.c_str(), bounds);
      legend += 30.0F + bounds[2] + 24.0F;
    }
    return true;
  }

 protected:
  SliceItem() = default;
  ~SliceItem() override = default;

 private:
  // Points nearer than a tenth of a pixel to the last one are left out, for they have no direction;
  // a loop that is smaller, round a single sample, is a dot, or nothing would be seen of it.
  void draw(vtkContext2D* painter, const std::vector<std::array<double, 2>>& line) const {
    constexpr float kLeast = 0.1F, kDot = 0.8F;
    std::vector<float> points;
    for (const auto& point : line) {
      const float x = frame_.x + scale_ * static_cast<float>(point[0]);
      const float y = frame_.y + frame_.height - scale_ * static_cast<float>(point[1]);
      const std::size_t size = points.size();
      if (size >= 2 && std::hypot(x - points[size - 2], y - points[size - 1]) < kLeast) continue;
      points.push_back(x);
      points.push_back(y);
    }
    if (points.size() > 2) {
      painter->DrawPoly(points.data(), static_cast<int>(points.size() / 2));
    } else if (line.size() > 1) {  // smaller than a pixel: a dot
      painter->DrawLine(points[0] - kDot, points[1], points[0] + kDot, points[1]);
    }
  }

  const SlicePanel* panel_ = nullptr;
  Frame cell_{}, frame_{};
  std::array<double, 2> size_{};
  float scale_ = 1.0F;
  vtkSmartPointer<vtkImageData> image_;
};

std::string draw(const std::vector<SlicePanel>& panels, const SlicePage& page) {
  const int columns = std::min(page.columns, static_cast<int>(panels.size()));
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  vtkNew<vtkContextView> view;
  view->GetRenderWindow()->SetOffScreenRendering(1);
  view->GetRenderWindow()->SetSize(columns * page.width, rows * page.height);
  view->GetRenderWindow()->SetMultiSamples(8);
  view->GetRenderer()->SetBackground(1, 1, 1);
  for (std::size_t n = 0; n < panels.size(); ++n) {
    const int column = static_cast<int>(n) % columns, row = static_cast<int>(n) / columns;
    vtkNew<SliceItem> item;
    item->set(panels[n], {static_cast<float>(column * page.width),
                          static_cast<float>((rows - 1 - row) * page.height),
                          static_cast<float>(page.width), static_cast<float>(page.height)});
    view->GetScene()->AddItem(item);
  }
  view->Render();
  return png_of(view->GetRenderWindow());
}

void require(bool condition, const std::string& sentence) {
  if (!condition) throw std::invalid_argument(sentence);
}

void validate(const std::vector<SlicePanel>& panels, const SlicePage& page) {
  require(!panels.empty(), "panels is empty; expected one or more");
  require(page.columns >= 1 && page.columns <= 16,
          "columns is " + std::to_string(page.columns) + "; expected 1 to 16");
  const auto rows = (static_cast<std::int64_t>(panels.size()) + page.columns - 1) / page.columns;
  for (const auto& [name, pixels, count] :
       {std::tuple{"width", page.width, std::int64_t{page.columns}},
        std::tuple{"height", page.height, rows}}) {
    require(pixels >= 128 && pixels <= 4096 && pixels * count <= 16384,
            std::string(name) + " is " + std::to_string(pixels) + " pixels for each of " +
                std::to_string(count) + " panels; expected 128 to 4096, and at most 16384 in all");
  }
  for (const SlicePanel& panel : panels) {
    zmc::validate(panel.volume);
    require(panel.axis >= 0 && panel.axis <= 2,
            "axis is " + std::to_string(panel.axis) + "; expected 0, 1 or 2");
    const std::int64_t slices = panel.volume.dims[static_cast<std::size_t>(panel.axis)];
    require(panel.slice >= 0 && panel.slice < slices, "slice is " + std::to_string(panel.slice) +
                                                          "; expected 0 to " +
                                                          std::to_string(slices - 1));
    require(panel.white > panel.black, "white is " + to_text(panel.white) +
                                           "; expected more than black, " + to_text(panel.black));
  }
}

}  // namespace

std::string draw_slices(const std::vector<SlicePanel>& panels, const SlicePage& page) {
  validate(panels, page);
  return draw_offscreen([&] { return draw(panels, page); }, page.private_display);
}

std::vector<std::vector<std::array<double, 2>>> outline_of(const zmc::VolumeView& whole,
                                                           const zmc::VolumeView& volume,
                                                           double isovalue, int axis,
                                                           std::int64_t slice) {
  const zmc::Contour contour = zmc::contour(volume, isovalue, axis, slice);
  const SlicePlane plane(whole, axis);
  std::vector<std::vector<std::array<double, 2>>> lines;
  for (const Polyline& line : join_edges(contour)) {
    std::vector<std::array<double, 2>> points;
    for (const std::int32_t v : line.vertices)
      points.push_back(plane.project(contour.V.row(v).transpose()));
    if (line.closed) points.push_back(points.front());
    lines.push_back(std::move(points));
  }
  return lines;
}

}  // namespace shape3d::apps
