#include "shape3d/descriptors/descriptor.hpp"

#include <cmath>
#include <stdexcept>

#include "describe.hpp"
#include "descriptor_text.hpp"
#include "parallel.hpp"
#include "text.hpp"

namespace shape3d::descriptors {
namespace {

// Part of a voxel edge between points of HshSource::surface.
constexpr double kPointSpacing = 0.5;

void check_power(double power) {
  detail::require(power >= 0.1 && power <= 1.0, "power", power, "0.1 … 1");
}

Eigen::VectorXd shaped(Eigen::VectorXd vector, bool unit, double power) {
  if (unit) {
    const double norm = vector.norm();
    if (norm > 0.0) vector /= norm;
  }
  if (power != 1.0) {
    for (double& x : vector) x = std::copysign(std::pow(std::abs(x), power), x);
  }
  return vector;
}

}  // namespace

struct Descriptor::State {
  detail::Description description;
  std::string text;
  Eigen::Index length = 0;
  std::unique_ptr<const HshTransform> hsh;
  std::unique_ptr<const ConcentricSpheres> csm;
  std::unique_ptr<const ShTransform> sh;

  explicit State(detail::Description given) : description(std::move(given)) {
    text = std::string(detail::kind_of(description.parameters));
    char separator = ':';
    for (const auto& [key, value] : detail::fields_of(description)) {
      text += separator + key + '=' + value;
      separator = ',';
    }
    length = std::visit([&](const auto& parameters) { return prepare(parameters); },
                        description.parameters);
  }

  Eigen::Index prepare(const HshParameters& p) {
    check_power(p.power);
    hsh = std::make_unique<const HshTransform>(p.transform, p.voxels.side);
    return static_cast<Eigen::Index>(p.invariants == HshInvariants::energies
                                         ? hsh_pair_count(p.transform.K)
                                         : gram_count(p.transform.K));
  }

  Eigen::Index prepare(const CsmParameters& p) {
    check_power(p.power);
    csm = std::make_unique<const ConcentricSpheres>(p.spheres, p.voxels.side);
    return csm_length(p.spheres);
  }

  static Eigen::Index prepare(const D2Parameters& p) {
    detail::require_between("bins", p.options.bins, 2, 4096);
    return p.options.bins;
  }

  static Eigen::Index prepare(const EgiParameters& p) {
    detail::require_between("K", p.K, 0, 1000);
    return p.K + 1;
  }

  static Eigen::Index prepare(const RandomParameters& p) {
    detail::require_between("length", p.length, 1, 1 << 24);
    return p.length;
  }

  static Eigen::Index prepare(const PanoramaParameters& p) {
    check_power(p.power);
    return panorama_length(p.options);
  }

  Eigen::Index prepare(const SphericalParameters& p) {
    sh = std::make_unique<const ShTransform>(detail::prepare(p));
    return detail::length(p);
  }

  // The vector of solid space, from V and F.
  Eigen::VectorXd compute(const HshParameters& p, const Eigen::Ref<const Points>& V,
                          const Eigen::Ref<const Triangles>& F, int threads) const {
    if (p.source == HshSource::surface) {
      const Frame frame = surface_frame(V, F, p.voxels.centre, p.voxels.scale, p.voxels.factor);
      const double edge = 2.0 * frame.radius / p.voxels.side;
      return invariants(p, hsh_of_points(surface_points(V, F, kPointSpacing * edge), frame,
                                         p.transform, threads));
    }
    return of_voxels(p, voxelize(V, F, with_threads(p.voxels, threads)), threads);
  }

  Eigen::VectorXd compute(const CsmParameters& p, const Eigen::Ref<const Points>& V,
                          const Eigen::Ref<const Triangles>& F, int threads) const {
    return of_voxels(p, voxelize(V, F, with_threads(p.voxels, threads)), threads);
  }

  static VoxelizeOptions with_threads(VoxelizeOptions options, int threads) {
    options.threads = threads;
    return options;
  }

  static Eigen::VectorXd invariants(const HshParameters& p, const HshCoefficients& coefficients) {
    switch (p.invariants) {
      case HshInvariants::gram:
        return shaped(gram_invariants(coefficients), p.unit, p.power);
      case HshInvariants::roots:
        return shaped(gram_roots(coefficients), p.unit, p.power);
      case HshInvariants::energies:
        break;
    }
    return shaped(hsh_energies(coefficients), p.unit, p.power);
  }

  Eigen::VectorXd of_voxels(const HshParameters& p, const Voxels& voxels, int threads) const {
    return invariants(p, (*hsh)(voxels, threads));
  }

