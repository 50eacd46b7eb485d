#include "svm_state.hpp"

#include <algorithm>

#include "bytes.hpp"

namespace shape3d::learning {
namespace {

constexpr std::uint32_t kSvmVersion = 1;

}  // namespace

void Svm::State::take(const svm_model& trained) {
  const auto k = static_cast<std::size_t>(trained.nr_class);
  order.assign(trained.label, trained.label + k);
  counts.assign(trained.nSV, trained.nSV + k);
  vectors.resize(trained.l, scaling.offset.size());
  coefficients.resize(trained.nr_class - 1, trained.l);
  for (int i = 0; i < trained.l; ++i) {
    for (Eigen::Index j = 0; j < vectors.cols(); ++j) vectors(i, j) = trained.SV[i][j].value;
    for (int c = 0; c + 1 < trained.nr_class; ++c) coefficients(c, i) = trained.sv_coef[c][i];
  }
  rho = Eigen::Map<const Eigen::VectorXd>(trained.rho, pairs());
}

void Svm::State::connect() {
  classes = order;
  std::sort(classes.begin(), classes.end());
  rows_ = detail::SvmRows(vectors);
  coefficient_rows_.clear();
  for (Eigen::Index c = 0; c < coefficients.rows(); ++c) {
    coefficient_rows_.push_back(coefficients.row(c).data());
  }
  view_ = {};
  view_.param.svm_type = C_SVC;
  view_.param.kernel_type = options.kernel == SvmKernel::rbf ? RBF : LINEAR;
  view_.param.gamma = options.gamma;
  view_.nr_class = static_cast<int>(order.size());
  view_.l = static_cast<int>(vectors.rows());
  view_.SV = rows_.data();
  view_.sv_coef = coefficient_rows_.data();
  view_.rho = rho.data();
  view_.label = order.data();
  view_.nSV = counts.data();
  if (sigmoid_a.size() > 0) {
    view_.probA = sigmoid_a.data();
    view_.probB = sigmoid_b.data();
  }
}

std::string Svm::serialize() const {
  const State& s = *state_;
  detail::ByteWriter out;
  out.text("svm");
  out.u32(kSvmVersion);
  out.u32(static_cast<std::uint32_t>(s.options.kernel));
  out.real(s.options.C);
  out.real(s.options.gamma);
  out.u32(static_cast<std::uint32_t>(s.options.scaling));
  out.u32(s.options.probabilities ? 1 : 0);
  out.u32(s.options.balanced ? 1 : 0);
  out.reals(s.options.class_weights.data(),
            static_cast<Eigen::Index>(s.options.class_weights.size()));
  out.u64(s.options.seed);
  out.real(s.options.tolerance);
  out.real(s.options.cache_mb);
  out.vector(s.scaling.offset);
  out.vector(s.scaling.factor);
  out.integers(s.order);
  out.integers(s.counts);
  out.matrix(s.vectors);
  out.matrix(s.coefficients);
  out.vector(s.rho);
  out.vector(s.sigmoid_a);
  out.vector(s.sigmoid_b);
  return out.finish();
}

Svm Svm::deserialize(std::string_view bytes) {
  detail::ByteReader in(bytes, "the SVM");
  in.require(in.text() == "svm", "it is something else");
  const std::uint32_t version = in.u32();
  in.require(version == kSvmVersion, "its version is " + std::to_string(version) + ", expected " +
                                         std::to_string(kSvmVersion));
  auto state = std::make_shared<State>();
  State& s = *state;
  s.options.kernel = in.enumerator(SvmKernel::linear);
  s.options.C = in.real();
  s.options.gamma = in.real();
  s.options.scaling = in.enumerator(ScalingKind::standard);
  s.options.probabilities = in.u32() != 0;
  s.options.balanced = in.u32() != 0;
  const Eigen::VectorXd weights = in.vector();
  s.options.class_weights.assign(weights.begin(), weights.end());
  s.options.seed = in.u64();
  s.options.tolerance = in.real();
  s.options.cache_mb = in.real();
  s.scaling.kind = s.options.scaling;
  s.scaling.offset = in.vector();
  s.scaling.factor = in.vector();
  s.order = in.integers();
  s.counts = in.integers();
  s.vectors = in.matrix();
  s.coefficients = in.matrix();
  s.rho = in.vector();
  s.sigmoid_a = in.vector();
  s.sigmoid_b = in.vector();
  in.finish();

  const auto k = static_cast<Eigen::Index>(s.order.size());
  Eigen::Index sum = 0;
  bool counted = s.counts.size() == s.order.size();
  for (const int count : s.counts) {
    counted = counted && count >= 0;
    sum += count;
  }
  const Eigen::Index sigmoids = s.options.probabilities ? k * (k - 1) / 2 : 0;
  in.require(
      k >= 2 && counted && sum == s.vectors.rows() && s.vectors.cols() == s.scaling.offset.size() &&
          s.scaling.factor.size() == s.scaling.offset.size() && s.coefficients.rows() == k - 1 &&
          s.coefficients.cols() == s.vectors.rows() && s.rho.size() == k * (k - 1) / 2 &&
          s.sigmoid_a.size() == sigmoids && s.sigmoid_b.size() == sigmoids,
      "its sizes do not fit together");
  s.connect();
  return Svm(std::move(state));
}

}  // namespace shape3d::learning
