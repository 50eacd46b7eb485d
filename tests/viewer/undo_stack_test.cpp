#include "viewer/model/undo_stack.hpp"

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::apps::viewer;
using Json = nlohmann::json;

TEST_CASE("changes are taken back and made again in their order", "[viewer][undo]") {
  UndoStack undo;
  Json a{{"x", 1}}, b{{"y", 1}};
  undo.start("a", a);
  undo.start("b", b);
  const auto current = [&](const std::string& owner) { return owner == "a" ? a : b; };
  const auto apply = [&](const std::optional<UndoStack::Step>& step) {
    REQUIRE(step);
    (step->owner == "a" ? a : b) = step->state;
  };
  CHECK_FALSE(undo.undo(current));
  undo.record("a", a = {{"x", 2}});
  undo.record("b", b = {{"y", 5}});
  undo.record("a", a = {{"x", 3}});
  undo.record("a", a);  // no change
  apply(undo.undo(current));
  CHECK(a == Json{{"x", 2}});
  apply(undo.undo(current));
  CHECK(b == Json{{"y", 1}});
  apply(undo.redo(current));
  CHECK(b == Json{{"y", 5}});
  apply(undo.undo(current));
  apply(undo.undo(current));
  CHECK(a == Json{{"x", 1}});
  CHECK_FALSE(undo.can_undo());
  CHECK(undo.can_redo());
  // A new change drops what could be made again.
  undo.record("a", a = {{"x", 9}});
  CHECK_FALSE(undo.can_redo());
}

TEST_CASE("what was not recorded stays", "[viewer][undo]") {
  UndoStack undo;
  Json state{{"isovalue", 10}, {"camera", {0, 0, 1}}};
  undo.start("v", state);
  state["isovalue"] = 20;
  undo.record("v", state);
  state["camera"] = {1, 2, 3};
  const auto step = undo.undo([&](const std::string&) { return state; });
  REQUIRE(step);
  CHECK(step->state == Json{{"isovalue", 10}, {"camera", {1, 2, 3}}});
}

TEST_CASE("a state of another shape than recorded is set back as recorded", "[viewer][undo]") {
  UndoStack undo;
  Json state{{"list", {1, 2, 3}}};
  undo.start("v", state);
  state["list"] = {1, 2, 3, 4, 5};
  undo.record("v", state);
  state["list"] = Json::array();  // its parts have gone by themselves
  const auto step = undo.undo([&](const std::string&) { return state; });
  REQUIRE(step);
  CHECK(step->state == Json{{"list", {1, 2, 3}}});
}

TEST_CASE("the oldest of many changes goes", "[viewer][undo]") {
  UndoStack undo;
  Json state{{"n", 0}};
  undo.start("v", state);
  for (int n = 1; n <= static_cast<int>(UndoStack::kMost) + 10; ++n)
    undo.record("v", state = {{"n", n}});
  int steps = 0;
  while (const auto step = undo.undo([&](const std::string&) { return state; })) {
    state = step->state;
    ++steps;
  }
  CHECK(steps == static_cast<int>(UndoStack::kMost));
  CHECK(state["n"] == 10);
}

}  // namespace
