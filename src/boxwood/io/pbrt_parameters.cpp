#include "boxwood/io/pbrt_parameters.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace boxwood::io::pbrt {
namespace {

enum class Value { numbers, strings, booleans, numbers_or_strings };

struct Type {
  std::string_view name;
  Value value;
  std::size_t multiple_of;  // numbers come in groups of this many
};

// Both versions of the format;
// 3 says "color", "point" and "vector" for what 4 calls "rgb", "point3" and "vector3".
constexpr std::array kTypes = {
    Type{"integer", Value::numbers, 1},
    Type{"float", Value::numbers, 1},
    Type{"point2", Value::numbers, 2},
    Type{"vector2", Value::numbers, 2},
    Type{"point3", Value::numbers, 3},
    Type{"vector3", Value::numbers, 3},
    Type{"normal3", Value::numbers, 3},
    Type{"point", Value::numbers, 3},
    Type{"vector", Value::numbers, 3},
    Type{"normal", Value::numbers, 3},
    Type{"rgb", Value::numbers, 3},
    Type{"color", Value::numbers, 3},
    Type{"xyz", Value::numbers, 3},
    Type{"blackbody", Value::numbers, 1},
    Type{"spectrum", Value::numbers_or_strings, 2},
    Type{"string", Value::strings, 1},
    Type{"texture", Value::strings, 1},
    Type{"bool", Value::booleans, 1},
};

const Type* find_type(std::string_view name) {
  const auto* found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const Type& type) { return type.name == name; });
  return found != kTypes.end() ? found : nullptr;
}

/// "type name" as two words.
std::array<std::string_view, 2> split_declaration(std::string_view text) {
  constexpr const char* kBlanks = " \t";
  std::array<std::string_view, 2> words;
  for (std::string_view& word : words) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    word = text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(word.size());
  }
  if (text.find_first_not_of(kBlanks) != std::string_view::npos) words[1] = {};
  return words;
}

}  // namespace

void Warnings::once(const Place& place, const std::string& message) {
  if (std::find(seen_.begin(), seen_.end(), message) != seen_.end()) return;
  seen_.push_back(message);
  lines_.push_back(*place.path + ":" + std::to_string(place.line) + ": " + message);
}

double number_of(const Tokenizer& tokenizer, const Token& token) {
  std::string_view text = token.text;
  if (token.kind == Token::Kind::word) {
    // Scripts write lists with commas, which pbrt reads over.
    if (text.size() > 1 && text.back() == ',') text.remove_suffix(1);
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = end == text.data() + text.size();
    if (is_whole && error == std::errc() && std::fabs(value) <= std::numeric_limits<float>::max())
      return value;
    // from_chars calls what is nearer to 0 than any double out of range too.
    if (is_whole && error == std::errc::result_out_of_range &&
        text.find_first_of("eE") != std::string_view::npos &&
        text.find("-", text.find_first_of("eE")) != std::string_view::npos)
      return 0;
  }
  fail(tokenizer.place(token), describe(token) + " is not a number that a float can hold");
}

Parameter read_parameter(Tokenizer& tokenizer, Token& token) {
  const Place place = tokenizer.place(token);
  const std::array<std::string_view, 2> words = split_declaration(token.text);
  const std::string_view type_name = words[0], name = words[1];
  if (type_name.empty() || name.empty())
    fail(place,
         in_quotes(token.text) + " is not a parameter, expected a type and a name such as \"float fov\"");
  const Type* type = find_type(type_name);
  if (type == nullptr) fail(place, in_quotes(token.text) + " has the unknown type " + in_quotes(type_name));
  Parameter parameter{std::string(type_name), std::string(name), place, {}, {}};

  // The value: one token, or any number of them in brackets.
  const auto take = [&](const Token& value) {
    const bool is_string = value.kind == Token::Kind::string;
    if (type->value == Value::booleans) {
      if (value.text != "true" && value.text != "false")
        fail(tokenizer.place(value), in_quotes(name) + " is " + describe(value) + ", expected true or false");
      parameter.strings.emplace_back(value.text);
    } else if (is_string && type->value != Value::numbers) {
      parameter.strings.emplace_back(value.text);
    } else if (!is_string && type->value != Value::strings) {
      parameter.numbers.push_back(number_of(tokenizer, value));
    } else {
      fail(tokenizer.place(value), in_quotes(name) + " holds " + describe(value) + ", expected " +
                                       (is_string ? "numbers" : "a string"));
    }
  };
  token = tokenizer.next();
  if (token.kind == Token::Kind::open) {
    for (token = tokenizer.next(); token.kind != Token::Kind::close; token = tokenizer.next()) {
      if (token.kind == Token::Kind::end || token.kind == Token::Kind::open)
        fail(place, in_quotes(name) + " is a list without ']': found " + describe(token) + " on line " +
                        std::to_string(token.line));
      take(token);
    }
  } else if (token.kind == Token::Kind::word || token.kind == Token::Kind::string) {
    take(token);
  } else {
    fail(place, in_quotes(name) + " has no value: found " + describe(token));
  }
  token = tokenizer.next();

  if (!parameter.numbers.empty() && !parameter.strings.empty())
    fail(place, in_quotes(name) + " mixes numbers and strings");
  if (parameter.numbers.size() % type->multiple_of != 0)
    fail(place, in_quotes(name) + " has " + std::to_string(parameter.numbers.size()) +
                    " numbers, expected a multiple of " + std::to_string(type->multiple_of) +
                    " for the type " + in_quotes(type_name));
  return parameter;
}

