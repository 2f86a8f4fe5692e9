// pbrt_parameters.h: what did a directive say about its subject?
//
// Most directives end in a list of `"type name" value` pairs. A ParameterList answers "what is `fov`?" with a
// default, and remembers what it was asked: what nobody asked for is what this reader does not support, and
// it says so.
#pragma once

#include <span>
#include <vector>

#include "boxwood/core/vec.h"
#include "boxwood/io/pbrt_tokenizer.h"
#include "boxwood/scene/description.h"

namespace boxwood::io::pbrt {

/// Collects what a scene must do without; each message is kept once, with the place where it first arose.
class Warnings {
 public:
  explicit Warnings(std::vector<std::string>& lines) : lines_(lines) {}
  void once(const Place& place, const std::string& message);

 private:
  std::vector<std::string>& lines_;
  std::vector<std::string> seen_;
};

/// One `"type name" value`. A value is numbers, or strings; booleans are the strings "true" and "false".
struct Parameter {
  std::string type, name;
  Place place;
  std::vector<double> numbers;
  std::vector<std::string> strings;
  mutable bool is_used = false;
};

/// Reads the type and value that follow a declaration such as "float fov". Throws FileError for a type that
/// is unknown and for values that do not fit it. `token` is the declaration; on return, the first token after
/// the value.
Parameter read_parameter(Tokenizer& tokenizer, Token& token);

/// The number that a word stands for. Throws FileError when it is none, not finite, or too large for a float.
double number_of(const Tokenizer& tokenizer, const Token& token);

class ParameterList {
 public:
  /// Precondition: no defaults were added yet.
  void add(Parameter parameter) {
    parameters_.push_back(std::move(parameter));
    ++given_;
  }
  /// Adds defaults: they answer only for names that are not there yet.
  void add_defaults(const ParameterList& defaults);

  /// The parameter of this name, the last where it is given twice, marked as used; null when there is none.
  const Parameter* find(std::string_view name) const;

  // Each throws FileError when the parameter is there with another type or another count.
  float number(std::string_view name, float otherwise) const;
  int integer(std::string_view name, int otherwise) const;
  bool boolean(std::string_view name, bool otherwise) const;
  std::string string(std::string_view name, const std::string& otherwise) const;
  Vec3 vector(std::string_view name, Vec3 otherwise) const;
  std::vector<Vec2> vectors2(std::string_view name) const;  ///< Empty when absent.
  std::vector<Vec3> vectors3(std::string_view name) const;  ///< Empty when absent.
  /// Each in [0, limit); empty when absent.
  std::vector<std::uint32_t> indices(std::string_view name, std::size_t limit) const;

  /// Marks names that change nothing in a picture of ours.
  void ignore(std::initializer_list<const char*> names) const;
  /// Warns of every parameter that was not asked for. `subject`: whose they are.
  void warn_unused(const std::string& subject, Warnings& warnings) const;

  std::span<const Parameter> all() const { return parameters_; }

 private:
  const Parameter* find_numbers(std::string_view name, std::size_t multiple_of, bool is_single) const;

  std::vector<Parameter> parameters_;
  std::size_t given_ = 0;  // before the defaults
};

}  // namespace boxwood::io::pbrt
