#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace shape3d::apps {

/// Reads words and numbers from text in memory; '\r' and tabs are blanks. Errors are FileErrors
/// that name the line, what was expected and what stands there.
class TextScanner {
 public:
  /// @param comment  Starts a comment that ends with its line; '\0' for none.
  TextScanner(std::string_view text, std::string name, char comment = '#')
      : begin_(text.data()),
        at_(text.data()),
        end_(text.data() + text.size()),
        name_(std::move(name)),
        comment_(comment) {}

  /// Skips blanks, line ends and comments. @return whether anything is left.
  bool skip_space();
  /// Skips blanks and a comment, not the line end. @return whether a word follows in this line.
  bool skip_blanks();
  /// Goes to the start of the next line; the rest of this one without line end and trailing blanks.
  std::string_view rest_of_line();

  /// Next word, over line ends. @throws FileError  at the end of the text.
  std::string_view word(std::string_view expected);
  /// Next word as a finite number. @throws FileError
  double number(std::string_view expected);
  /// Next word as an integer. @throws FileError
  std::int64_t integer(std::string_view expected);

  /// Whether all of a word is a finite decimal number.
  static bool parse(std::string_view word, double& value);
  static bool parse(std::string_view word, std::int64_t& value);

  [[nodiscard]] bool at_end() const { return at_ == end_; }
  [[nodiscard]] std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Number of the line of the next byte, from 1; counts line ends anew at each call.
  [[nodiscard]] std::int64_t line() const;

  /// "NAME: line N: expected EXPECTED, found 'WORD'".
  [[noreturn]] void fail(std::string_view expected, std::string_view found) const;
  /// "NAME: line N: SENTENCE".
  [[noreturn]] void fail(const std::string& sentence) const;

 private:
  std::string_view next_word();

  const char* begin_;
  const char* at_;
  const char* end_;
  std::string name_;
  char comment_;
};

/// A word as shown in an error: at most 40 bytes, unprintable ones as '?'.
[[nodiscard]] std::string shown(std::string_view word);

}  // namespace shape3d::apps
