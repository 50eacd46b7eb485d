#include "chart_widget.hpp"

#include <QVTKOpenGLNativeWidget.h>
#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>
#include <QTimer>
#include <QVBoxLayout>

namespace shape3d::apps::viewer {

struct ChartWidget::Parts {
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  vtkNew<vtkContextView> view;
  QVTKOpenGLNativeWidget* gl = nullptr;
};

ChartWidget::ChartWidget(QWidget* parent)
    : QWidget(parent), parts_(std::make_unique<Parts>()), theme_(make_theme(true)) {
  parts_->gl = new QVTKOpenGLNativeWidget(this);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(parts_->gl);
  parts_->gl->setRenderWindow(parts_->window);
  parts_->gl->setEnableHiDPI(true);
  parts_->view->SetRenderWindow(parts_->window);
  parts_->view->SetInteractor(parts_->window->GetInteractor());
  clear();
}

ChartWidget::~ChartWidget() = default;

void ChartWidget::clear() {
  chart_ = {};
  chart_.legend = LegendPlace::none;
  draw();
}

void ChartWidget::set_chart(const Chart& chart) {
  chart_ = chart;
  draw();
}

void ChartWidget::set_theme(const Theme& theme) {
  theme_ = theme;
  draw();
}

void ChartWidget::showEvent(QShowEvent* /*event*/) {
  QTimer::singleShot(0, this, [this] { parts_->window->Render(); });
}

void ChartWidget::draw() {
  parts_->view->GetRenderer()->SetBackground(theme_.field.redF(), theme_.field.greenF(),
                                             theme_.field.blueF());
  parts_->view->GetScene()->ClearItems();
  if (!chart_.series.empty()) {
    vtkNew<vtkChartXY> view;
    fill_chart(view, chart_, 0.6);
    const auto paint = [](vtkTextProperty* text, const QColor& color) {
      text->SetColor(color.redF(), color.greenF(), color.blueF());
    };
    paint(view->GetTitleProperties(), theme_.text);
    for (const int side : {vtkAxis::BOTTOM, vtkAxis::LEFT}) {
      vtkAxis* axis = view->GetAxis(side);
      paint(axis->GetTitleProperties(), theme_.text);
      paint(axis->GetLabelProperties(), theme_.text);
      const QColor grid = theme_.dark ? theme_.field.lighter(160) : QColor(230, 230, 230);
      axis->GetGridPen()->SetColorF(grid.redF(), grid.greenF(), grid.blueF());
      axis->GetPen()->SetColorF(theme_.faint_text.redF(), theme_.faint_text.greenF(),
                                theme_.faint_text.blueF());
    }
    vtkChartLegend* legend = view->GetLegend();
    paint(legend->GetLabelProperties(), theme_.text);
    legend->GetBrush()->SetColorF(theme_.panel.redF(), theme_.panel.greenF(), theme_.panel.blueF(),
                                  0.8);
    legend->GetPen()->SetOpacityF(0.0);
    parts_->view->GetScene()->AddItem(view);
  }
  if (isVisible()) parts_->window->Render();
}

}  // namespace shape3d::apps::viewer
