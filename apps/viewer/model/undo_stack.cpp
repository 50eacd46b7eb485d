#include "undo_stack.hpp"

#include <utility>

namespace shape3d::apps::viewer {

void UndoStack::start(const std::string& owner, const Json& state) { states_[owner] = state; }

void UndoStack::record(const std::string& owner, const Json& state) {
  const Json before = states_.contains(owner) ? states_[owner] : Json::object();
  if (before == state) return;
  changes_.resize(next_);
  changes_.push_back({owner, Json::diff(before, state), Json::diff(state, before)});
  if (changes_.size() > kMost) changes_.erase(changes_.begin());
  next_ = changes_.size();
  states_[owner] = state;
}

UndoStack::Step UndoStack::step(const std::string& owner, const Json& current, const Json& patch) {
  Step step{owner, current};
  try {
    step.state = current.patch(patch);
  } catch (const Json::exception&) {
    // The owner has changed its shape since without a record: its parts are not there any more.
    step.state = states_[owner].patch(patch);
  }
  states_[owner] = step.state;
  return step;
}

void UndoStack::clear() {
  changes_.clear();
  next_ = 0;
}

}  // namespace shape3d::apps::viewer
