#include "made_volumes.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>

namespace shape3d::test {
namespace {

template <class T>
std::vector<double> to_doubles(const apps::Volume& volume) {
  std::vector<double> values(volume.samples.size() / sizeof(T));
  for (std::size_t n = 0; n < values.size(); ++n) {
    T value;
    std::memcpy(&value, volume.samples.data() + n * sizeof(T), sizeof(T));
    values[n] = static_cast<double>(value);
  }
  return values;
}

}  // namespace

MadeVolumes::MadeVolumes(const std::string& kind) {
  const std::string command = std::string(SHAPE3D_TEST_PYTHON) + " " + SHAPE3D_TEST_SCRIPTS +
                              "/make_volumes.py " + kind + " " + folder.path().string();
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
  std::ifstream(folder / "expected.json") >> expected;
}

const MadeVolumes& made_volumes(const std::string& kind) {
  static std::map<std::string, std::unique_ptr<MadeVolumes>> made;
  std::unique_ptr<MadeVolumes>& one = made[kind];
  if (!one) one = std::make_unique<MadeVolumes>(kind);
  return *one;
}

std::vector<double> sample_values(const apps::Volume& volume) {
  switch (volume.view.type) {
    case zmc::SampleType::int8:
      return to_doubles<std::int8_t>(volume);
    case zmc::SampleType::uint8:
      return to_doubles<std::uint8_t>(volume);
    case zmc::SampleType::int16:
      return to_doubles<std::int16_t>(volume);
    case zmc::SampleType::uint16:
      return to_doubles<std::uint16_t>(volume);
    case zmc::SampleType::int32:
      return to_doubles<std::int32_t>(volume);
    case zmc::SampleType::float32:
      return to_doubles<float>(volume);
    case zmc::SampleType::float64:
      break;
  }
  return to_doubles<double>(volume);
}

std::vector<double> read_doubles(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path);
  std::vector<double> values(bytes.size() / sizeof(double));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  return values;
}

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot open " + path.string());
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  // Overwriting a file makes some file systems wait for the disk.
  std::filesystem::remove(path);
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

ConsoleCapture::ConsoleCapture() {
  std::cout.flush();
  std::cerr.flush();
  std::fflush(nullptr);
  file_ = memfd_create("console", 0);
  if (file_ < 0) throw std::runtime_error("cannot capture the console");
  for (const int descriptor : {1, 2}) {
    saved_[descriptor - 1] = dup(descriptor);
    dup2(file_, descriptor);
  }
}

ConsoleCapture::~ConsoleCapture() {
  if (saved_[0] >= 0) stop();
}

std::string ConsoleCapture::stop() {
  std::cout.flush();
  std::cerr.flush();
  std::fflush(nullptr);
  for (const int descriptor : {1, 2}) {
    dup2(saved_[descriptor - 1], descriptor);
    close(saved_[descriptor - 1]);
    saved_[descriptor - 1] = -1;
  }
  std::string text(static_cast<std::size_t>(lseek(file_, 0, SEEK_END)), '\0');
  const ssize_t got = pread(file_, text.data(), text.size(), 0);
  close(file_);
  text.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
  return text;
}

}  // namespace shape3d::test
