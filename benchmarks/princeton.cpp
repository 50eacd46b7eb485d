#include "princeton.hpp"

#include <fstream>
#include <map>
#include <sstream>

#include "common/error.hpp"

namespace shape3d::bench {
namespace {

// Lines of words; blank lines and comments are passed over.
class Lines {
 public:
  explicit Lines(const std::string& path) : path_(path), file_(path) {
    if (!file_) throw apps::FileError(path, "cannot be opened for reading");
  }

  // The next line of exactly `count` words.
  std::vector<std::string> next(std::size_t count, const std::string& expected) {
    std::string line;
    while (std::getline(file_, line)) {
      ++number_;
      std::istringstream stream(line.substr(0, line.find('#')));
      std::vector<std::string> words;
      for (std::string word; stream >> word;) words.push_back(word);
      if (words.empty()) continue;
      if (words.size() != count) fail("is '" + line + "'", expected);
      return words;
    }
    fail("is missing", expected);
  }

  int integer(const std::string& word, const std::string& expected) {
    try {
      std::size_t used = 0;
      const int value = std::stoi(word, &used);
      if (used == word.size() && value >= 0) return value;
    } catch (const std::exception&) {
      // Said below.
    }
    fail("has '" + word + "'", expected);
  }

  [[noreturn]] void fail(const std::string& found, const std::string& expected) {
    throw apps::FileError(
        path_, "line " + std::to_string(number_) + " " + found + ", expected " + expected);
  }

 private:
  std::string path_;
  std::ifstream file_;
  int number_ = 0;
};

}  // namespace

Classification read_classification(const std::string& path) {
  Lines lines(path);
  const auto head = lines.next(2, "'PSB 1'");
  if (head[0] != "PSB" || head[1] != "1")
    lines.fail("is '" + head[0] + ' ' + head[1] + "'", "'PSB 1'");
  const auto counts = lines.next(2, "the numbers of classes and models");
  const int class_count = lines.integer(counts[0], "a number of classes");
  const int model_count = lines.integer(counts[1], "a number of models");

  Classification result;
  std::map<std::string, std::string> full_names;
  for (int c = 0; c < class_count; ++c) {
    const auto words = lines.next(3, "a class: name, parent, number of models");
    const auto parent = full_names.find(words[1]);
    const std::string name =
        parent == full_names.end() ? words[0] : parent->second + '/' + words[0];
    full_names[words[0]] = name;
    const int members = lines.integer(words[2], "a number of models");
    if (members > 0) result.classes.push_back(name);
    for (int i = 0; i < members; ++i) {
      const auto id = lines.next(1, "the number of a model");
      result.models.push_back(
          {lines.integer(id[0], "the number of a model"), result.classes.size() - 1});
    }
  }
  if (static_cast<int>(result.models.size()) != model_count) {
    throw apps::FileError(path, "has " + std::to_string(result.models.size()) +
                                    " models, expected " + std::to_string(model_count));
  }
  return result;
}

std::string model_path(const std::string& folder, int id) {
  const std::string name = "m" + std::to_string(id);
  return folder + '/' + std::to_string(id / 100) + '/' + name + '/' + name + ".off";
}

}  // namespace shape3d::bench