void ParameterList::add_defaults(const ParameterList& defaults) {
  for (const Parameter& parameter : defaults.parameters_) {
    parameters_.push_back(parameter);
    // Given for all subjects of a kind, so not all of them have a use for it.
    parameters_.back().is_used = true;
  }
}

const Parameter* ParameterList::find(std::string_view name) const {
  const Parameter* found = nullptr;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const Parameter& parameter = parameters_[i];
    if (parameter.name != name) continue;
    parameter.is_used = true;
    if (found == nullptr || i < given_) found = &parameter;
  }
  return found;
}

const Parameter* ParameterList::find_numbers(std::string_view name, std::size_t multiple_of,
                                             bool is_single) const {
  const Parameter* found = find(name);
  if (found == nullptr) return nullptr;
  if (!found->strings.empty())
    fail(found->place, in_quotes(name) + " is " + in_quotes(found->strings[0]) + " of type " +
                           in_quotes(found->type) + ", expected numbers");
  const std::size_t count = found->numbers.size();
  if (is_single ? count != multiple_of : count % multiple_of != 0)
    fail(found->place, in_quotes(name) + " has " + std::to_string(count) + " numbers, expected " +
                           (is_single ? "" : "a multiple of ") + std::to_string(multiple_of));
  return found;
}

float ParameterList::number(std::string_view name, float otherwise) const {
  const Parameter* found = find_numbers(name, 1, true);
  if (found == nullptr) return otherwise;
  return static_cast<float>(found->numbers[0]);
}

int ParameterList::integer(std::string_view name, int otherwise) const {
  const Parameter* found = find_numbers(name, 1, true);
  if (found == nullptr) return otherwise;
  const double value = found->numbers[0];
  if (value != std::floor(value) || std::fabs(value) > 0x1p30)
    fail(found->place,
         in_quotes(name) + " is " + std::to_string(value) + ", expected a whole number of at most 2^30");
  return static_cast<int>(value);
}

bool ParameterList::boolean(std::string_view name, bool otherwise) const {
  const Parameter* found = find(name);
  if (found == nullptr) return otherwise;
  if (found->type != "bool" || found->strings.size() != 1)
    fail(found->place, in_quotes(name) + " is not one \"bool\" value");
  return found->strings[0] == "true";
}

std::string ParameterList::string(std::string_view name, const std::string& otherwise) const {
  const Parameter* found = find(name);
  if (found == nullptr) return otherwise;
  if (found->type != "string" || found->strings.size() != 1)
    fail(found->place, in_quotes(name) + " is not one \"string\" value");
  return found->strings[0];
}

Vec3 ParameterList::vector(std::string_view name, Vec3 otherwise) const {
  const Parameter* found = find_numbers(name, 3, true);
  if (found == nullptr) return otherwise;
  return {float(found->numbers[0]), float(found->numbers[1]), float(found->numbers[2])};
}

std::vector<Vec2> ParameterList::vectors2(std::string_view name) const {
  const Parameter* found = find_numbers(name, 2, false);
  std::vector<Vec2> out(found != nullptr ? found->numbers.size() / 2 : 0);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {float(found->numbers[2 * i]), float(found->numbers[2 * i + 1])};
  return out;
}

std::vector<Vec3> ParameterList::vectors3(std::string_view name) const {
  const Parameter* found = find_numbers(name, 3, false);
  std::vector<Vec3> out(found != nullptr ? found->numbers.size() / 3 : 0);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {float(found->numbers[3 * i]), float(found->numbers[3 * i + 1]),
              float(found->numbers[3 * i + 2])};
  return out;
}

std::vector<std::uint32_t> ParameterList::indices(std::string_view name, std::size_t limit) const {
  const Parameter* found = find_numbers(name, 1, false);
  std::vector<std::uint32_t> out(found != nullptr ? found->numbers.size() : 0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double value = found->numbers[i];
    if (!(value >= 0 && value < double(limit)) || value != std::floor(value))
      fail(found->place, in_quotes(name) + ", number " + std::to_string(i) + " is " + std::to_string(value) +
                             ", expected the position of one of the " + std::to_string(limit) + " vertices");
    out[i] = static_cast<std::uint32_t>(value);
  }
  return out;
}

void ParameterList::ignore(std::initializer_list<const char*> names) const {
  for (const char* name : names) (void)find(name);
}

void ParameterList::warn_unused(const std::string& subject, Warnings& warnings) const {
  for (const Parameter& parameter : parameters_)
    if (!parameter.is_used)
      warnings.once(parameter.place, subject + ": the parameter " + in_quotes(parameter.name) +
                                         " is not supported and has no effect");
}

}  // namespace boxwood::io::pbrt
