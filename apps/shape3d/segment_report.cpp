#include <cmath>

#include "common/text.hpp"
#include "segment_result.hpp"

namespace shape3d::apps {
namespace {

Json optional_number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

std::string method_name(levelset::Method method) {
  switch (method) {
    case levelset::Method::combined:
      return "combined";
    case levelset::Method::intensity:
      return "intensity";
    case levelset::Method::gradient:
      return "gradient";
  }
  return {};
}

// "converged" of "converged: the front stands still": the name in the enumeration.
std::string status_name(levelset::Status status) {
  switch (status) {
    case levelset::Status::converged:
      return "converged";
    case levelset::Status::iteration_limit:
      return "iteration_limit";
    case levelset::Status::front_vanished:
      return "front_vanished";
    case levelset::Status::front_filled:
      return "front_filled";
    case levelset::Status::constant_image:
      return "constant_image";
    case levelset::Status::too_few_bins:
      return "too_few_bins";
    case levelset::Status::one_sided:
      return "one_sided";
    case levelset::Status::cancelled:
      return "cancelled";
  }
  return {};
}

Json json_of(const MaskSize& size) {
  return {{"samples", size.samples},
          {"volume", size.volume},
          {"equivalent_diameter", size.equivalent_diameter},
          {"axial_diameter", size.axial_diameter}};
}

Json model_json(const levelset::Segmentation& s) {
  Json classes = Json::array();
  const levelset::GaussianMixture& mixture = s.fit.mixture;
  for (int k = 0; k < mixture.size(); ++k) {
    classes.push_back(
        {{"weight", mixture.weights[k]},
         {"mean", mixture.means[k]},
         {"deviation", std::sqrt(mixture.variances[k])},
         {"inside", static_cast<bool>(s.model.inside()[static_cast<std::size_t>(k)])}});
  }
  return {{"classes", classes},
          {"stop", levelset::to_string(s.fit.stop)},
          {"iterations", s.fit.iterations},
          {"log_likelihood", s.fit.log_likelihood},
          {"misfit", s.fit.misfit},
          {"run", s.fit.run},
          {"run_misfits", s.fit.run_misfits},
          {"bic_by_classes", s.fit.bic_by_classes},
          {"padding", optional_number(s.histogram.padding)},
          {"padding_samples", s.histogram.padding_samples},
          {"noise", s.noise},
          {"smoothing", s.smoothing}};
}

Json calibration_json(const levelset::Calibration& calibration) {
  Json curve = Json::array();
  for (const levelset::OverlapSample& sample : calibration.curve) {
    curve.push_back({{"lambda", sample.lambda},
                     {"w", sample.w},
                     {"level", sample.level},
                     {"overlap", sample.overlap}});
  }
  return {{"w", calibration.w},
          {"lambda", calibration.lambda},
          {"levels", calibration.levels},
          {"scope", calibration.scope},
          {"scope_w", calibration.scope_w},
          {"curve", curve}};
}

Json evolution_json(const levelset::Evolution& evolution) {
  Json json = {{"iterations", evolution.iterations.size()}, {"band", evolution.band}};
  if (!evolution.iterations.empty()) {
    json["time"] = evolution.iterations.back().time;
    json["final_speed"] = evolution.iterations.back().speed;
  }
  json["inside"] = Json::array();
  for (const levelset::FrontStatistics& step : evolution.iterations)
    json["inside"].push_back(step.inside);
  return json;
}

std::string spans(const Region& region) {
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    text += (axis > 0 ? ", " : "") + std::string(1, "xyz"[axis]) + " " +
            std::to_string(region.lower[axis]) + " … " + std::to_string(region.upper[axis] - 1);
  }
  return text;
}

std::string or_none(const std::optional<double>& value, const std::string& unit) {
  return value ? rounded(*value) + unit : "not defined (one of the masks is empty)";
}

}  // namespace