  Eigen::VectorXd of_voxels(const CsmParameters& p, const Voxels& voxels, int threads) const {
    return shaped((*csm)(voxels, threads), p.unit, p.power);
  }

  static Eigen::VectorXd compute(const D2Parameters& p, const Eigen::Ref<const Points>& V,
                                 const Eigen::Ref<const Triangles>& F, int threads) {
    return d2_histogram(V, F, p.options, threads);
  }

  static Eigen::VectorXd compute(const EgiParameters& p, const Eigen::Ref<const Points>& V,
                                 const Eigen::Ref<const Triangles>& F, int threads) {
    return egi_power(V, F, p.K, threads);
  }

  static Eigen::VectorXd compute(const RandomParameters& p, const Eigen::Ref<const Points>& V,
                                 const Eigen::Ref<const Triangles>& F, int) {
    return random_descriptor(V, F, p.length, p.seed);
  }

  static Eigen::VectorXd compute(const PanoramaParameters& p, const Eigen::Ref<const Points>& V,
                                 const Eigen::Ref<const Triangles>& F, int threads) {
    return shaped(shaped(panorama_spectrum(V, F, p.options, threads), false, p.power), p.unit, 1.0);
  }

  Eigen::VectorXd compute(const SphericalParameters&, const Eigen::Ref<const Points>&,
                          const Eigen::Ref<const Triangles>&, int) const {
    throw std::invalid_argument("descriptor " + text +
                                " needs a spherical map S of the mesh, which is not given");
  }
};

Descriptor::Descriptor(const Parameters& parameters, Align align)
    : state_(std::make_shared<const State>(detail::Description{parameters, align})) {}

Descriptor Descriptor::parse(std::string_view spec) {
  const detail::Description description = detail::parse_description(spec);
  return Descriptor(description.parameters, description.align);
}

std::string Descriptor::to_string() const { return state_->text; }

std::optional<std::string> Descriptor::difference(const Descriptor& other) const {
  if (kind() != other.kind()) {
    return "the descriptor is " + std::string(kind()) + " in one and " + std::string(other.kind()) +
           " in the other";
  }
  const auto mine = detail::fields_of(state_->description);
  const auto theirs = detail::fields_of(other.state_->description);
  for (std::size_t i = 0; i < mine.size(); ++i) {
    if (mine[i].second == theirs[i].second) continue;
    return mine[i].first + " is " + mine[i].second + " in one and " + theirs[i].second +
           " in the other";
  }
  return std::nullopt;
}

std::string_view Descriptor::kind() const {
  return detail::kind_of(state_->description.parameters);
}
const Parameters& Descriptor::parameters() const { return state_->description.parameters; }
Align Descriptor::align() const { return state_->description.align; }
Eigen::Index Descriptor::length() const { return state_->length; }
bool Descriptor::needs_map() const {
  return std::holds_alternative<SphericalParameters>(parameters());
}

const VoxelizeOptions* Descriptor::voxels() const {
  if (const auto* hsh = std::get_if<HshParameters>(&parameters())) {
    return hsh->source == HshSource::voxels ? &hsh->voxels : nullptr;
  }
  const auto* csm = std::get_if<CsmParameters>(&parameters());
  return csm != nullptr ? &csm->voxels : nullptr;
}

Eigen::VectorXd Descriptor::compute(const Voxels& voxels, int threads) const {
  threads = detail::resolve_threads(threads);
  if (this->voxels() == nullptr) {
    throw std::invalid_argument("descriptor " + to_string() +
                                " is not of voxels, expected one that is");
  }
  if (const auto* hsh = std::get_if<HshParameters>(&parameters())) {
    return state_->of_voxels(*hsh, voxels, threads);
  }
  return state_->of_voxels(std::get<CsmParameters>(parameters()), voxels, threads);
}

Eigen::VectorXd Descriptor::compute(const Eigen::Ref<const Points>& V,
                                    const Eigen::Ref<const Triangles>& F, int threads) const {
  threads = detail::resolve_threads(threads);
  return std::visit([&](const auto& p) { return state_->compute(p, V, F, threads); }, parameters());
}

Eigen::VectorXd Descriptor::compute(const Eigen::Ref<const Points>& V,
                                    const Eigen::Ref<const Triangles>& F,
                                    const Eigen::Ref<const Points>& S, int threads) const {
  if (const auto* spherical = std::get_if<SphericalParameters>(&parameters())) {
    return detail::describe(*spherical, *state_->sh, V, F, S, detail::resolve_threads(threads));
  }
  return compute(V, F, threads);
}

}  // namespace shape3d::descriptors
