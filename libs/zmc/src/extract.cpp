#include "shape3d/zmc/extract.hpp"

#include <stdexcept>

#include "shape3d/zmc/extractor.hpp"

namespace shape3d::zmc {

template <class Real, class Index>
Status extract(const VolumeView& view, double isovalue, const Options& options,
               Surface<Real, Index>& surface) {
  return Extractor().extract(view, isovalue, options, surface);
}

template Status extract(const VolumeView&, double, const Options&, Surface<float, std::int32_t>&);
template Status extract(const VolumeView&, double, const Options&, Surface<float, std::int64_t>&);
template Status extract(const VolumeView&, double, const Options&, Surface<double, std::int32_t>&);
template Status extract(const VolumeView&, double, const Options&, Surface<double, std::int64_t>&);

Surface<double, std::int32_t> extract(const VolumeView& view, double isovalue,
                                      const Options& options) {
  Surface<double, std::int32_t> surface;
  switch (extract(view, isovalue, options, surface)) {
    case Status::ok:
    case Status::empty:
    case Status::zero_region_at_seam:  // only of stream()
      break;
    case Status::too_many_vertices:
      throw std::length_error(
          "the surface has more vertices than 32-bit ids or options.max_vertices allow");
    case Status::cancelled:
      throw std::runtime_error("the extraction was cancelled by options.progress");
  }
  return surface;
}

}  // namespace shape3d::zmc
