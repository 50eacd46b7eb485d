// The SVM beside the programs of libsvm itself, on generated sets.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

#include <catch2/catch.hpp>

#include "generated.hpp"
#include "shape3d/learning/svm.hpp"
#include "support/test_data.hpp"

#if defined(SHAPE3D_SVM_TRAIN) && defined(SHAPE3D_SVM_PREDICT)

using namespace shape3d::learning;

namespace {

void write_set(const std::string& path, const Features& X, const Labels& labels) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  REQUIRE(file != nullptr);
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    std::fprintf(file, "%d", labels[static_cast<std::size_t>(i)]);
    for (Eigen::Index j = 0; j < X.cols(); ++j) {
      std::fprintf(file, " %d:%.17g", static_cast<int>(j) + 1, X(i, j));
    }
    std::fputc('\n', file);
  }
  std::fclose(file);
}

void run(const std::string& command) {
  INFO(command);
  REQUIRE(std::system((command + " >/dev/null").c_str()) == 0);
}

Labels read_labels(const std::string& path) {
  std::ifstream file(path);
  Labels labels;
  for (double value = 0.0; file >> value;) labels.push_back(static_cast<int>(value));
  return labels;
}

// "total_sv 47", "rho 0.25 …": what follows a word in the file of a model.
std::string field(const std::string& path, const std::string& word) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(word + " ", 0) == 0) return line.substr(word.size() + 1);
  }
  return "";
}

struct Case {
  const char* options;
  SvmKernel kernel;
  double C, gamma;
  std::vector<double> weights;
};

}  // namespace

TEST_CASE("predictions are those of svm-train and svm-predict") {
  const shape3d::test::TemporaryFolder temporary;
  const auto file = [&](const char* name) { return (temporary / name).string(); };
  const Case tried = GENERATE(Case{"-t 2 -c 1 -g 0.1", SvmKernel::rbf, 1.0, 0.1, {}},
                              Case{"-t 2 -c 32 -g 0.5", SvmKernel::rbf, 32.0, 0.5, {}},
                              Case{"-t 0 -c 0.5", SvmKernel::linear, 0.5, 0.0, {}},
                              Case{"-t 2 -c 2 -g 0.05 -w0 5 -w1 1 -w2 0.25 -w3 2 -w4 1",
                                   SvmKernel::rbf,
                                   2.0,
                                   0.05,
                                   {5.0, 1.0, 0.25, 2.0, 1.0}});
  const int seed = GENERATE(1, 2, 3);
  const GeneratedSet set = gaussian_clouds(600, 8, 5, 0.8, static_cast<std::uint64_t>(seed));
  const Features train = set.X.topRows(400);
  const Labels train_labels(set.labels.begin(), set.labels.begin() + 400);
  const Features test = set.X.bottomRows(200);
  const Labels test_labels(set.labels.begin() + 400, set.labels.end());

  SvmOptions options;
  options.kernel = tried.kernel;
  options.C = tried.C;
  options.gamma = tried.gamma;
  options.class_weights = tried.weights;
  const Svm svm = Svm::train(train, train_labels, options);
  const Labels predicted = svm.predict(test);

  write_set(file("train"), svm.scaling().apply(train), train_labels);
  write_set(file("test"), svm.scaling().apply(test), test_labels);
  run(std::string(SHAPE3D_SVM_TRAIN) + " -q " + tried.options + " " + file("train") + " " +
      file("model"));
  run(std::string(SHAPE3D_SVM_PREDICT) + " " + file("test") + " " + file("model") + " " +
      file("predicted"));
  CHECK(predicted == read_labels(file("predicted")));
  CHECK(field(file("model"), "total_sv") == std::to_string(svm.support_vectors()));
  int wrong = 0;
  for (std::size_t i = 0; i < predicted.size(); ++i) wrong += predicted[i] != test_labels[i];
  CHECK(wrong > 0);  // sets that are too easy show nothing
  CHECK(wrong < 100);
}

#else

TEST_CASE("predictions are those of svm-train and svm-predict") {
  std::cout << "svm-train and svm-predict (package libsvm-tools) are not installed: not compared\n";
}

#endif
