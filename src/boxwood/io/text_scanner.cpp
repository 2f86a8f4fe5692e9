#include "boxwood/io/text_scanner.h"

#include <charconv>
#include <limits>

#include "boxwood/core/error.h"

namespace boxwood::io {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

// std::from_chars takes no leading plus.
std::string_view without_plus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

}  // namespace

std::string_view TextScanner::word_on_line() {
  // Skip blanks, and the end of the line too where a backslash joins it with the next.
  while (at_ < text_.size()) {
    if (is_blank(text_[at_])) {
      ++at_;
      continue;
    }
    if (text_[at_] != '\\') break;
    std::size_t end = at_ + 1;
    if (end < text_.size() && text_[end] == '\r') ++end;
    if (end >= text_.size() || text_[end] != '\n') break;
    at_ = end + 1;
    ++line_;
  }

  const std::size_t begin = at_;
  while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n') ++at_;
  return text_.substr(begin, at_ - begin);
}

std::string_view TextScanner::word() {
  for (;;) {
    const std::string_view found = word_on_line();
    if (!found.empty() || !next_line()) return found;
  }
}

std::string_view TextScanner::rest_of_line() {
  while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  const std::size_t begin = at_;
  while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  std::string_view rest = text_.substr(begin, at_ - begin);
  while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
  return rest;
}

bool TextScanner::next_line() {
  const std::size_t end = text_.find('\n', at_);
  if (end == std::string_view::npos || end + 1 == text_.size()) {
    at_ = text_.size();
    return false;
  }
  at_ = end + 1;
  ++line_;
  return true;
}

void TextScanner::fail(const std::string& message) const {
  throw FileError(path_, "line " + std::to_string(line_), message);
}

bool parse_float(std::string_view word, float& value) {
  word = without_plus(word);
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument) return false;

  // Out of range is either too large or too small: a negative exponent tells which, and where there is no
  // exponent a number that begins with zero is the small one.
  if (error == std::errc::result_out_of_range) {
    const bool is_negative = word.front() == '-';
    const std::size_t exponent = word.find_first_of("eE");
    const bool is_small = exponent != std::string_view::npos
                              ? exponent + 1 < word.size() && word[exponent + 1] == '-'
                              : word[is_negative ? 1 : 0] == '0' || word[is_negative ? 1 : 0] == '.';
    value = is_small ? 0.0f : std::numeric_limits<float>::infinity();
    if (is_negative) value = -value;
  }
  return true;
}

bool parse_int(std::string_view word, std::int64_t& value) {
  word = without_plus(word);
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  return stop == end && error == std::errc();
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t kMost = 40;
  std::string shown = "'";
  for (const char c : word.substr(0, kMost)) shown += ' ' <= c && c <= '~' ? c : '?';
  return shown + (word.size() > kMost ? "...'" : "'");
}

}  // namespace boxwood::io
