#pragma once

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace shape3d::bench {

/// A number in the fixed notation of printf.
inline std::string fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// A table of texts: the first column to the left, the others to the right.
class MarkdownTable {
 public:
  explicit MarkdownTable(std::vector<std::string> head) : columns_(head.size()) {
    text_ = line(head);
    text_ += "|:--|";
    for (std::size_t c = 1; c < columns_; ++c) text_ += "--:|";
    text_ += '\n';
  }
  void add(std::vector<std::string> cells) {
    cells.resize(columns_);
    text_ += line(cells);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static std::string line(const std::vector<std::string>& cells) {
    std::string text = "|";
    for (const std::string& cell : cells) text += ' ' + (cell.empty() ? "–" : cell) + " |";
    return text + '\n';
  }

  std::size_t columns_;
  std::string text_;
};

}  // namespace shape3d::bench
