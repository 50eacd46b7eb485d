#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/chart.hpp"
#include "evaluate_report.hpp"

namespace shape3d::apps {
namespace {

constexpr std::array<Color, 10> kColors{{{0.85, 0.15, 0.15},
                                         {0.10, 0.35, 0.75},
                                         {0.10, 0.55, 0.25},
                                         {0.85, 0.50, 0.10},
                                         {0.50, 0.20, 0.65},
                                         {0.10, 0.60, 0.65},
                                         {0.60, 0.40, 0.20},
                                         {0.90, 0.35, 0.65},
                                         {0.35, 0.35, 0.35},
                                         {0.60, 0.65, 0.15}}};
constexpr std::size_t kMostClassCharts = 12;
constexpr double kLegendEnd = 1.65;

ChartAxis share_axis(const std::string& title) {
  ChartAxis axis;
  axis.title = title;
  axis.range = std::array<double, 2>{0.0, 1.0};
  for (int tenth = 0; tenth <= 10; tenth += 2) {
    axis.ticks.emplace_back(tenth / 10.0, tenth == 0    ? "0"
                                          : tenth == 10 ? "1"
                                                        : "0." + std::to_string(tenth));
  }
  return axis;
}

// At most as many as there are colors: the last method, the last that is not weighted by classes,
// the baselines, and others from the end of the table.
std::vector<const MethodResult*> drawn_methods(const GroupResult& group) {
  std::vector<const MethodResult*> methods;
  const auto take = [&](const MethodResult& one) {
    if (methods.size() < kColors.size() &&
        std::find(methods.begin(), methods.end(), &one) == methods.end()) {
      methods.push_back(&one);
    }
  };
  const auto& all = group.retrieval;
  take(all.back());
  const auto unweighted = std::find_if(all.rbegin(), all.rend(), [](const MethodResult& one) {
    return !one.method->descriptor && one.method->name.find("weighted") == std::string::npos;
  });
  if (unweighted != all.rend()) take(*unweighted);
  for (const MethodResult& one : all) {
    if (one.method->baseline) take(one);
  }
  std::for_each(all.rbegin(), all.rend(), take);
  return methods;
}

ChartSeries curve(const std::string& name, const learning::RetrievalMeans& means, std::size_t place,
                  bool is_baseline) {
  ChartSeries series;
  series.label = name;
  series.color = kColors[place % kColors.size()];
  series.pattern = is_baseline ? ChartSeries::Pattern::dashed : ChartSeries::Pattern::solid;
  for (std::size_t k = 0; k < learning::kRecallSteps; ++k) {
    series.points.push_back(
        {static_cast<double>(k + 1) / learning::kRecallSteps, means.precision[k]});
  }
  return series;
}

Chart curves_chart(const GroupResult& group, const std::string& title) {
  Chart chart;
  chart.title = title;
  chart.x = share_axis("recall");
  chart.x.range = std::array<double, 2>{0.0, kLegendEnd};  // the legend stands beside the curves
  chart.y = share_axis("precision");
  const auto methods = drawn_methods(group);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    chart.series.push_back(curve(methods[i]->method->name, methods[i]->retrieval.micro, i,
                                 methods[i]->method->baseline));
  }
  return chart;
}

// One chart for each of the largest classes.
std::vector<Chart> class_charts(const GroupResult& group, const Evaluation& evaluation) {
  const auto& classes = group.retrieval.front().retrieval.classes;
  std::vector<std::size_t> places;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    if (classes[c].queries > 0) places.push_back(c);
  }
  std::stable_sort(places.begin(), places.end(), [&](std::size_t a, std::size_t b) {
    return classes[a].queries > classes[b].queries;
  });
  if (places.size() > kMostClassCharts) places.resize(kMostClassCharts);
  std::sort(places.begin(), places.end());
  const auto methods = drawn_methods(group);
  std::vector<Chart> charts;
  for (const std::size_t c : places) {
    Chart chart;
    chart.title = evaluation.set->test.classes[c] + " (" + std::to_string(classes[c].queries) + ")";
    chart.x = share_axis("recall");
    chart.y = share_axis("precision");
    for (std::size_t i = 0; i < methods.size(); ++i) {
      chart.series.push_back(curve(methods[i]->method->name, methods[i]->retrieval.classes[c], i,
                                   methods[i]->method->baseline));
    }
    chart.legend = LegendPlace::none;
    charts.push_back(std::move(chart));
  }
  if (charts.empty()) return charts;
  Chart legend = charts.front();  // what the colors are, without the curves
  legend.title = "methods";
  legend.legend = LegendPlace::top_left;
  for (ChartSeries& series : legend.series) series.points.clear();
  charts.push_back(std::move(legend));
  return charts;
}

