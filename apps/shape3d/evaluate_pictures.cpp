#include <algorithm>
#include <cmath>
#include <numeric>

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

// The strongest methods last: their order in tables; at most as many as there are colors, those
// that combine descriptors first.
std::vector<const MethodResult*> drawn_methods(const GroupResult& group) {
  std::vector<const MethodResult*> methods;
  for (auto one = group.retrieval.rbegin(); one != group.retrieval.rend(); ++one) {
    if (methods.size() < kColors.size()) methods.push_back(&*one);
  }
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
    chart.legend = charts.empty() ? LegendPlace::top_right : LegendPlace::none;
    charts.push_back(std::move(chart));
  }
  return charts;
}

// Bars of each classifier, those of the groups side by side.
Chart rate_chart(const Evaluation& evaluation) {
  Chart chart;
  chart.title = "Correct classification rate";
  chart.y = share_axis("rate");
  const auto groups = static_cast<double>(evaluation.groups.size());
  for (std::size_t g = 0; g < evaluation.groups.size(); ++g) {
    const GroupResult& group = evaluation.groups[g];
    ChartSeries bars;
    bars.kind = ChartSeries::Kind::bars;
    bars.label = group.group.name;
    bars.color = kColors[g + 1];
    bars.bar_width = 0.8 / groups;
    for (std::size_t i = 0; i < group.classification.size(); ++i) {
      bars.points.push_back(
          {static_cast<double>(i) + (static_cast<double>(g) + 0.5) / groups * 0.8 - 0.4,
           group.classification[i].confusion.correct_rate()});
    }
    chart.series.push_back(std::move(bars));
  }
  const auto& classifiers = evaluation.groups.front().classification;
  chart.x.range = std::array<double, 2>{-0.6, static_cast<double>(classifiers.size()) - 0.4};
  for (std::size_t i = 0; i < classifiers.size(); ++i) {
    chart.x.ticks.emplace_back(static_cast<double>(i), std::to_string(i + 1));
  }
  chart.x.title = "as in the table";
  chart.legend = LegendPlace::top_left;
  return chart;
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
  page.width = 900;
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
    pictures.push_back({"correct-classification.png", draw_charts({rate_chart(evaluation)})});
    pictures.push_back(
        {"confusion.png",
         to_png(confusion_picture(evaluation.groups.front().classification.back(), evaluation))});
  }
  return pictures;
}

}  // namespace shape3d::apps
