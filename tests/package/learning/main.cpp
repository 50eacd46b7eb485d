// Trains a support vector machine and a map on two clouds. Fails unless both tell the clouds apart.
#include <cstdio>

#include <shape3d/learning/som_maps.hpp>
#include <shape3d/learning/svm.hpp>

int main() {
  using namespace shape3d::learning;
  Features X(40, 2);
  Labels labels;
  for (int i = 0; i < 40; ++i) {
    labels.push_back(i % 2);
    X.row(i) << 10.0 * (i % 2) + 0.1 * (i % 7), 0.2 * (i % 5);
  }
  const Labels predicted = Svm::train(X, labels).predict(X);
  const Som som = train_som(X);
  const double pure = purity(best_units(som, X).first, labels, som.grid.units());
  std::printf("machine %s, purity of the map %.2f\n", predicted == labels ? "right" : "wrong",
              pure);
  return predicted == labels && pure == 1.0 ? 0 : 1;
}
