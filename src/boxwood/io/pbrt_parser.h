// pbrt_parser.h: which directives does a scene give, in which order?
//
// Knows the grammar (what follows each directive's name) and the files: an Include is read where it stands,
// by a stack of open files and not by recursion, so that hostile nesting ends in a message.
#pragma once

#include <filesystem>
#include <memory>

#include "boxwood/io/pbrt_parameters.h"

namespace boxwood::io::pbrt {

/// One statement of a scene, such as `Shape "sphere" "float radius" 2`.
struct Directive {
  std::string name;
  Place place;
  std::vector<std::string> strings;  ///< What stands before the parameters.
  std::vector<double> numbers;       ///< For Translate, LookAt, Transform, ...
  ParameterList parameters;

  /// How messages name it: its name, and its kind when it has one.
  std::string subject() const { return strings.empty() ? name : name + " " + in_quotes(strings.back()); }
};

class Parser {
 public:
  /// Throws FileError when the file cannot be read.
  explicit Parser(const std::filesystem::path& path);

  /// Reads the next directive of any kind but Include and Import, which it follows itself. False at the end.
  /// Throws FileError for what the grammar does not allow, and for includes that are missing, nested in a
  /// circle, or too many.
  bool next(Directive& directive);

  /// The file that a name in the scene stands for: relative names start at the main file's folder.
  std::filesystem::path resolve(const std::string& name) const;

 private:
  void open(const std::filesystem::path& path);
  void include(const Directive& directive);

  struct OpenFile {
    std::filesystem::path path;  // canonical, to tell whether two names mean the same file
    std::unique_ptr<Tokenizer> tokenizer;
    Token token;  // read, not yet used
  };
  std::filesystem::path folder_;
  std::vector<OpenFile> files_;    // innermost last
  std::deque<std::string> paths_;  // of every file ever opened: Places point here
  std::size_t included_ = 0;
  Place place_;  // of the last token that was looked at
};

}  // namespace boxwood::io::pbrt
