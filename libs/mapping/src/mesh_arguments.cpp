#include "mesh_arguments.hpp"

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

namespace shape3d::mapping::detail {

void check_indices(const ConstPoints& V, const ConstTriangles& F) {
  Eigen::Index first = -1, count = 0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    if (F.row(t).minCoeff() >= 0 && F.row(t).maxCoeff() < V.rows()) continue;
    if (count++ == 0) first = t;
  }
  if (count == 0) return;
  std::ostringstream text;
  text << "F: " << count << (count == 1 ? " row has" : " rows have") << " an index outside 0 to "
       << V.rows() - 1 << ", the first is row " << first << " (" << F(first, 0) << ", "
       << F(first, 1) << ", " << F(first, 2) << ")";
  throw std::invalid_argument(text.str());
}

void check_finite(const ConstPoints& V) {
  Eigen::Index first = -1, count = 0;
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    if (V.row(v).allFinite()) continue;
    if (count++ == 0) first = v;
  }
  if (count == 0) return;
  std::ostringstream text;
  text << "V: " << count << (count == 1 ? " row is" : " rows are")
       << " not finite, the first is row " << first << " (" << V(first, 0) << ", " << V(first, 1)
       << ", " << V(first, 2) << ")";
  throw std::invalid_argument(text.str());
}

Frame frame_of(const ConstPoints& V, const ConstTriangles& F) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::RowVector3d lower = Eigen::RowVector3d::Constant(kInfinity), upper = -lower;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      lower = lower.cwiseMin(V.row(F(t, i)));
      upper = upper.cwiseMax(V.row(F(t, i)));
    }
  }
  Frame frame;
  if (F.rows() == 0) return frame;
  const double extent = (upper - lower).maxCoeff();
  if (!std::isfinite(extent)) {
    throw std::invalid_argument("V: the extent of the coordinates is beyond the range of double");
  }
  frame.centre = 0.5 * lower + 0.5 * upper;
  // Not below the smallest normal number, whose inverse is finite.
  if (extent > 0.0) frame.unit = std::ldexp(1.0, std::max(std::ilogb(extent), -1021));
  return frame;
}

}  // namespace shape3d::mapping::detail
