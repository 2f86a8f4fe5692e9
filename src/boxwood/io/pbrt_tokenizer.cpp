#include "boxwood/io/pbrt_tokenizer.h"

namespace boxwood::io::pbrt {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}
bool ends_word(char c) {
  return is_blank(c) || c == '"' || c == '[' || c == ']' || c == '#';
}

}  // namespace

void fail(const Place& place, const std::string& message) {
  throw FileError(*place.path, std::to_string(place.line), message);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 80;
  std::string out = "\"";
  for (const char c : text.substr(0, kLongest))  // bytes that a terminal would obey are shown as dots
    out += static_cast<unsigned char>(c) < 32 || c == 127 ? '.' : c;
  return out + (text.size() > kLongest ? "...\"" : "\"");
}

std::string describe(const Token& token) {
  switch (token.kind) {
    case Token::Kind::end:
      return "the end of the file";
    case Token::Kind::open:
      return "'['";
    case Token::Kind::close:
      return "']'";
    case Token::Kind::string:
      return "the string " + in_quotes(token.text);
    case Token::Kind::word:
      break;
  }
  return in_quotes(token.text);
}

void Tokenizer::skip_blanks() {
  for (; at_ < bytes_.size(); ++at_) {
    if (bytes_[at_] == '#')
      while (at_ + 1 < bytes_.size() && bytes_[at_ + 1] != '\n') ++at_;
    else if (bytes_[at_] == '\n')
      ++line_;
    else if (!is_blank(bytes_[at_]))
      return;
  }
}

Token Tokenizer::next() {
  skip_blanks();
  if (at_ == bytes_.size()) return {Token::Kind::end, {}, line_};
  const char first = bytes_[at_];
  if (first == '"') return read_string();
  const std::size_t begin = at_++;
  if (first == '[') return {Token::Kind::open, "[", line_};
  if (first == ']') return {Token::Kind::close, "]", line_};
  while (at_ < bytes_.size() && !ends_word(bytes_[at_])) ++at_;
  return {Token::Kind::word, std::string_view(bytes_).substr(begin, at_ - begin), line_};
}

Token Tokenizer::read_string() {
  const std::size_t begin = ++at_;
  bool has_escapes = false;
  for (; at_ < bytes_.size() && bytes_[at_] != '"' && bytes_[at_] != '\n'; ++at_)
    if (bytes_[at_] == '\\' && at_ + 1 < bytes_.size() && bytes_[at_ + 1] != '\n') {
      has_escapes = true;
      ++at_;  // whatever follows does not end the string
    }
  const std::string_view raw = std::string_view(bytes_).substr(begin, at_ - begin);
  if (at_ == bytes_.size() || bytes_[at_] == '\n')
    fail({&path_, line_}, "the string " + in_quotes(raw) + " has no closing quote on its line");
  ++at_;
  if (!has_escapes) return {Token::Kind::string, raw, line_};

  // Replace the escape sequences in a copy that lives as long as the tokenizer.
  std::string& text = unescaped_.emplace_back();
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] != '\\') {
      text += raw[i];
      continue;
    }
    switch (raw[++i]) {
      case 'n':
        text += '\n';
        break;
      case 't':
        text += '\t';
        break;
      case 'r':
        text += '\r';
        break;
      case 'b':
        text += '\b';
        break;
      case 'f':
        text += '\f';
        break;
      case '\\':
        text += '\\';
        break;
      case '\'':
        text += '\'';
        break;
      case '"':
        text += '"';
        break;
      default:
        fail({&path_, line_}, "the string " + in_quotes(raw) + " holds the unknown escape sequence \\" +
                                  std::string(1, raw[i]));
    }
  }
  return {Token::Kind::string, text, line_};
}

}  // namespace boxwood::io::pbrt
