#pragma once

// The keys of each kind of descriptor, once for parsing, printing and comparing.

#include <array>
#include <string_view>
#include <utility>

#include "shape3d/descriptors/parameters.hpp"

namespace shape3d::descriptors::detail {

/// Names of an enumeration's values in its order.
template <class Enum>
struct EnumNames;

template <>
struct EnumNames<Align> {
  static constexpr std::array<std::string_view, 2> names{"none", "cpca"};
};
template <>
struct EnumNames<SphereMap> {
  static constexpr std::array<std::string_view, 3> names{"two_sided", "equal_volume",
                                                         "stereographic"};
};
template <>
struct EnumNames<Quadrature> {
  static constexpr std::array<std::string_view, 3> names{"voxels", "separable", "svd"};
};
template <>
struct EnumNames<Fill> {
  static constexpr std::array<std::string_view, 4> names{"binary", "area", "gedt", "distance"};
};
template <>
struct EnumNames<Centre> {
  static constexpr std::array<std::string_view, 2> names{"area", "box"};
};
template <>
struct EnumNames<Scale> {
  static constexpr std::array<std::string_view, 3> names{"rms", "mean", "maximum"};
};
template <>
struct EnumNames<HshSource> {
  static constexpr std::array<std::string_view, 2> names{"voxels", "surface"};
};
template <>
struct EnumNames<HshInvariants> {
  static constexpr std::array<std::string_view, 3> names{"energies", "gram", "roots"};
};
template <>
struct EnumNames<CsmVariant> {
  static constexpr std::array<std::string_view, 2> names{"shells", "kazhdan"};
};

template <>
struct EnumNames<PanoramaAxes> {
  static constexpr std::array<std::string_view, 2> names{"surface", "normals"};
};

template <>
struct EnumNames<SphericalForm> {
  static constexpr std::array<std::string_view, 3> names{"amplitudes", "norms", "roots"};
};
template <>
struct EnumNames<ImageSampling> {
  static constexpr std::array<std::string_view, 2> names{"point", "area"};
};
template <>
struct EnumNames<ShRoute> {
  static constexpr std::array<std::string_view, 3> names{"quadrature", "fft", "svd"};
};

template <class Options, class Visitor>
void visit_voxels(Options& options, Visitor&& visit) {
  visit("voxels", options.side);
  visit("fill", options.fill);
  visit("sigma", options.sigma);
  visit("centre", options.centre);
  visit("scale", options.scale);
  visit("factor", options.factor);
}

/// Calls visit(key, member) for each parameter, in the order of the canonical text.
template <class Visitor>
void visit_fields(HshParameters& p, Visitor&& visit) {
  visit("map", p.transform.map);
  visit("K", p.transform.K);
  visit("stretch", p.transform.stretch);
  visit("invariants", p.invariants);
  visit("unit", p.unit);
  visit("power", p.power);
  visit("source", p.source);
  visit("quadrature", p.transform.quadrature);
  visit("grid", p.transform.grid);
  visit_voxels(p.voxels, visit);
}

template <class Visitor>
void visit_fields(CsmParameters& p, Visitor&& visit) {
  visit("variant", p.spheres.variant);
  visit("weighted", p.spheres.weighted);
  visit("R", p.spheres.R);
  visit("K", p.spheres.K);
  visit("unit", p.unit);
  visit("power", p.power);
  visit_voxels(p.voxels, visit);
}

template <class Visitor>
void visit_fields(D2Parameters& p, Visitor&& visit) {
  visit("bins", p.options.bins);
  visit("pairs", p.options.pairs);
  visit("range", p.options.range);
  visit("seed", p.options.seed);
}

template <class Visitor>
void visit_fields(EgiParameters& p, Visitor&& visit) {
  visit("K", p.K);
}

template <class Visitor>
void visit_fields(RandomParameters& p, Visitor&& visit) {
  visit("length", p.length);
  visit("seed", p.seed);
}

template <class Visitor>
void visit_fields(PanoramaParameters& p, Visitor&& visit) {
  visit("axes", p.options.axes);
  visit("K", p.options.K);
  visit("size", p.options.size);
  visit("power", p.power);
  visit("unit", p.unit);
}

template <class Visitor>
void visit_fields(SphericalParameters& p, Visitor&& visit) {
  visit("K", p.K);
  visit("size", p.size);
  visit("form", p.form);
  visit("components", p.components);
  visit("sampling", p.sampling);
  visit("route", p.route);
}

}  // namespace shape3d::descriptors::detail
