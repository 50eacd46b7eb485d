#include "byte_source.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

#include "error.hpp"

namespace shape3d::apps {

std::uint64_t readable_size(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw FileError(path, "no such file");
  }
  if (error) throw FileError(path, "cannot be read: " + error.message());
  if (status.type() == std::filesystem::file_type::directory) {
    throw FileError(path, "is a directory; expected a file");
  }
  // Opening a pipe would wait for a writer.
  if (status.type() != std::filesystem::file_type::regular) {
    throw FileError(path, "is a device, pipe or socket; expected a regular file");
  }
  errno = 0;
  const std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw FileError(path, "cannot be opened: " + std::generic_category().message(errno));
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw FileError(path, "cannot be read: " + error.message());
  return size;
}

FileSource::FileSource(const std::filesystem::path& path, std::uint64_t offset) : path_(path) {
  const std::uint64_t size = readable_size(path);
  file_.open(path, std::ios::binary);
  file_.seekg(static_cast<std::streamoff>(std::min(offset, size)));
  if (!file_) throw FileError(path, "cannot be opened");
}

std::size_t FileSource::read(void* out, std::size_t count) {
  file_.read(static_cast<char*>(out), static_cast<std::streamsize>(count));
  if (file_.bad()) throw FileError(path_, "cannot be read: input/output error");
  return static_cast<std::size_t>(file_.gcount());
}

std::size_t MemorySource::read(void* out, std::size_t count) {
  count = std::min(count, rest_.size());
  if (count > 0) std::memcpy(out, rest_.data(), count);
  rest_.remove_prefix(count);
  return count;
}

struct InflateSource::State {
  std::unique_ptr<ByteSource> source;
  std::filesystem::path path;
  z_stream stream{};
  std::array<unsigned char, 1 << 16> input{};
  bool input_ended = false;
  bool ended = false;
  bool truncated = false;

  // More input behind what zlib has not used yet.
  void refill() {
    if (input_ended) return;
    if (stream.avail_in > 0) std::memmove(input.data(), stream.next_in, stream.avail_in);
    const std::size_t room = input.size() - stream.avail_in;
    const std::size_t got = source->read(input.data() + stream.avail_in, room);
    input_ended = got < room;
    stream.next_in = input.data();
    stream.avail_in += static_cast<uInt>(got);
  }

  // After the end of a member: true when another gzip member follows.
  bool next_member() {
    if (stream.avail_in < 2) refill();
    if (stream.avail_in < 2 || stream.next_in[0] != 0x1f || stream.next_in[1] != 0x8b) return false;
    return inflateReset(&stream) == Z_OK;
  }
};

InflateSource::InflateSource(std::unique_ptr<ByteSource> source, const std::filesystem::path& path)
    : state_(std::make_unique<State>()) {
  state_->source = std::move(source);
  state_->path = path;
  constexpr int kGzipOrZlib = 32 + 15;
  if (inflateInit2(&state_->stream, kGzipOrZlib) != Z_OK) {
    throw FileError(path, "cannot be decompressed: zlib does not start");
  }
}

InflateSource::~InflateSource() { inflateEnd(&state_->stream); }

bool InflateSource::truncated() const { return state_->truncated; }

std::size_t InflateSource::read(void* out, std::size_t count) {
  State& state = *state_;
  std::size_t done = 0;
  while (done < count && !state.ended) {
    if (state.stream.avail_in == 0) state.refill();
    constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
    const auto room = static_cast<uInt>(std::min(count - done, kMost));
    state.stream.next_out = static_cast<Bytef*>(out) + done;
    state.stream.avail_out = room;
    const int code = inflate(&state.stream, Z_NO_FLUSH);
    done += room - state.stream.avail_out;
    if (code == Z_STREAM_END) {
      state.ended = !state.next_member();
    } else if (code == Z_BUF_ERROR && state.stream.avail_in == 0 && state.input_ended) {
      state.ended = true;
      state.truncated = true;
    } else if (code != Z_OK && code != Z_BUF_ERROR) {
      const char* reason = state.stream.msg != nullptr ? state.stream.msg : "not zlib data";
      throw FileError(state.path, std::string("compressed data are damaged: ") + reason);
    }
  }
  return done;
}

MappedFile::MappedFile(const std::filesystem::path& path) {
  const std::uint64_t size = readable_size(path);
  if (size == 0) return;
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    throw FileError(path, "cannot be opened: " + std::generic_category().message(errno));
  }
  void* address = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  const int error = errno;
  close(descriptor);
  if (address == MAP_FAILED) {
    throw FileError(path, "cannot be read: " + std::generic_category().message(error));
  }
  bytes_ = {static_cast<const char*>(address), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

std::string read_head(const std::filesystem::path& path, std::size_t count) {
  FileSource source(path);
  std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(count, readable_size(path))),
                    '\0');
  bytes.resize(source.read(bytes.data(), bytes.size()));
  return bytes;
}

bool begins_like_gzip(std::string_view bytes) {
  return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

}  // namespace shape3d::apps
