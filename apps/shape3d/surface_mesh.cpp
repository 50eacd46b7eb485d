#include "surface_mesh.hpp"

#include <limits>

namespace shape3d::apps {
namespace {

template <class T>
void append(MeshArray& to, const MeshArray& from) {
  auto& values = std::get<std::vector<T>>(to.values);
  const auto& more = std::get<std::vector<T>>(from.values);
  values.insert(values.end(), more.begin(), more.end());
}

}  // namespace

MeshView view_of(const AnySurface& surface) {
  return std::visit(
      [](const auto& s) {
        MeshView view;
        view.positions = s.positions.data();
        view.vertex_count = s.vertex_count();
        view.indices = s.indices.data();
        view.triangle_count = s.triangle_count();
        return view;
      },
      surface);
}

void turn_about_z(AnySurface& surface) {
  std::visit(
      [](auto& s) {
        for (std::size_t i = 0; i + 2 < s.positions.size(); i += 3) {
          s.positions[i] = -s.positions[i];
          s.positions[i + 1] = -s.positions[i + 1];
        }
      },
      surface);
}

std::vector<MeshArray> vertex_arrays_of(const AnySurface& surface, double isovalue) {
  const auto count = static_cast<std::size_t>(view_of(surface).vertex_count);
  return {{"isovalue", std::vector<double>(count, isovalue)}};
}

std::vector<MeshArray> triangle_arrays_of(const AnySurface& surface, double isovalue) {
  return std::visit(
      [isovalue](const auto& s) -> std::vector<MeshArray> {
        const auto count = static_cast<std::size_t>(s.triangle_count());
        std::vector<std::uint8_t> kinds(count);
        for (std::size_t t = 0; t < count; ++t)
          kinds[t] = static_cast<std::uint8_t>(s.kind(static_cast<std::int64_t>(t)));
        return {{"isovalue", std::vector<double>(count, isovalue)}, {"kind", std::move(kinds)}};
      },
      surface);
}

SurfaceCollection::SurfaceCollection()
    : vertex_arrays_{{"isovalue", std::vector<double>{}}},
      triangle_arrays_{{"isovalue", std::vector<double>{}}, {"kind", std::vector<std::uint8_t>{}}} {
}

void SurfaceCollection::add(const AnySurface& surface, double isovalue) {
  const MeshView view = view_of(surface);
  const auto offset = static_cast<std::int64_t>(positions_.size() / 3);
  if (offset + view.vertex_count > std::numeric_limits<std::int32_t>::max()) {
    if (const auto* narrow = std::get_if<std::vector<std::int32_t>>(&indices_)) {
      indices_ = std::vector<std::int64_t>(narrow->begin(), narrow->end());
    }
  }
  positions_.insert(positions_.end(), view.positions, view.positions + 3 * view.vertex_count);
  std::visit(
      [&](auto& to, const auto* from) {
        using Index = typename std::decay_t<decltype(to)>::value_type;
        to.reserve(to.size() + static_cast<std::size_t>(3 * view.triangle_count));
        for (std::int64_t i = 0; i < 3 * view.triangle_count; ++i)
          to.push_back(static_cast<Index>(from[i] + offset));
      },
      indices_, view.indices);
  append<double>(vertex_arrays_[0], vertex_arrays_of(surface, isovalue)[0]);
  const std::vector<MeshArray> arrays = triangle_arrays_of(surface, isovalue);
  append<double>(triangle_arrays_[0], arrays[0]);
  append<std::uint8_t>(triangle_arrays_[1], arrays[1]);
}

MeshView SurfaceCollection::view() const {
  MeshView view;
  view.positions = positions_.data();
  view.vertex_count = static_cast<std::int64_t>(positions_.size() / 3);
  std::visit(
      [&view](const auto& ids) {
        view.indices = ids.data();
        view.triangle_count = static_cast<std::int64_t>(ids.size() / 3);
      },
      indices_);
  view.vertex_arrays = &vertex_arrays_;
  view.triangle_arrays = &triangle_arrays_;
  return view;
}

}  // namespace shape3d::apps
