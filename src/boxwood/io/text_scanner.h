// text_scanner.h: what is the next word of this text, and on which line?
//
// One pass over text in memory, word by word, for the formats that people can read. Numbers go through
// std::from_chars: the nearest float whatever the locale is. Whatever is wrong is reported with the line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace boxwood::io {

class TextScanner {
 public:
  /// Both must outlive the scanner; `path` is for messages.
  TextScanner(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  /// The next word of the current line; empty at its end.
  /// A backslash at the end of a line joins it with the next.
  std::string_view word_on_line();
  /// The next word of this line or any after it; empty at the end of the text.
  std::string_view word();
  /// What is left of the line, without spaces around it.
  std::string_view rest_of_line();
  /// Moves to the start of the next line; false at the end of the text.
  bool next_line();

  /// Counts from 1.
  std::size_t line() const { return line_; }
  /// The byte at which the next word is looked for.
  std::size_t offset() const { return at_; }

  /// Throws FileError that names the file and the current line.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  std::string_view text_;
  const std::string& path_;
  std::size_t at_ = 0, line_ = 1;
};

/// Reads the whole word as a number; false where it is none. Numbers too large for a float become infinite
/// and numbers too small zero; "nan" and "inf" are read as what they say.
bool parse_float(std::string_view word, float& value);
bool parse_int(std::string_view word, std::int64_t& value);

/// The word in quotes for a message, shortened, with what cannot be printed shown as '?'.
std::string in_quotes(std::string_view word);

}  // namespace boxwood::io
