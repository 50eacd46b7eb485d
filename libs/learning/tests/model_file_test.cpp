#include "shape3d/learning/model_file.hpp"

#include <catch2/catch.hpp>

#include "bytes.hpp"

using namespace shape3d::learning;
using Catch::Matchers::Contains;

namespace {

ModelFile example() {
  return {ModelKind::som, "hsh:K=8", {"chair", "", "a b"}, std::string("\0\x01\xff", 3)};
}

}  // namespace

TEST_CASE("a model file gives back what was put into it") {
  const std::string bytes = write_model_file(example());
  const ModelFile read = read_model_file(bytes);
  CHECK(read.kind == ModelKind::som);
  CHECK(read.descriptor == "hsh:K=8");
  CHECK(read.class_names == example().class_names);
  CHECK(read.body == example().body);
  CHECK(write_model_file(read) == bytes);
  CHECK(to_string(ModelKind::svm) == "svm");
  CHECK(to_string(ModelKind::som) == "som");
  CHECK(to_string(ModelKind::metric) == "metric");
}

TEST_CASE("every changed byte of a model file is found") {
  const std::string bytes = write_model_file(example());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (int change = 1; change < 256; ++change) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ change);
      CHECK_THROWS_AS(read_model_file(damaged), std::invalid_argument);
    }
  }
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    CHECK_THROWS_AS(read_model_file(bytes.substr(0, length)), std::invalid_argument);
  }
  CHECK_THROWS_WITH(read_model_file(bytes + "x"), Contains("its check sum"));
  CHECK_THROWS_WITH(read_model_file(bytes.substr(0, 20)),
                    Contains("the model is damaged: it has 20 bytes"));
}

TEST_CASE("a model of another version is named as such") {
  std::string bytes = write_model_file(example());
  bytes[16] = 7;
  CHECK_THROWS_WITH(read_model_file(bytes),
                    Contains("the model is of version 7 of the format, expected 1"));
  CHECK_THROWS_WITH(read_model_file("OFF\n3 1 0\n"), Contains("it does not begin as a model does"));
}

TEST_CASE("the check sum is CRC-64 of ECMA-182") {
  CHECK(detail::crc64("123456789") == 0x995dc9bbdf1939faULL);  // the check value of CRC-64/XZ
}

TEST_CASE("lengths are not trusted before the bytes are there") {
  // A right check sum over a length of 2⁶³: no memory is taken for it.
  detail::ByteWriter out;
  out.u64(std::uint64_t{1} << 63);
  out.u64(4);
  const std::string bytes = out.finish();
  const auto reader = [&] { return detail::ByteReader(bytes, "it"); };
  CHECK_THROWS_WITH(reader().text(), Contains("it is damaged: it ends early"));
  CHECK_THROWS_WITH(reader().integers(), Contains("it ends early"));
  CHECK_THROWS_WITH(reader().vector(), Contains("it ends early"));
  CHECK_THROWS_WITH(reader().matrix(), Contains("it ends early"));
  CHECK_THROWS_WITH(reader().finish(), Contains("16 bytes are left over"));
}
