#include "text_scanner.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "error.hpp"

namespace shape3d::apps {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

template <class Number>
bool parse_number(std::string_view word, Number& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [last, error] = std::from_chars(word.data(), end, value);
  return error == std::errc{} && last == end;
}

}  // namespace

std::string shown(std::string_view word) {
  std::string text(word.substr(0, 40));
  for (char& c : text) {
    if (c < 32 || c > 126) c = '?';
  }
  return word.size() > 40 ? text + "…" : text;
}

bool TextScanner::skip_blanks() {
  while (at_ != end_ && is_blank(*at_)) ++at_;
  if (at_ != end_ && comment_ != '\0' && *at_ == comment_) at_ = std::find(at_, end_, '\n');
  return at_ != end_ && *at_ != '\n';
}

bool TextScanner::skip_space() {
  while (!skip_blanks()) {
    if (at_ == end_) return false;
    ++at_;
  }
  return true;
}

std::string_view TextScanner::rest_of_line() {
  const char* start = at_;
  const char* stop = std::find(at_, end_, '\n');
  at_ = stop == end_ ? end_ : stop + 1;
  while (start != stop && is_blank(*start)) ++start;
  while (stop != start && is_blank(stop[-1])) --stop;
  return {start, static_cast<std::size_t>(stop - start)};
}

std::string_view TextScanner::next_word() {
  const char* start = at_;
  while (at_ != end_ && !is_blank(*at_) && *at_ != '\n') ++at_;
  return {start, static_cast<std::size_t>(at_ - start)};
}

std::string_view TextScanner::word(std::string_view expected) {
  if (!skip_space()) fail("expected " + std::string(expected) + ", found the end of the file");
  return next_word();
}

double TextScanner::number(std::string_view expected) {
  const std::string_view found = word(expected);
  double value = 0.0;
  if (!parse(found, value)) {
    at_ = found.data();
    fail(std::string(expected) + " (a finite number)", found);
  }
  return value;
}

std::int64_t TextScanner::integer(std::string_view expected) {
  const std::string_view found = word(expected);
  std::int64_t value = 0;
  if (!parse(found, value)) {
    at_ = found.data();
    fail(std::string(expected) + " (an integer)", found);
  }
  return value;
}

bool TextScanner::parse(std::string_view word, double& value) {
  if (parse_number(word, value)) return std::isfinite(value);
  // from_chars leaves the value alone where it underflows; such a number is as good as zero.
  if (word.size() > 1 && word[0] == '+') word.remove_prefix(1);
  double unused = 0.0;
  const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), unused);
  if (error != std::errc::result_out_of_range || last != word.data() + word.size()) return false;
  const std::size_t exponent = word.find_first_of("eE");
  const bool tiny = exponent != std::string_view::npos
                        ? word.find('-', exponent) != std::string_view::npos
                        : std::abs(unused) < 1.0 && word.find("0.") < 2;
  if (tiny) value = 0.0;
  return tiny;
}

bool TextScanner::parse(std::string_view word, std::int64_t& value) {
  return parse_number(word, value);
}

std::int64_t TextScanner::line() const { return 1 + std::count(begin_, at_, '\n'); }

void TextScanner::fail(std::string_view expected, std::string_view found) const {
  fail("expected " + std::string(expected) + ", found '" + shown(found) + "'");
}

void TextScanner::fail(const std::string& sentence) const {
  throw FileError(name_, "line " + std::to_string(line()) + ": " + sentence);
}

}  // namespace shape3d::apps