Json to_json(const SegmentResult& result) {
  const SegmentArguments& arguments = *result.arguments;
  const levelset::Segmentation& s = result.segmentation;
  Json json = report_head("segment");
  json["input"] = {
      {"file", arguments.volume},
      {"format", result.format},
      {"dims", result.volume.dims},
      {"spacing", {result.volume.spacing[0], result.volume.spacing[1], result.volume.spacing[2]}}};
  json["roi"] = {{"lower", result.region.lower}, {"upper", result.region.upper}};
  json["options"] = {{"method", method_name(arguments.options.speed.method)},
                     {"calibrated", arguments.options.calibrated},
                     {"inside", arguments.inside},
                     {"classes", arguments.local_classes()   ? "at the seed"
                                 : arguments.classes.empty() ? "3"
                                                             : arguments.classes},
                     {"seed", arguments.options.mixture.seed},
                     {"curvature", arguments.options.evolution.curvature},
                     {"keep_connected", arguments.keep_connected},
                     {"nodule", arguments.nodule}};
  json["status"] = status_name(s.status);
  json["model"] = model_json(s);
  json["calibration"] = calibration_json(s.calibration);
  json["evolution"] = evolution_json(s.evolution);
  json["output"] = arguments.output;
  json["segmentation"] = json_of(result.size);
  json["segmentation"]["components"] = result.components;
  if (result.nodule) {
    json["nodule"] = {{"inscribed_radius", result.nodule->inscribed_radius},
                      {"vessel_radius", result.nodule->vessel_radius},
                      {"wall_radius", result.nodule->wall_radius}};
  }
  if (result.agreement) {
    json["truth"] = json_of(result.truth_size);
    json["truth"]["file"] = arguments.truth;
    json["truth"]["samples_outside_roi"] = result.truth_outside;
    json["agreement"] = {{"dice", result.agreement->dice},
                         {"hausdorff95", optional_number(result.agreement->hausdorff95)},
                         {"hausdorff", optional_number(result.agreement->hausdorff)},
                         {"mean_distance", optional_number(result.agreement->mean_distance)}};
  }
  if (!arguments.mesh.empty()) {
    json["mesh"] = {{"file", arguments.mesh},
                    {"space", "LPS"},
                    {"vertices", result.mesh_vertices},
                    {"triangles", result.mesh_triangles}};
  }
  json["warnings"] = result.warnings;
  json["seconds"] = {
      {"histogram", s.timings.histogram},     {"mixture", s.timings.mixture},
      {"smoothing", s.timings.smoothing},     {"gradient", s.timings.gradient},
      {"calibration", s.timings.calibration}, {"speed", s.timings.speed},
      {"evolution", s.timings.evolution},     {"estimation", s.timings.estimation()}};
  return json;
}

std::string to_lines(const SegmentResult& result) {
  const levelset::Segmentation& s = result.segmentation;
  std::string text =
      line("volume", result.arguments->volume) + line("region", spans(result.region));
  const levelset::GaussianMixture& mixture = s.fit.mixture;
  for (int k = 0; k < mixture.size(); ++k) {
    const bool inside = s.model.inside()[static_cast<std::size_t>(k)];
    text +=
        line("class " + std::to_string(k),
             rounded(mixture.means[k]) + " ± " + rounded(std::sqrt(mixture.variances[k])) + ", " +
                 rounded(100.0 * mixture.weights[k]) + " %, " + (inside ? "inside" : "outside"));
  }
  for (const double level : s.calibration.levels) text += line("calibrated level", rounded(level));
  text += line("status", std::string(levelset::to_string(s.status)));
  text += line("iterations", std::to_string(s.evolution.iterations.size()));
  text += line("estimation", rounded(s.timings.estimation()) + " s");
  text += line("evolution", rounded(s.timings.evolution) + " s");
  text += line("samples inside", grouped(result.size.samples));
  text += line("components", grouped(result.components));
  text += line("volume inside", rounded(result.size.volume) + " mm³");
  text += line("diameter, equivalent", rounded(result.size.equivalent_diameter) + " mm");
  text += line("diameter, axial", rounded(result.size.axial_diameter) + " mm");
  if (result.agreement) {
    text += line("truth", result.arguments->truth);
    text += line("volume of the truth", rounded(result.truth_size.volume) + " mm³");
    text += line("Dice", rounded(result.agreement->dice));
    text += line("Hausdorff 95 %", or_none(result.agreement->hausdorff95, " mm"));
    text += line("mean distance", or_none(result.agreement->mean_distance, " mm"));
  }
  return text + line("output", result.arguments->output);
}

}  // namespace shape3d::apps
