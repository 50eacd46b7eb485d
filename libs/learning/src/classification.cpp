#include "shape3d/learning/classification.hpp"

#include <charconv>
#include <map>
#include <stdexcept>

namespace shape3d::learning {
namespace {

[[nodiscard]] std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 60;
  std::string result = "'";
  result += text.substr(0, kMost);
  if (text.size() > kMost) result += "…";
  return result + "'";
}

// Lines of words; blank lines and comments are passed over.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {
    if (rest_.substr(0, 3) == "\xef\xbb\xbf") rest_.remove_prefix(3);
  }

  // The words of the next line that has some; none at the end.
  std::vector<std::string_view> next() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      const std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      const std::vector<std::string_view> words = split(line.substr(0, line.find('#')));
      if (!words.empty()) return words;
    }
    return {};
  }

  // The next line of exactly `count` words.
  std::vector<std::string_view> next(std::size_t count, const std::string& expected) {
    const std::vector<std::string_view> words = next();
    if (words.empty()) {
      throw std::invalid_argument("ends after line " + std::to_string(number_) + ", expected " +
                                  expected);
    }
    if (words.size() != count) fail("has " + std::to_string(words.size()) + " words", expected);
    return words;
  }

  int integer(std::string_view word, const std::string& expected) const {
    int value = -1;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < 0) {
      fail("has " + quoted(word), expected);
    }
    return value;
  }

  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw std::invalid_argument("line " + std::to_string(number_) + " " + found + ", expected " +
                                expected);
  }

 private:
  static std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> words;
    while (true) {
      const std::size_t first = line.find_first_not_of(" \t\r\v\f");
      if (first == std::string_view::npos) return words;
      line.remove_prefix(first);
      const std::size_t end = std::min(line.find_first_of(" \t\r\v\f"), line.size());
      words.push_back(line.substr(0, end));
      line.remove_prefix(end);
    }
  }

  std::string_view rest_;
  int number_ = 0;
};

// Reads the classes and their models one after the other.
class Parser {
 public:
  explicit Parser(std::string_view text) : lines_(text) {}

  Classification parse() {
    const auto head = lines_.next(2, "'PSB 1'");
    if (head[0] != "PSB" || head[1] != "1") {
      lines_.fail("is " + quoted(std::string(head[0]) + ' ' + std::string(head[1])), "'PSB 1'");
    }
    const auto counts = lines_.next(2, "the numbers of classes and models");
    const int classes = lines_.integer(counts[0], "a number of classes");
    const int models = lines_.integer(counts[1], "a number of models");
    for (int c = 0; c < classes; ++c) read_class(c, classes);
    if (!lines_.next().empty()) {
      lines_.fail("follows the last class",
                  "nothing after the " + std::to_string(classes) + " classes of the head");
    }
    if (static_cast<int>(result_.models.size()) != models) {
      throw std::invalid_argument("has " + std::to_string(result_.models.size()) +
                                  " models, expected " + std::to_string(models) +
                                  ", the number in its head");
    }
    return std::move(result_);
  }

 private:
  void read_class(int c, int classes) {
    const auto words =
        lines_.next(3, "class " + std::to_string(c + 1) + " of " + std::to_string(classes) +
                           ": name, parent, number of models");
    Classification::Class one;
    one.name = words[0];
    one.full_name = one.name;
    if (words[1] != "0") {
      const auto parent = places_.find(words[1]);
      if (parent == places_.end()) {
        lines_.fail("has the parent " + quoted(words[1]), "0 or a class before it");
      }
      one.parent = parent->second;
      one.full_name =
          result_.classes[static_cast<std::size_t>(one.parent)].full_name + '/' + one.name;
    }
    one.models = lines_.integer(words[2], "a number of models");
    if (!full_names_.insert({one.full_name, c}).second) {
      lines_.fail("names the class " + quoted(one.full_name) + " again", "another name");
    }
    places_[one.name] = c;
    const int count = one.models;
    const std::string name = one.full_name;
    result_.classes.push_back(std::move(one));
    for (int i = 0; i < count; ++i) read_model(c, i, count, name);
  }

  void read_model(int c, int i, int count, const std::string& name) {
    const auto id = lines_.next(1, "model " + std::to_string(i + 1) + " of the " +
                                       std::to_string(count) + " of class " + quoted(name));
    const auto [place, is_new] = of_model_.insert({std::string(id[0]), c});
    if (!is_new) {
      lines_.fail("has model " + quoted(id[0]) + ", which class " +
                      quoted(result_.classes[static_cast<std::size_t>(place->second)].full_name) +
                      " has",
                  "each model once");
    }
    result_.models.push_back({place->first, c});
  }

  Lines lines_;
  Classification result_;
  std::map<std::string, int, std::less<>> places_, full_names_, of_model_;
};

}  // namespace

Labels Classification::labels() const {
  Labels result;
  result.reserve(models.size());
  for (const Model& model : models) result.push_back(model.of_class);
  return result;
}

Classification parse_classification(std::string_view text) { return Parser(text).parse(); }

}  // namespace shape3d::learning
