#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace shape3d::apps::viewer {

/// Changes of parameters, as differences between states in JSON, that can be taken back and made
/// again. A state belongs to an owner: a view, by its name.
///
/// Taking a change back touches only the values that it changed, so that what was not recorded
/// (a cursor that moved since) stays.
class UndoStack {
 public:
  using Json = nlohmann::json;

  /// What the owner's state is without a change; call when it is made, loaded or reset by program.
  void start(const std::string& owner, const Json& state);
  /// The owner's state after a change by the user; nothing happens when it is the same. What could
  /// be made again is dropped. The oldest change goes when there are more than kMost.
  void record(const std::string& owner, const Json& state);

  struct Step {
    std::string owner;
    Json state;  ///< What the owner shall be set to.
  };
  /// @param current  Gives the present state of an owner.
  /// @return nothing when there is no change.
  template <class Current>
  std::optional<Step> undo(const Current& current) {
    if (next_ == 0) return std::nullopt;
    const Change& change = changes_[--next_];
    return step(change.owner, current(change.owner), change.backward);
  }
  template <class Current>
  std::optional<Step> redo(const Current& current) {
    if (next_ == changes_.size()) return std::nullopt;
    const Change& change = changes_[next_++];
    return step(change.owner, current(change.owner), change.forward);
  }
  [[nodiscard]] bool can_undo() const { return next_ > 0; }
  [[nodiscard]] bool can_redo() const { return next_ < changes_.size(); }
  void clear();

  static constexpr std::size_t kMost = 200;

 private:
  struct Change {
    std::string owner;
    Json forward, backward;  // patches as of RFC 6902
  };
  Step step(const std::string& owner, const Json& current, const Json& patch);

  std::vector<Change> changes_;
  std::size_t next_ = 0;  // changes_[next_] is the next to make again
  Json states_ = Json::object();
};

}  // namespace shape3d::apps::viewer
