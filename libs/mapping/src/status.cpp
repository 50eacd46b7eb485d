#include "shape3d/mapping/status.hpp"

namespace shape3d::mapping {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::certified:
      return "certified: one to one";
    case Status::tangled:
      return "triangles stayed flipped";
    case Status::wrong_degree:
      return "the sphere is covered more than once";
    case Status::crowded:
      return "parts of the surface shrink below what double precision can tell apart";
    case Status::solver_failed:
      return "the sparse Cholesky factorisation failed";
    case Status::cancelled:
      return "cancelled by the caller";
  }
  return "unknown status";
}

}  // namespace shape3d::mapping
