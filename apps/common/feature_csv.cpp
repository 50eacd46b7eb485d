#include <algorithm>
#include <charconv>
#include <string>
#include <vector>

#include "error.hpp"
#include "feature_formats.hpp"
#include "text.hpp"

namespace shape3d::apps::formats {
namespace {

constexpr std::string_view kHead = "# shape3d describe, version 1";
constexpr std::string_view kWithClass = "file,size,mtime,class,";
constexpr std::string_view kSpec = "# descriptor ";
constexpr std::string_view kFailed = "# failed: ";

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n#") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

// Lines and fields of a table.
class CsvScanner {
 public:
  CsvScanner(std::string_view bytes, const std::string& path) : rest_(bytes), path_(path) {}

  [[nodiscard]] bool done() const { return rest_.empty(); }
  [[nodiscard]] bool at_comment() const { return !rest_.empty() && rest_.front() == '#'; }

  std::string_view line() {
    ++line_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return line.substr(0, line.size() - (!line.empty() && line.back() == '\r' ? 1 : 0));
  }

  /// The text of the first field; the rest of the line stays.
  std::string text_field() {
    std::string text;
    if (rest_.empty() || rest_.front() != '"') {
      const std::size_t end = std::min(rest_.find_first_of(",\n"), rest_.size());
      text = rest_.substr(0, end);
      rest_.remove_prefix(end);
      return text;
    }
    std::size_t i = 1;
    for (;; ++i) {
      if (i >= rest_.size()) fail("a quotation mark is not closed");
      if (rest_[i] == '"') {
        if (i + 1 < rest_.size() && rest_[i + 1] == '"') {
          ++i;
        } else {
          break;
        }
      }
      text += rest_[i];
    }
    rest_.remove_prefix(i + 1);
    return text;
  }

  /// The same of a field that is not the first.
  std::string next_text_field() {
    if (rest_.empty() || rest_.front() != ',') fail("fewer fields than columns");
    rest_.remove_prefix(1);
    return text_field();
  }

  template <class Number>
  Number number_field() {
    if (rest_.empty() || rest_.front() != ',') fail("fewer numbers than columns");
    rest_.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc{}) fail("expected a number in every column but the first");
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }

  void end_line() {
    if (!rest_.empty() && rest_.front() == '\r') rest_.remove_prefix(1);
    if (!rest_.empty() && rest_.front() != '\n') fail("more fields than columns");
    if (!rest_.empty()) rest_.remove_prefix(1);
    ++line_;
  }

  [[noreturn]] void fail(const std::string& sentence) const {
    throw FileError(path_, "line " + std::to_string(line_ + 1) +
                               ": is not a table of 'shape3d describe': " + sentence);
  }

 private:
  std::string_view rest_;
  std::string path_;
  int line_ = 0;
};

}  // namespace

void write_csv(OutputFile& file, const FeatureTable& table) {
  file.write(kHead);
  file.write("\n");
  const std::vector<std::string> names = feature_names(table);
  for (std::size_t s = 0; s < table.sets.size(); ++s) {
    file.write(std::string(kSpec) + names[s] + ", " + std::to_string(table.sets[s].vectors.cols()) +
               " numbers: " + table.sets[s].spec + "\n");
  }
  for (const auto& [path, reason] : table.failed) {
    file.write(std::string(kFailed) + one_line(path + ": " + reason) + "\n");
  }
  file.write("file,size,mtime");
  if (!table.classes.empty()) file.write(",class");
  for (std::size_t s = 0; s < table.sets.size(); ++s) {
    for (Eigen::Index i = 0; i < table.sets[s].vectors.cols(); ++i) {
      file.write("," + names[s] + "_" + std::to_string(i));
    }
  }
  file.write("\n");
  for (std::size_t row = 0; row < table.files.size(); ++row) {
    file.write(quoted(table.files[row].path));
    file.write_char(',');
    file.write_number(table.files[row].size);
    file.write_char(',');
    file.write_number(table.files[row].time);
    if (!table.classes.empty()) file.write("," + quoted(table.classes[row]));
    for (const FeatureSet& set : table.sets) {
      for (Eigen::Index i = 0; i < set.vectors.cols(); ++i) {
        file.write_char(',');
        file.write_number(set.vectors(static_cast<Eigen::Index>(row), i));
      }
    }
    file.write_char('\n');
  }
}

FeatureTable parse_csv(std::string_view bytes, const std::string& path) {
  CsvScanner scanner(bytes, path);
  if (bytes.substr(0, kHead.size()) != kHead) {
    scanner.fail("expected '" + std::string(kHead) + "'");
  }
  FeatureTable table;
  std::vector<std::int64_t> lengths;
  std::int64_t columns = 0;
  while (scanner.at_comment()) {
    std::string_view line = scanner.line();
    if (line.substr(0, kFailed.size()) == kFailed) {
      line.remove_prefix(kFailed.size());
      const std::size_t colon = std::min(line.find(": "), line.size());
      table.failed.emplace_back(line.substr(0, colon),
                                line.substr(std::min(colon + 2, line.size())));
      continue;
    }
    if (line.substr(0, kSpec.size()) != kSpec) continue;
    const std::size_t comma = line.find(", "), colon = line.find(" numbers: ");
    std::optional<std::int64_t> length;
    if (comma != std::string_view::npos && colon != std::string_view::npos && comma < colon) {
      length = parse_integer(line.substr(comma + 2, colon - comma - 2));
    }
    if (!length || *length < 1 || *length > static_cast<std::int64_t>(bytes.size())) {
      scanner.fail("expected 'NAME, N numbers: SPEC' after '# descriptor '");
    }
    lengths.push_back(*length);
    columns += *length;
    table.sets.push_back({std::string(line.substr(colon + 10)), {}});
  }
  if (table.sets.empty()) scanner.fail("no line says which descriptor the columns are of");
  const std::string_view names = scanner.line();
  const bool classes = names.substr(0, kWithClass.size()) == kWithClass;
  if (classes) ++columns;
  if (std::count(names.begin(), names.end(), ',') != columns + 2) {
    scanner.fail("expected " + std::to_string(columns + 3) + " columns");
  }
  std::vector<std::vector<double>> numbers(table.sets.size());
  while (!scanner.done()) {
    FeatureFile file;
    file.path = scanner.text_field();
    file.size = scanner.number_field<std::uint64_t>();
    file.time = scanner.number_field<std::int64_t>();
    table.files.push_back(file);
    if (classes) table.classes.push_back(scanner.next_text_field());
    for (std::size_t s = 0; s < numbers.size(); ++s) {
      for (std::int64_t i = 0; i < lengths[s]; ++i) {
        numbers[s].push_back(scanner.number_field<double>());
      }
    }
    scanner.end_line();
  }
  for (std::size_t s = 0; s < numbers.size(); ++s) {
    table.sets[s].vectors = Eigen::Map<const FeatureSet::Vectors>(
        numbers[s].data(), static_cast<Eigen::Index>(table.files.size()), lengths[s]);
  }
  return table;
}

}  // namespace shape3d::apps::formats
