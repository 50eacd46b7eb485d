#include "shape3d/learning/model_file.hpp"

#include <stdexcept>

#include "bytes.hpp"

namespace shape3d::learning {
namespace {

// 16 bytes that every version begins with; then its number, 4 bytes, little endian.
constexpr std::string_view kMagic = "SHAPE3D MODEL\r\n\x1a";
constexpr std::uint32_t kVersion = 1;

std::uint32_t version_of(std::string_view bytes) {
  std::uint32_t version = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    version |= std::uint32_t{static_cast<unsigned char>(bytes[kMagic.size() + i])} << (8 * i);
  }
  return version;
}

}  // namespace

std::string_view to_string(ModelKind kind) {
  switch (kind) {
    case ModelKind::svm:
      return "svm";
    case ModelKind::som:
      return "som";
    case ModelKind::metric:
      break;
  }
  return "metric";
}

std::string write_model_file(const ModelFile& model) {
  detail::ByteWriter out;
  out.raw(kMagic);
  out.u32(kVersion);
  out.u32(static_cast<std::uint32_t>(model.kind));
  out.text(model.descriptor);
  out.u64(model.class_names.size());
  for (const std::string& name : model.class_names) out.text(name);
  out.text(model.body);
  return out.finish();
}

ModelFile read_model_file(std::string_view bytes) {
  if (bytes.substr(0, kMagic.size()) != kMagic) {
    throw std::invalid_argument("it does not begin as a model does");
  }
  if (bytes.size() < kMagic.size() + 12) {
    throw std::invalid_argument("the model is damaged: it has " + std::to_string(bytes.size()) +
                                " bytes");
  }
  const std::uint32_t version = version_of(bytes);
  if (version != kVersion) {
    throw std::invalid_argument("the model is of version " + std::to_string(version) +
                                " of the format, expected " + std::to_string(kVersion));
  }
  detail::ByteReader in(bytes, "the model");
  in.raw(kMagic.size());
  in.u32();
  ModelFile model;
  model.kind = in.enumerator(ModelKind::metric);
  model.descriptor = in.text();
  const std::uint64_t classes = in.u64();
  for (std::uint64_t c = 0; c < classes; ++c) model.class_names.push_back(in.text());
  model.body = in.text();
  in.finish();
  return model;
}

}  // namespace shape3d::learning