// Bars of each classifier from the left, those of the groups below each other.
Raster rate_picture(const Evaluation& evaluation) {
  constexpr int kText = 18, kBar = 18, kGap = 14, kHead = 90, kScale = 600;
  const auto& classifiers = evaluation.groups.front().classification;
  const auto groups = static_cast<int>(evaluation.groups.size());
  int label = 0;
  for (const ClassifierResult& one : classifiers) {
    label = std::max(label, text_width(one.result.name, kText));
  }
  label += 30;
  const int row = groups * kBar + kGap, rows = static_cast<int>(classifiers.size());
  Raster raster = make_raster(label + kScale + 90, kHead + rows * row + 50, {1.0, 1.0, 1.0});
  draw_text(raster, "Correct classification rate, percent", raster.width / 2, 32, 22,
            TextAlign::centre, {0, 0, 0}, true);
  int legend = label;
  for (int g = 0; g < groups; ++g) {
    const std::string& name = evaluation.groups[static_cast<std::size_t>(g)].group.name;
    fill(raster, legend, kHead - 34, 14, 14, kColors[static_cast<std::size_t>(g) + 1]);
    draw_text(raster, name, legend + 22, kHead - 21, 16, TextAlign::left);
    legend += 60 + text_width(name, 16);
  }
  for (int tenth = 0; tenth <= 10; tenth += 2) {
    const int x = label + kScale * tenth / 10;
    fill(raster, x, kHead - 6, 1, rows * row + 10, {0.8, 0.8, 0.8});
    draw_text(raster, std::to_string(10 * tenth), x, kHead + rows * row + 26, 16,
              TextAlign::centre);
  }
  for (int i = 0; i < rows; ++i) {
    const int top = kHead + i * row;
    draw_text(raster, classifiers[static_cast<std::size_t>(i)].result.name, label - 12,
              top + groups * kBar / 2 + kText / 3, kText, TextAlign::right);
    for (int g = 0; g < groups; ++g) {
      const double rate = evaluation.groups[static_cast<std::size_t>(g)]
                              .classification[static_cast<std::size_t>(i)]
                              .confusion.correct_rate();
      const int width = static_cast<int>(std::lround(rate * kScale));
      fill(raster, label, top + g * kBar, std::max(width, 1), kBar - 2,
           kColors[static_cast<std::size_t>(g) + 1]);
      std::array<char, 16> number{};
      std::snprintf(number.data(), number.size(), "%.1f", 100.0 * rate);
      draw_text(raster, number.data(), label + width + 8, top + g * kBar + 14, 15, TextAlign::left);
    }
  }
  return raster;
}

Raster confusion_picture(const ClassifierResult& one, const Evaluation& evaluation) {
  const Eigen::MatrixXi& counts = one.confusion.counts;
  std::vector<Eigen::Index> shown;
  for (Eigen::Index c = 0; c < counts.rows(); ++c) {
    if (counts.row(c).sum() + counts.col(c).sum() > 0) shown.push_back(c);
  }
  const auto n = static_cast<int>(shown.size());
  const int cell = std::clamp(900 / std::max(n, 1), 8, 90);
  const bool has_numbers = cell >= 28;
  const int text = std::clamp(cell / 3, 8, 20);
  int label = 0;
  for (const Eigen::Index c : shown) {
    label = std::max(label, text_width(evaluation.class_names[static_cast<std::size_t>(c)], text));
  }
  label += 24;
  const int head = 70;
  Raster raster = make_raster(label + n * cell + 30, head + n * cell + 60, {1.0, 1.0, 1.0});
  draw_text(raster, "Confusions, trained on " + one.result.name, raster.width / 2, 28, 22,
            TextAlign::centre, {0, 0, 0}, true);
  draw_text(raster, "predicted class, in the order of the rows", label + n * cell / 2, head - 12,
            16, TextAlign::centre);
  for (int row = 0; row < n; ++row) {
    const int sum = std::max(1, counts.row(shown[static_cast<std::size_t>(row)]).sum());
    draw_text(
        raster,
        evaluation.class_names[static_cast<std::size_t>(shown[static_cast<std::size_t>(row)])],
        label - 10, head + row * cell + cell / 2 + text / 3, text, TextAlign::right);
    for (int c = 0; c < n; ++c) {
      const int count =
          counts(shown[static_cast<std::size_t>(row)], shown[static_cast<std::size_t>(c)]);
      const double share = static_cast<double>(count) / sum;
      const Color color{1.0 - 0.9 * share, 1.0 - 0.65 * share, 1.0 - 0.25 * share};
      fill(raster, label + c * cell, head + row * cell, cell - 1, cell - 1, color);
      if (has_numbers && count > 0) {
        draw_text(raster, std::to_string(count), label + c * cell + cell / 2,
                  head + row * cell + cell / 2 + text / 3, text, TextAlign::centre,
                  share > 0.5 ? Color{1, 1, 1} : Color{0, 0, 0});
      }
    }
  }
  draw_text(raster, "A row is a true class; its color is the share of the class.",
            label + n * cell / 2, head + n * cell + 32, 16, TextAlign::centre);
  return raster;
}

}  // namespace

std::vector<NamedPicture> draw_evaluation(const Evaluation& evaluation) {
  std::vector<NamedPicture> pictures;
  std::vector<Chart> charts;
  for (const GroupResult& group : evaluation.groups) {
    charts.push_back(curves_chart(group, "Precision and recall, " + group.group.name));
  }
  ChartPage page;
  page.width = 1100;
  page.columns = static_cast<int>(charts.size());
  pictures.push_back({"precision-recall.png", draw_charts(charts, page)});
  const std::vector<Chart> classes = class_charts(evaluation.groups.front(), evaluation);
  if (!classes.empty()) {
    page.width = 620;
    page.height = 480;
    page.columns = std::min<int>(3, static_cast<int>(classes.size()));
    pictures.push_back({"precision-recall-classes.png", draw_charts(classes, page)});
  }
  if (!evaluation.groups.front().classification.empty()) {
    pictures.push_back({"correct-classification.png", to_png(rate_picture(evaluation))});
    pictures.push_back(
        {"confusion.png",
         to_png(confusion_picture(evaluation.groups.front().classification.back(), evaluation))});
  }
  return pictures;
}

}  // namespace shape3d::apps
