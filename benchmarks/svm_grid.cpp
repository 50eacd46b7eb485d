// Searches C and γ on a generated set, which it writes in the format of libsvm, so that svm-train
// can search the same grid: svm_grid SET THREADS. Prints the seconds, the best pair and its rate.
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "generated.hpp"
#include "shape3d/learning/folds.hpp"
#include "shape3d/learning/svm_search.hpp"

using namespace shape3d::learning;

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: svm_grid SET THREADS\n", stderr);
    return 2;
  }
  const GeneratedSet set = gaussian_clouds(400, 45, 5, 0.35, 1);
  // svm-train knows nothing of scaling: it is given scaled numbers, and so are we.
  const Features X = fit_scaling(set.X, ScalingKind::standard).apply(set.X);
  std::FILE* file = std::fopen(argv[1], "w");
  if (file == nullptr) {
    std::perror(argv[1]);
    return 1;
  }
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    std::fprintf(file, "%d", set.labels[static_cast<std::size_t>(i)]);
    for (Eigen::Index j = 0; j < X.cols(); ++j) {
      std::fprintf(file, " %d:%.17g", static_cast<int>(j) + 1, X(i, j));
    }
    std::fputc('\n', file);
  }
  if (std::fclose(file) != 0) {
    std::perror(argv[1]);
    return 1;
  }
  SvmOptions options;
  options.scaling = ScalingKind::none;
  const auto start = std::chrono::steady_clock::now();
  const SvmSearch search = search_svm(X, set.labels, stratified_folds(set.labels, 5, 1), options,
                                      default_svm_grid(SvmKernel::rbf), std::atoi(argv[2]));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::printf("{\"seconds\": %.4f, \"C\": %g, \"gamma\": %g, \"rate\": %.6f}\n", seconds.count(),
              search.C, search.gamma, search.best);
  return 0;
}
