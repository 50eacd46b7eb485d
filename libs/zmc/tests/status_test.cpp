#include "shape3d/zmc/status.hpp"

#include <set>
#include <string_view>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::zmc;

TEST_CASE("each status has a text of its own", "[zmc][contract]") {
  std::set<std::string_view> texts;
  for (const Status status : {Status::ok, Status::empty, Status::too_many_vertices,
                              Status::zero_region_at_seam, Status::cancelled}) {
    const std::string_view text = to_string(status);
    CHECK(text.size() > 3);
    CHECK(text != "unknown status");
    texts.insert(text);
  }
  CHECK(texts.size() == 5);
  CHECK(to_string(Status::empty) == "the isovalue separates no samples");
}
}  // namespace
