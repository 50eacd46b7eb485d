#include "mapping_report.hpp"

namespace shape3d::apps {

Json to_json(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    Json row = Json::array();
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json to_json(const mapping::Inspection& inspection) {
  Json findings = Json::array();
  for (const mapping::Finding& finding : inspection.findings) {
    findings.push_back({{"defect", to_string(finding.defect)},
                        {"count", finding.count},
                        {"blocking", finding.blocking},
                        {"sentence", to_sentence(finding, kRepairOption, kWrapOption)}});
  }
  return {{"vertices", inspection.vertices},
          {"triangles", inspection.triangles},
          {"edges", inspection.edges},
          {"components", inspection.components},
          {"boundary_loops", inspection.boundary_loops},
          {"boundary_edges", inspection.boundary_edges},
          {"nonmanifold_edges", inspection.nonmanifold_edges},
          {"nonmanifold_vertices", inspection.nonmanifold_vertices},
          {"misoriented_edges", inspection.misoriented_edges},
          {"orientable", inspection.orientable},
          {"euler_characteristic", inspection.euler},
          {"genus", inspection.genus ? Json(*inspection.genus) : Json(nullptr)},
          {"isolated_vertices", inspection.isolated_vertices},
          {"degenerate_triangles", inspection.degenerate_triangles},
          {"duplicate_triangles", inspection.duplicate_triangles},
          {"zero_area_triangles", inspection.zero_area_triangles},
          {"area", inspection.area},
          {"volume", inspection.volume ? Json(*inspection.volume) : Json(nullptr)},
          {"self_intersections",
           inspection.self_intersections ? Json(*inspection.self_intersections) : Json(nullptr)},
          {"spherical", inspection.spherical()},
          {"findings", std::move(findings)}};
}

Json to_json(const mapping::RepairSummary& summary) {
  return {{"merged_vertices", summary.merged_vertices},
          {"removed_vertices", summary.removed_vertices},
          {"removed_degenerate", summary.removed_degenerate},
          {"removed_duplicates", summary.removed_duplicates},
          {"separated_vertices", summary.separated_vertices},
          {"turned_triangles", summary.turned_triangles},
          {"removed_components", summary.removed_components},
          {"removed_component_triangles", summary.removed_component_triangles},
          {"filled_holes", summary.filled_holes},
          {"unfilled_holes", summary.unfilled_holes},
          {"filling_triangles", summary.filling_triangles},
          {"turned_inside_out", summary.turned_inside_out}};
}

Json to_json(const mapping::Wrapped& wrapped) {
  Json attempts = Json::array();
  for (const mapping::WrapAttempt& attempt : wrapped.attempts) {
    attempts.push_back({{"alpha", attempt.alpha},
                        {"triangles", attempt.triangles},
                        {"components", attempt.components},
                        {"euler_characteristic", attempt.euler}});
  }
  return {{"status", to_string(wrapped.status)},
          {"alpha", wrapped.alpha},
          {"offset", wrapped.offset},
          {"vertices", wrapped.V.rows()},
          {"triangles", wrapped.F.rows()},
          {"attempts", std::move(attempts)}};
}

Json to_json(const mapping::Pose& pose) {
  return {
      {"centroid", Json::array({pose.centroid[0], pose.centroid[1], pose.centroid[2]})},
      {"rotation_rows", to_json(pose.rotation)},
      {"scale", pose.scale},
      {"area", pose.area},
      {"eigenvalues", Json::array({pose.eigenvalues[0], pose.eigenvalues[1], pose.eigenvalues[2]})},
      {"gaps", Json::array({pose.gaps[0], pose.gaps[1]})},
      {"skew", Json::array({pose.skew[0], pose.skew[1], pose.skew[2]})},
      {"reversed_axis",
       pose.reversed_axis < 0 ? Json(nullptr) : Json(std::string(1, "xyz"[pose.reversed_axis]))},
      {"sign_margin", pose.sign_margin},
      {"ambiguous", pose.ambiguous}};
}

std::string to_lines(const mapping::Pose& pose) {
  const auto three = [](const Eigen::Vector3d& v) {
    return rounded(v[0]) + " " + rounded(v[1]) + " " + rounded(v[2]);
  };
  std::string text = line("centroid", three(pose.centroid)) + line("scale", rounded(pose.scale)) +
                     line("area", rounded(pose.area)) +
                     line("eigenvalues", three(pose.eigenvalues));
  for (int axis = 0; axis < 3; ++axis)
    text += line(std::string("axis ") + "xyz"[axis], three(pose.rotation.row(axis).transpose()));
  text += line("eigenvalue gaps", rounded(pose.gaps[0]) + " " + rounded(pose.gaps[1]));
  text += line("skew", three(pose.skew));
  text += line("sign margin", rounded(pose.sign_margin));
  text += line("reversed axis",
               pose.reversed_axis < 0 ? "none" : std::string(1, "xyz"[pose.reversed_axis]));
  return text + line("ambiguous", pose.ambiguous ? "yes" : "no");
}

void warn_of(const std::string& path, const mapping::Inspection& inspection,
             const Settings& settings) {
  for (const mapping::Finding& finding : inspection.findings) {
    if (!finding.blocking)
      warn(settings, path + ": " + to_sentence(finding, kRepairOption, kWrapOption));
  }
}

}  // namespace shape3d::apps
