#include "report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/output_file.hpp"
#include "common/text.hpp"

namespace shape3d::apps {
namespace {

template <class Number>
Json number_or_null(const std::optional<Number>& number) {
  return number ? Json(*number) : Json(nullptr);
}

Json to_json(const MeshComponent& component) {
  return {{"triangles", component.triangles},
          {"vertices", component.vertices},
          {"boundary_edges", component.boundary_edges},
          {"euler_characteristic", component.euler()},
          {"manifold", component.manifold},
          {"orientable", component.orientable},
          {"genus", number_or_null(component.genus())}};
}

std::string yes_or_no(bool value) { return value ? "yes" : "no"; }

std::string triple(const Eigen::Vector3d& v) {
  return rounded(v[0]) + " " + rounded(v[1]) + " " + rounded(v[2]);
}

// Eight heights of a bar in one character each, by the square root of the count, so that small bins
// show.
std::string bars(const std::vector<std::uint64_t>& histogram) {
  static constexpr const char* kBars[] = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const std::uint64_t most =
      histogram.empty() ? 0 : *std::max_element(histogram.begin(), histogram.end());
  std::string text;
  for (const std::uint64_t count : histogram) {
    const double height =
        most == 0 ? 0.0 : std::sqrt(static_cast<double>(count) / static_cast<double>(most));
    text += kBars[count == 0 ? 0 : std::max(1, static_cast<int>(std::lround(8 * height)))];
  }
  return text;
}

}  // namespace

Json report_head(const std::string& command) {
  return {{"program", "shape3d"}, {"version", SHAPE3D_VERSION}, {"command", command}};
}

Json to_json(const MeshCheck& check) {
  Json json = {{"vertices", check.vertices},
               {"triangles", check.triangles},
               {"edges", check.edges},
               {"components", check.components},
               {"boundary_edges", check.boundary_edges},
               {"odd_edges", check.odd_edges}};
  if (check.odd_interior_edges) json["odd_interior_edges"] = *check.odd_interior_edges;
  json["nonmanifold_edges"] = check.nonmanifold_edges;
  json["nonmanifold_vertices"] = check.nonmanifold_vertices;
  json["inconsistent_edges"] = check.inconsistent_edges;
  json["euler_characteristic"] = check.euler;
  json["genus"] = number_or_null(check.genus);
  json["closed"] = check.closed;
  json["oriented"] = check.oriented;
  json["degenerate_triangles"] = check.degenerate_triangles;
  json["zero_area_triangles"] = check.zero_area_triangles;
  json["duplicate_triangles"] = check.duplicate_triangles;
  json["unreferenced_vertices"] = check.unreferenced_vertices;
  json["coincident_vertices"] = check.coincident_vertices;
  json["area"] = check.area;
  json["volume"] = number_or_null(check.volume);
  json["largest_components"] = Json::array();
  for (const MeshComponent& component : check.largest)
    json["largest_components"].push_back(to_json(component));
  return json;
}

Json to_json(const VolumeDescription& volume) {
  const auto vector = [](const Eigen::Vector3d& v) { return Json::array({v[0], v[1], v[2]}); };
  return {{"format", volume.format},
          {"dims", volume.dims},
          {"type", zmc::to_string(volume.type)},
          {"spacing", vector(volume.spacing)},
          {"origin", vector(volume.origin)},
          {"direction_columns",
           Json::array({vector(volume.direction.col(0)), vector(volume.direction.col(1)),
                        vector(volume.direction.col(2))})},
          {"space", "LPS"},
          {"finite", volume.finite},
          {"non_finite", volume.non_finite},
          {"minimum", volume.minimum},
          {"maximum", volume.maximum},
          {"mean", volume.mean},
          {"histogram", volume.histogram},
          {"histogram_lower", volume.histogram_lower},
          {"histogram_width", volume.histogram_width}};
}

std::string line(const std::string& name, const std::string& value) {
  return name + std::string(name.size() < 24 ? 24 - name.size() : 1, ' ') + value + "\n";
}

std::string grouped(std::int64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t i = digits.size(); i > (number < 0 ? 4U : 3U);) {
    i -= 3;
    digits.insert(i, " ");
  }
  return digits;
}

std::string rounded(double number) {
  std::array<char, 64> text{};
  const double magnitude = std::abs(number);
  if (magnitude >= 1000.0 && magnitude < 1e15) {
    const double tenths = std::round(number * 10.0) / 10.0;
    std::snprintf(text.data(), text.size(), "%.1f", std::abs(tenths));
    const std::string fixed = text.data();
    const std::size_t point = fixed.find('.');
    return (number < 0 ? "-" : "") + grouped(std::stoll(fixed.substr(0, point))) +
           fixed.substr(point);
  }
  std::snprintf(text.data(), text.size(), "%.7g", number);
  return text.data();
}

std::string to_lines(const MeshCheck& check) {
  std::string text;
  const auto count = [&text](const char* name, std::int64_t number) {
    text += line(name, grouped(number));
  };
  count("vertices", check.vertices);
  count("triangles", check.triangles);
  count("components", check.components);
  text += line("closed", yes_or_no(check.closed));
  text += line("oriented", yes_or_no(check.oriented));
  count("boundary edges", check.boundary_edges);
  count("odd edges", check.odd_edges);
  if (check.odd_interior_edges) count("odd interior edges", *check.odd_interior_edges);
  count("non-manifold edges", check.nonmanifold_edges);
  count("non-manifold vertices", check.nonmanifold_vertices);
  count("inconsistent edges", check.inconsistent_edges);
  count("Euler characteristic", check.euler);
  text += line("genus", check.genus ? grouped(*check.genus) : "not defined");
  count("degenerate triangles", check.degenerate_triangles);
  count("zero-area triangles", check.zero_area_triangles);
  count("duplicate triangles", check.duplicate_triangles);
  count("unreferenced vertices", check.unreferenced_vertices);
  count("coincident vertices", check.coincident_vertices);
  text += line("area", rounded(check.area));
  text += line("volume", check.volume ? rounded(*check.volume)
                                      : "not defined (the mesh is not closed and oriented)");
  return text;
}

std::string to_lines(const VolumeDescription& volume) {
  std::string text = line("format", volume.format);
  text += line("samples", to_text(volume.dims) + " " + std::string(zmc::to_string(volume.type)));
  text += line("spacing", triple(volume.spacing) + " mm");
  text += line("origin", triple(volume.origin) + " (LPS)");
  for (int axis = 0; axis < 3; ++axis) {
    text += line(std::string("direction of ") + "xyz"[axis], triple(volume.direction.col(axis)));
  }
  if (volume.non_finite > 0)
    text += line("not finite", grouped(static_cast<std::int64_t>(volume.non_finite)));
  text += line("range", rounded(volume.minimum) + " … " + rounded(volume.maximum) + ", mean " +
                            rounded(volume.mean));
  if (!volume.histogram.empty()) {
    const double upper = volume.histogram_lower +
                         volume.histogram_width * static_cast<double>(volume.histogram.size());
    text += line("histogram", rounded(volume.histogram_lower) + " |" + bars(volume.histogram) +
                                  "| " + rounded(upper));
  }
  return text;
}

void write_json(const Settings& settings, const Json& report) {
  if (settings.json.empty()) return;
  OutputFile file(settings.json);
  file.write(report.dump(2) + "\n");
  file.commit();
}

}  // namespace shape3d::apps
