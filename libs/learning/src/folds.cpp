#include "shape3d/learning/folds.hpp"

#include <algorithm>
#include <map>

#include "random_numbers.hpp"
#include "text.hpp"

namespace shape3d::learning {

std::vector<int> stratified_folds(const Labels& labels, int k, std::uint64_t seed) {
  detail::require_between("k", k, 2, static_cast<long long>(labels.size()));
  std::map<int, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    detail::require(labels[i] >= kUnlabelled, "a label", labels[i], "-1 or more");
    members[labels[i]].push_back(i);
  }
  // Dealing on from class to class, as cards, keeps the sizes of the folds within one.
  detail::RandomNumbers random(seed);
  std::vector<int> folds(labels.size());
  std::size_t dealt = 0;
  for (auto& [label, items] : members) {
    random.shuffle(items);
    for (const std::size_t item : items) {
      folds[item] = static_cast<int>(dealt++ % static_cast<std::size_t>(k));
    }
  }
  return folds;
}

std::vector<int> grouped_folds(const std::vector<int>& groups, int k, std::uint64_t seed) {
  std::map<int, std::size_t> sizes;
  for (const int group : groups) ++sizes[group];
  detail::require_between("k", k, 2, static_cast<long long>(sizes.size()));

  std::vector<std::pair<int, std::size_t>> order(sizes.begin(), sizes.end());
  detail::RandomNumbers random(seed);
  random.shuffle(order);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });

  std::vector<std::size_t> filled(static_cast<std::size_t>(k), 0);
  std::map<int, int> fold_of;
  for (const auto& [group, size] : order) {
    const auto fold = std::min_element(filled.begin(), filled.end());
    *fold += size;
    fold_of[group] = static_cast<int>(fold - filled.begin());
  }
  std::vector<int> folds;
  folds.reserve(groups.size());
  for (const int group : groups) folds.push_back(fold_of[group]);
  return folds;
}

}  // namespace shape3d::learning
