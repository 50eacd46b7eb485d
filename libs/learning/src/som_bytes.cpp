#include "bytes.hpp"
#include "shape3d/learning/som.hpp"
#include "shape3d/learning/som_maps.hpp"

namespace shape3d::learning {
namespace {

constexpr std::uint32_t kSomVersion = 1;

}  // namespace

std::string Som::serialize() const {
  detail::ByteWriter out;
  out.text("som");
  out.u32(kSomVersion);
  out.i32(grid.rows);
  out.i32(grid.columns);
  out.u32(static_cast<std::uint32_t>(grid.lattice));
  out.u32(static_cast<std::uint32_t>(grid.shape));
  out.u32(static_cast<std::uint32_t>(scaling.kind));
  out.vector(scaling.offset);
  out.vector(scaling.factor);
  out.matrix(prototypes);
  out.u32(cancelled ? 1 : 0);
  return out.finish();
}

Som Som::deserialize(std::string_view bytes) {
  detail::ByteReader in(bytes, "the map");
  in.require(in.text() == "som", "it is something else");
  const std::uint32_t version = in.u32();
  in.require(version == kSomVersion, "its version is " + std::to_string(version) + ", expected " +
                                         std::to_string(kSomVersion));
  Som som;
  som.grid.rows = in.i32();
  som.grid.columns = in.i32();
  som.grid.lattice = in.enumerator(SomLattice::hexagonal);
  som.grid.shape = in.enumerator(SomShape::toroid);
  som.scaling.kind = in.enumerator(ScalingKind::standard);
  som.scaling.offset = in.vector();
  som.scaling.factor = in.vector();
  som.prototypes = in.matrix();
  som.cancelled = in.u32() != 0;
  in.finish();
  check_grid(som.grid);
  in.require(som.prototypes.rows() == som.grid.units() &&
                 som.scaling.offset.size() == som.prototypes.cols() &&
                 som.scaling.factor.size() == som.prototypes.cols(),
             "its sizes do not fit together");
  return som;
}

std::string SomModel::serialize() const {
  detail::ByteWriter out;
  out.text("som model");
  out.u32(kSomVersion);
  out.text(som.serialize());
  out.integers(hits);
  out.integers(labels);
  out.integers(clusters);
  out.u64(names.size());
  for (const std::string& name : names) out.text(name);
  return out.finish();
}

SomModel SomModel::deserialize(std::string_view bytes) {
  detail::ByteReader in(bytes, "the map");
  in.require(in.text() == "som model", "it is something else");
  const std::uint32_t version = in.u32();
  in.require(version == kSomVersion, "its version is " + std::to_string(version) + ", expected " +
                                         std::to_string(kSomVersion));
  SomModel model;
  model.som = Som::deserialize(in.text());
  model.hits = in.integers();
  model.labels = in.integers();
  model.clusters = in.integers();
  const auto units = static_cast<std::size_t>(model.som.grid.units());
  in.require(in.u64() == units && model.hits.size() == units && model.labels.size() == units &&
                 model.clusters.size() == units,
             "its sizes do not fit together");
  for (std::size_t u = 0; u < units; ++u) model.names.push_back(in.text());
  in.finish();
  return model;
}

}  // namespace shape3d::learning
