// How much a segmentation depends on the seed of a badly estimated intensity model, with and
// without calibration: shape3d_segmentation_stability --help.
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <shape3d/levelset/segment.hpp>

#include "common/chart.hpp"
#include "common/output_file.hpp"
#include "common/volume_io.hpp"

namespace {
using namespace shape3d;

struct Series {
  std::vector<double> volumes, levels;  // ml; intensity

  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (const double v : volumes) sum += v;
    return sum / static_cast<double>(volumes.size());
  }
  [[nodiscard]] double deviation() const {
    double sum = 0.0;
    for (const double v : volumes) sum += (v - mean()) * (v - mean());
    return std::sqrt(sum / static_cast<double>(volumes.size() - 1));
  }
  [[nodiscard]] double range() const {
    const auto [least, most] = std::minmax_element(volumes.begin(), volumes.end());
    return *most - *least;
  }
};

// One segmentation; its row is told at once, for a series takes minutes.
void add(const levelset::ImageView& image, levelset::SegmentOptions options, bool calibrated,
         int seed, Series& series) {
  options.calibrated = calibrated;
  options.mixture.seed = static_cast<std::uint64_t>(seed);
  const levelset::Segmentation s = levelset::segment(image, options);
  series.volumes.push_back(s.volume / 1000.0);
  const std::vector<double> levels = calibrated ? s.calibration.levels : s.model.levels(0.0);
  series.levels.push_back(levels.empty() ? std::nan("") : levels.front());
  std::cerr << (calibrated ? "calibrated" : "as estimated") << ", seed " << seed << ": "
            << series.volumes.back() << " ml, level " << series.levels.back() << ", "
            << levelset::to_string(s.status) << std::endl;
}

apps::ChartSeries points(const std::string& label, const std::vector<double>& values,
                         const apps::Color& color, apps::ChartSeries::Marker marker) {
  apps::ChartSeries series;
  series.label = label;
  series.kind = apps::ChartSeries::Kind::points;
  series.color = color;
  series.marker = marker;
  for (std::size_t n = 0; n < values.size(); ++n)
    series.points.push_back({static_cast<double>(n + 1), values[n]});
  return series;
}

apps::ChartBand band(const Series& series, const apps::Color& color) {
  apps::ChartBand band;
  const double low = series.mean() - series.deviation(), high = series.mean() + series.deviation();
  band.points = {{0.0, low, high}, {static_cast<double>(series.volumes.size()) + 1.0, low, high}};
  band.color = color;
  band.opacity = 0.25;
  return band;
}

// Ends of an axis with room for the legend above all points.
std::array<double, 2> range_of(const std::vector<double>& a, const std::vector<double>& b) {
  double least = a.front(), most = a.front();
  for (const auto* values : {&a, &b}) {
    for (const double value : *values) {
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
  const double room = most > least ? most - least : 1.0;
  return {least - 0.1 * room, most + 0.4 * room};
}

std::string draw(const Series& with, const Series& without, const std::string& title) {
  const apps::Color blue{0.1, 0.35, 0.8}, orange{0.85, 0.45, 0.1};
  apps::Chart volumes;
  volumes.title = title;
  volumes.x.title = "seed";
  volumes.y.title = "volume inside, ml";
  volumes.x.range = {{0.0, static_cast<double>(with.volumes.size()) + 1.0}};
  volumes.y.range = range_of(with.volumes, without.volumes);
  volumes.bands = {band(without, orange), band(with, blue)};
  volumes.series = {points("as estimated (band: ± a deviation)", without.volumes, orange,
                           apps::ChartSeries::Marker::square),
                    points("calibrated", with.volumes, blue, apps::ChartSeries::Marker::circle)};
  apps::Chart levels = volumes;
  levels.title.clear();
  levels.bands.clear();
  levels.y.range = range_of(with.levels, without.levels);
  levels.y.title = "intensity of the boundary, HU";
  levels.series[0] =
      points("as estimated", without.levels, orange, apps::ChartSeries::Marker::square);
  levels.series[1] = points("calibrated", with.levels, blue, apps::ChartSeries::Marker::circle);
  apps::ChartPage page;
  page.height = 480;
  return apps::draw_charts({volumes, levels}, page);
}

nlohmann::ordered_json to_json(const Series& series) {
  return {{"mean", series.mean()},
          {"deviation", series.deviation()},
          {"range", series.range()},
          {"volumes", series.volumes},
          {"levels", series.levels}};
}

Series series_of(const nlohmann::ordered_json& json) {
  return {json.at("volumes").get<std::vector<double>>(),
          json.at("levels").get<std::vector<double>>()};
}

void write_picture(const std::string& path, const std::string& png) {
  apps::OutputFile file(path);
  file.write(png);
  file.commit();
}

int run(int argc, char** argv) {
  CLI::App program(
      "Segments a volume of int16 samples with many seeds and few iterations of stochastic EM.");
  std::string path, picture, report, title = "Volume by seed";
  std::vector<std::int64_t> roi;
  int seeds = 20, classes = 3, chain = 3, iterations = levelset::EvolveOptions{}.max_iterations;
  CLI::Option* volume_option = program.add_option("VOLUME", path);
  program
      .add_option("--report", report,
                  "Draw --picture from the standard output of an earlier run, and end")
      ->excludes(volume_option);
  program.add_option("--roi", roi, "x0,x1,y0,y1,z0,z1")->delimiter(',')->expected(6);
  program.add_option("--seeds", seeds)->check(CLI::Range(2, 1000));
  program.add_option("--classes", classes)->check(CLI::Range(2, 8));
  program.add_option("--chain", chain, "Iterations of stochastic EM")->check(CLI::Range(2, 1000));
  program.add_option("--iterations", iterations, "Limit of steps of the evolution")
      ->check(CLI::Range(1, 1000000));
  program.add_option("--picture", picture, "The chart (.png)");
  program.add_option("--title", title);
  CLI11_PARSE(program, argc, argv);
  if (!report.empty()) {
    std::ifstream file(report);
    const auto json = nlohmann::ordered_json::parse(file);
    write_picture(picture,
                  draw(series_of(json.at("calibrated")), series_of(json.at("estimated")), title));
    return 0;
  }
  const apps::Volume volume = apps::read_volume(path);
  if (volume.view.type != zmc::SampleType::int16)
    throw std::invalid_argument(path + ": expected int16 samples");
  levelset::ImageView image = levelset::make_view(
      static_cast<const std::int16_t*>(volume.view.data), volume.view.dims, volume.view.spacing);
  if (!roi.empty())
    image = levelset::subvolume(image, {{roi[0], roi[2], roi[4]}, {roi[1], roi[3], roi[5]}});
  levelset::SegmentOptions options;
  options.mixture.classes = classes;
  options.mixture.chain = chain;
  options.mixture.runs = 1;
  options.evolution.max_iterations = iterations;
  Series without, with;
  for (int seed = 1; seed <= seeds; ++seed) {
    add(image, options, false, seed, without);
    add(image, options, true, seed, with);
  }
  if (!picture.empty()) write_picture(picture, draw(with, without, title));
  std::cout << nlohmann::ordered_json{{"seeds", seeds},
                                      {"classes", classes},
                                      {"chain", chain},
                                      {"iterations", iterations},
                                      {"calibrated", to_json(with)},
                                      {"estimated", to_json(without)}}
                   .dump(2)
            << '\n';
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "shape3d_segmentation_stability: " << error.what() << '\n';
    return 1;
  }
}
