#include "describe_journal.hpp"

#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <shape3d/descriptors/descriptor.hpp>

#include "common/byte_source.hpp"
#include "common/error.hpp"

namespace shape3d::apps {
namespace {

constexpr std::string_view kHead = "shape3d describe journal 1\n";

std::string header_of(const std::vector<std::string>& specs) {
  std::string header(kHead);
  for (const std::string& spec : specs) header += spec + "\n";
  return header + "\n";
}

// FNV-1a.
std::uint64_t check_sum(std::string_view bytes) {
  std::uint64_t sum = 14695981039346656037u;
  for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return sum;
}

template <class Number>
void append_number(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

template <class Number>
bool take_number(std::string_view& bytes, Number& number) {
  if (bytes.size() < sizeof number) return false;
  std::memcpy(&number, bytes.data(), sizeof number);
  bytes.remove_prefix(sizeof number);
  return true;
}

// A record: size and check sum of what follows; size and time of the file, its path, the vectors.
std::string record_of(const DescribedFile& entry) {
  std::string payload;
  append_number(payload, entry.file.size);
  append_number(payload, entry.file.time);
  append_number(payload, static_cast<std::uint64_t>(entry.file.path.size()));
  payload += entry.file.path;
  for (const Eigen::VectorXd& vector : entry.vectors) {
    payload.append(reinterpret_cast<const char*>(vector.data()),
                   static_cast<std::size_t>(vector.size()) * sizeof(double));
  }
  std::string record;
  append_number(record, static_cast<std::uint64_t>(payload.size()));
  append_number(record, check_sum(payload));
  return record + payload;
}

// Takes one whole record off the front.
std::optional<DescribedFile> take_record(std::string_view& bytes,
                                         const std::vector<Eigen::Index>& lengths) {
  std::string_view rest = bytes;
  std::uint64_t size = 0, sum = 0, path_size = 0;
  if (!take_number(rest, size) || !take_number(rest, sum) || size > rest.size()) return {};
  std::string_view payload = rest.substr(0, size);
  if (check_sum(payload) != sum) return {};
  rest.remove_prefix(size);
  DescribedFile entry;
  if (!take_number(payload, entry.file.size) || !take_number(payload, entry.file.time) ||
      !take_number(payload, path_size) || path_size > payload.size()) {
    return {};
  }
  entry.file.path = payload.substr(0, path_size);
  payload.remove_prefix(path_size);
  for (const Eigen::Index length : lengths) {
    const std::size_t count = static_cast<std::size_t>(length) * sizeof(double);
    if (payload.size() < count) return {};
    entry.vectors.emplace_back(length);
    std::memcpy(entry.vectors.back().data(), payload.data(), count);
    payload.remove_prefix(count);
  }
  if (!payload.empty()) return {};
  bytes = rest;
  return entry;
}

}  // namespace

std::string descriptor_difference(const std::vector<std::string>& found,
                                  const std::vector<std::string>& wanted) {
  if (found.size() != wanted.size()) {
    return "holds vectors of " + std::to_string(found.size()) + " descriptors, expected " +
           std::to_string(wanted.size());
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] == wanted[i]) continue;
    std::string sentence = "holds vectors of '" + found[i] + "', expected '" + wanted[i] + "'";
    try {
      const auto difference = descriptors::Descriptor::parse(found[i]).difference(
          descriptors::Descriptor::parse(wanted[i]));
      if (difference) sentence += ": " + *difference;
    } catch (const std::invalid_argument& error) {
      sentence += std::string(": ") + error.what();
    }
    return sentence;
  }
  return {};
}

DescribeJournal::DescribeJournal(std::string path, const std::vector<std::string>& specs,
                                 std::vector<Eigen::Index> lengths)
    : path_(std::move(path)), lengths_(std::move(lengths)) {
  descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    throw FileError(path_, std::string("cannot be written: ") + std::strerror(errno));
  }
  try {
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      throw FileError(path_, "is being written by another run of 'shape3d describe'");
    }
    read(specs);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

DescribeJournal::~DescribeJournal() { close(descriptor_); }

void DescribeJournal::read(const std::vector<std::string>& specs) {
  if (readable_size(path_) == 0) {
    const std::string header = header_of(specs);
    if (write(descriptor_, header.data(), header.size()) != static_cast<ssize_t>(header.size())) {
      throw FileError(path_, std::string("cannot be written: ") + std::strerror(errno));
    }
    return;
  }
  std::size_t whole = 0;  // bytes of the header and of whole records
  {
    const MappedFile file(path_);
    const std::string_view bytes = file.bytes();
    const std::size_t end = bytes.find("\n\n");
    if (bytes.substr(0, kHead.size()) != kHead || end == std::string_view::npos) {
      throw FileError(path_, "is not a journal of 'shape3d describe'; remove it to begin anew");
    }
    std::vector<std::string> found;
    for (std::string_view rest = bytes.substr(kHead.size(), end + 1 - kHead.size()); !rest.empty();
         rest.remove_prefix(found.back().size() + 1)) {
      found.emplace_back(rest.substr(0, rest.find('\n')));
    }
    const std::string difference = descriptor_difference(found, specs);
    if (!difference.empty()) throw FileError(path_, difference + "; --restart describes anew");
    std::string_view rest = bytes.substr(end + 2);
    while (auto entry = take_record(rest, lengths_)) {
      const std::string key = entry->file.path;
      entries_.insert_or_assign(key, std::move(*entry));
    }
    whole = bytes.size() - rest.size();
  }
  if (ftruncate(descriptor_, static_cast<off_t>(whole)) != 0) {
    throw FileError(path_, std::string("cannot be cut: ") + std::strerror(errno));
  }
}

void DescribeJournal::append(const DescribedFile& entry) {
  const std::string record = record_of(entry);
  std::size_t written = 0;
  while (written < record.size()) {
    const ssize_t count = write(descriptor_, record.data() + written, record.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      throw FileError(path_, std::string("cannot be written: ") + std::strerror(errno));
    written += static_cast<std::size_t>(count);
  }
}

void DescribeJournal::remove() { unlink(path_.c_str()); }

}  // namespace shape3d::apps
