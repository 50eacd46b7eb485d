// Divides nine items of three classes into three folds. Fails unless each fold has one of each.
#include <cstdio>
#include <set>
#include <utility>

#include <shape3d/learning/folds.hpp>

int main() {
  const shape3d::learning::Labels labels{0, 0, 0, 1, 1, 1, 2, 2, 2};
  const std::vector<int> folds = shape3d::learning::stratified_folds(labels, 3, 42);
  std::set<std::pair<int, int>> seen;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::printf("class %d fold %d\n", labels[i], folds[i]);
    seen.emplace(labels[i], folds[i]);
  }
  return seen.size() == 9 ? 0 : 1;
}
