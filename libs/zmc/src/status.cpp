#include "shape3d/zmc/status.hpp"

namespace shape3d::zmc {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::ok:
      return "a surface was extracted";
    case Status::empty:
      return "the isovalue separates no samples";
    case Status::too_many_vertices:
      return "too many vertices for the index type or the limit set";
    case Status::zero_region_at_seam:
      return "cells of eight zeros lie beside a seam between slabs, and the source cannot be read "
             "twice";
    case Status::cancelled:
      return "cancelled by the caller";
  }
  return "unknown status";
}

}  // namespace shape3d::zmc
