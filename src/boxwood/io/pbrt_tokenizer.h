// pbrt_tokenizer.h: what are the words of a pbrt file?
//
// The format is a stream of bare words and numbers, strings in quotes, and brackets; `#` starts a comment
// that ends with the line. Every token knows its line, so that every later message can name the place.
#pragma once

#include <deque>
#include <string>
#include <string_view>

#include "boxwood/core/error.h"

namespace boxwood::io::pbrt {

/// A line of a file; the path outlives every Place that points to it (the parser keeps it).
struct Place {
  const std::string* path = nullptr;
  int line = 0;
};

[[noreturn]] void fail(const Place& place, const std::string& message);

/// The text in double quotes, as messages show names; what is very long is cut.
std::string in_quotes(std::string_view text);

struct Token {
  enum class Kind { end, word, string, open, close };  // a number is a word
  Kind kind = Kind::end;
  std::string_view text;  ///< Without quotes; valid as long as the tokenizer.
  int line = 0;
};

/// How messages show a token.
std::string describe(const Token& token);

class Tokenizer {
 public:
  /// `path` is for messages and must outlive the tokenizer.
  Tokenizer(const std::string& path, std::string bytes) : path_(path), bytes_(std::move(bytes)) {}
  Tokenizer(const Tokenizer&) = delete;
  Tokenizer& operator=(const Tokenizer&) = delete;

  /// Throws FileError at a string that does not end on its line,
  /// or that holds an escape sequence that means nothing.
  Token next();

  const std::string& path() const { return path_; }
  Place place(const Token& token) const { return {&path_, token.line}; }

 private:
  void skip_blanks();
  Token read_string();

  const std::string& path_;
  std::string bytes_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::deque<std::string> unescaped_;  // strings that differ from what the file holds
};

}  // namespace boxwood::io::pbrt
