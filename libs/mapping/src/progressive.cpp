#include "shape3d/mapping/progressive.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "edge_collapse.hpp"
#include "mesh_arguments.hpp"
#include "progressive_data.hpp"
#include "scaled.hpp"
#include "shape3d/mapping/inspect.hpp"

namespace shape3d::mapping {
namespace {

using detail::Collapse;
using detail::CollapsePlace;
using detail::CollapseTask;

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

void check_options(const ConstPoints& V, const ProgressiveOptions& options) {
  const auto refuse = [](const std::string& name, const std::string& expected, double value) {
    throw std::invalid_argument("options." + name + ": expected " + expected + ", got " +
                                std::to_string(value));
  };
  if (options.coarsest < 1) refuse("coarsest", "1 at least", static_cast<double>(options.coarsest));
  const HoppeOptions& hoppe = options.hoppe;
  const std::pair<const char*, double> weights[] = {
      {"hoppe.distance_weight", hoppe.distance_weight},
      {"hoppe.spring_weight", hoppe.spring_weight},
      {"hoppe.scalar_weight", hoppe.scalar_weight},
      {"hoppe.discontinuity_weight", hoppe.discontinuity_weight}};
  for (const auto& [name, weight] : weights)
    if (!(weight >= 0.0 && std::isfinite(weight))) refuse(name, "0 at least", weight);
  if (!(hoppe.sharp_angle >= 0.0 && hoppe.sharp_angle <= 3.1415926535897936))
    refuse("hoppe.sharp_angle", "0 to pi", hoppe.sharp_angle);
  if (hoppe.attributes.size() > 0 && hoppe.attributes.rows() != V.rows()) {
    throw std::invalid_argument("options.hoppe.attributes: expected " + std::to_string(V.rows()) +
                                " rows, got " + std::to_string(hoppe.attributes.rows()));
  }
  if (!hoppe.attributes.allFinite())
    throw std::invalid_argument("options.hoppe.attributes: a value is not finite");
}

// An oriented manifold without loose ends; handles, holes and several pieces are welcome.
void check_mesh(const ConstPoints& V, const ConstTriangles& F) {
  const Inspection found = inspect(V, F);
  for (const Finding& finding : found.findings) {
    switch (finding.defect) {
      case Defect::boundary_loop:
      case Defect::several_components:
      case Defect::handle:
      case Defect::inside_out:
      case Defect::zero_area_triangle:
      case Defect::self_intersection:
        break;
      case Defect::too_few_triangles:
        if (found.triangles > 0) break;
        [[fallthrough]];
      case Defect::index_out_of_range:
      case Defect::not_finite:
      case Defect::zero_extent:
      case Defect::degenerate_triangle:
      case Defect::duplicate_triangle:
      case Defect::isolated_vertex:
      case Defect::nonmanifold_edge:
      case Defect::nonmanifold_vertex:
      case Defect::misoriented_edge:
      case Defect::not_orientable:
        throw std::invalid_argument("V, F: " + to_sentence(finding, "repair()", "wrap()"));
    }
  }
}

std::vector<Collapse> collapse(const CollapseTask& task, const ProgressiveOptions& options,
                               bool& cancelled) {
  switch (options.cost) {
    case CollapseCost::quadrics:
      return collapse_by_quadrics(task, cancelled);
    case CollapseCost::lindstrom_turk:
      return collapse_by_lindstrom_turk(task, cancelled);
    case CollapseCost::hoppe:
      return collapse_by_hoppe(task, options.hoppe, cancelled);
  }
  return {};
}

}  // namespace

std::string_view to_string(CollapseCost cost) {
  switch (cost) {
    case CollapseCost::quadrics:
      return "quadrics";
    case CollapseCost::lindstrom_turk:
      return "lindstrom_turk";
    case CollapseCost::hoppe:
      return "hoppe";
  }
  return "unknown cost";
}

void ProgressiveMesh::Data::append(const ProgressiveStep& step) {
  const auto number = static_cast<std::int32_t>(steps.size());
  const detail::Corner at_u = step.place.left >= 0 ? step.place.left : step.place.right;
  vertex_end[index(mesh.vertex(at_u))] = number;
  std::int64_t removed = 0;
  for (const detail::Corner c : {step.place.left, step.place.right}) {
    if (c < 0) continue;
    triangle_end[index(c / 3)] = number;
    ++removed;
  }
  triangles_at.push_back(triangles_at.back() - removed);
  steps.push_back(step);
  coarsen();
}

void ProgressiveMesh::Data::coarsen() {
  const ProgressiveStep& step = steps[index(level++)];
  const std::int32_t kept = step.place.left >= 0 ? mesh.vertex(detail::next(step.place.left))
                                                 : mesh.vertex(detail::previous(step.place.right));
  mesh.collapse(step.place);
  P.row(kept) = step.kept_after;
}

void ProgressiveMesh::Data::refine() {
  const ProgressiveStep& step = steps[index(--level)];
  const bool left = step.place.left >= 0;
  const std::int32_t kept = left ? mesh.vertex(detail::next(step.place.left))
                                 : mesh.vertex(detail::previous(step.place.right));
  mesh.split(step.place);
  P.row(kept) = step.kept_before;
  P.row(mesh.vertex(left ? step.place.left : step.place.right)) = step.removed;
}

ProgressiveMesh::ProgressiveMesh(const ConstPoints& V, const ConstTriangles& F,
                                 const ProgressiveOptions& options)
    : data_(std::make_unique<Data>()) {
  check_options(V, options);
  check_mesh(V, F);
  Data& data = *data_;
  data.mesh = detail::CornerMesh(F, V.rows());
  data.P = V;
  data.vertex_end.assign(index(V.rows()), Data::kNever);
  data.triangle_end.assign(index(F.rows()), Data::kNever);
  data.triangles_at = {F.rows()};

  const double unit = detail::scale_of(V);
  const double extent = (V.colwise().maxCoeff() - V.colwise().minCoeff()).maxCoeff() / unit;
  constexpr int kLatticeBits = 22, kDoubleBits = 52;
  const int exponent =
      std::max(std::ilogb(extent) - kLatticeBits, 1 - kDoubleBits);  // coordinates are below 2
  data.lattice_exponent = exponent + std::ilogb(unit);
  CollapseTask task{V,
                    F,
                    unit,
                    std::ldexp(1.0, exponent),
                    options.coarsest,
                    options.progress ? options.progress : [](double) { return true; }};
  bool cancelled = false;
  const std::vector<Collapse> collapses = collapse(task, options, cancelled);
  data.complete = !cancelled;
  data.steps.reserve(collapses.size());
  for (const Collapse& c : collapses) {
    data.append({data.mesh.find_edge(c.removed, c.kept), data.P.row(c.kept), data.P.row(c.removed),
                 c.position});
  }
  set_triangle_count(F.rows());
}

ProgressiveMesh::ProgressiveMesh(std::unique_ptr<Data> data) : data_(std::move(data)) {}
ProgressiveMesh::~ProgressiveMesh() = default;
ProgressiveMesh::ProgressiveMesh(const ProgressiveMesh& other)
    : data_(std::make_unique<Data>(*other.data_)) {}
ProgressiveMesh& ProgressiveMesh::operator=(const ProgressiveMesh& other) {
  if (this != &other) data_ = std::make_unique<Data>(*other.data_);
  return *this;
}
ProgressiveMesh::ProgressiveMesh(ProgressiveMesh&&) noexcept = default;
ProgressiveMesh& ProgressiveMesh::operator=(ProgressiveMesh&&) noexcept = default;

bool ProgressiveMesh::is_complete() const { return data_->complete; }
std::int64_t ProgressiveMesh::finest() const { return data_->triangles_at.front(); }
std::int64_t ProgressiveMesh::coarsest() const { return data_->triangles_at.back(); }
std::int64_t ProgressiveMesh::collapses() const {
  return static_cast<std::int64_t>(data_->steps.size());
}
std::int64_t ProgressiveMesh::triangle_count() const {
  return data_->triangles_at[index(data_->level)];
}
std::int64_t ProgressiveMesh::vertex_count() const { return data_->P.rows() - data_->level; }

void ProgressiveMesh::set_triangle_count(std::int64_t count) {
  if (count < 0) {
    throw std::invalid_argument("count: expected 0 triangles at least, got " +
                                std::to_string(count));
  }
  const auto& at = data_->triangles_at;  // falls steadily
  const auto found =
      std::partition_point(at.begin(), at.end(), [count](std::int64_t n) { return n > count; });
  const std::int64_t level = std::min(found - at.begin(), std::ptrdiff_t(at.size()) - 1);
  while (data_->level < level) data_->coarsen();
  while (data_->level > level) data_->refine();
}

std::vector<std::int32_t> ProgressiveMesh::vertex_rows() const {
  std::vector<std::int32_t> rows;
  rows.reserve(index(vertex_count()));
  for (std::size_t v = 0; v < data_->vertex_end.size(); ++v)
    if (data_->vertex_end[v] >= data_->level) rows.push_back(static_cast<std::int32_t>(v));
  return rows;
}

Points ProgressiveMesh::V() const {
  Points V(vertex_count(), 3);
  Eigen::Index next = 0;
  for (const std::int32_t v : vertex_rows()) V.row(next++) = data_->P.row(v);
  return V;
}

Triangles ProgressiveMesh::F() const {
  std::vector<std::int32_t> place(data_->vertex_end.size(), -1);
  std::int32_t count = 0;
  for (std::size_t v = 0; v < place.size(); ++v)
    if (data_->vertex_end[v] >= data_->level) place[v] = count++;
  Triangles F(triangle_count(), 3);
  Eigen::Index next = 0;
  for (std::size_t t = 0; t < data_->triangle_end.size(); ++t) {
    if (data_->triangle_end[t] < data_->level) continue;
    for (int i = 0; i < 3; ++i) {
      F(next, i) = place[index(data_->mesh.vertex(static_cast<detail::Corner>(3 * t) + i))];
    }
    ++next;
  }
  return F;
}

}  // namespace shape3d::mapping
