#include "shape3d/learning/classification.hpp"

#include <stdexcept>

#include <catch2/catch.hpp>

using namespace shape3d::learning;

TEST_CASE("classifications are read with their hierarchy") {
  const Classification read = parse_classification(
      "\xef\xbb\xbfPSB 1\r\n4 4\n\nvehicle 0 0\n\ncar vehicle 2\n7\n1300\n\n-1 0 1 # one\n12\nvan "
      "car "
      "1\n  T9  \n");
  REQUIRE(read.classes.size() == 4);
  CHECK(read.classes[0].full_name == "vehicle");
  CHECK(read.classes[0].models == 0);
  CHECK(read.classes[1].full_name == "vehicle/car");
  CHECK(read.classes[1].parent == 0);
  CHECK(read.classes[2].name == kMiscellaneousClass);
  CHECK(read.classes[3].full_name == "vehicle/car/van");
  REQUIRE(read.models.size() == 4);
  CHECK(read.models[1].id == "1300");
  CHECK(read.models[3].id == "T9");
  CHECK(read.labels() == Labels{1, 1, 2, 3});
}

TEST_CASE("broken classifications are refused with the line") {
  const auto refused = [](const char* text, const char* sentence) {
    CHECK_THROWS_AS(parse_classification(text), std::invalid_argument);
    CHECK_THROWS_WITH(parse_classification(text), sentence);
  };
  refused("", "ends after line 0, expected 'PSB 1'");
  refused("PSB 2\n", "line 1 is 'PSB 2', expected 'PSB 1'");
  refused("PSB\n", "line 1 has 1 words, expected 'PSB 1'");
  refused("PSB 1\nx 3\n", "line 2 has 'x', expected a number of classes");
  refused("PSB 1\n1 -3\n", "line 2 has '-3', expected a number of models");
  refused("PSB 1\n2 1\ncar 0 1\n7\n",
          "ends after line 4, expected class 2 of 2: name, parent, number of models");
  refused("PSB 1\n1 2\ncar 0 2\n7\n",
          "ends after line 4, expected model 2 of the 2 of class 'car'");
  refused("PSB 1\n1 1\ncar 0 1\n7 8\n",
          "line 4 has 2 words, expected model 1 of the 1 of class 'car'");
  refused("PSB 1\n1 2\ncar 0 1\n7\n", "has 1 models, expected 2, the number in its head");
  refused("PSB 1\n1 1\ncar 0 1\n7\n8\n",
          "line 5 follows the last class, expected nothing after the 1 classes of the head");
  refused("PSB 1\n1 0\ncar bus 0\n",
          "line 3 has the parent 'bus', expected 0 or a class before it");
  refused("PSB 1\n2 0\ncar 0 0\ncar 0 0\n",
          "line 4 names the class 'car' again, expected another name");
  refused("PSB 1\n2 2\ncar 0 1\n7\nbus 0 1\n7\n",
          "line 6 has model '7', which class 'car' has, expected each model once");
}
