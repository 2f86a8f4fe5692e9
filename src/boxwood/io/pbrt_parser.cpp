#include "boxwood/io/pbrt_parser.h"

#include <algorithm>
#include <array>

#include "boxwood/io/file_bytes.h"

namespace boxwood::io::pbrt {
namespace {

/// What follows a directive's name: numbers, or strings and then perhaps parameters.
struct Grammar {
  std::string_view name;
  int numbers;
  int least_strings, most_strings;
  bool has_parameters;
};

constexpr std::array kGrammar = {
    Grammar{"Identity", 0, 0, 0, false},
    Grammar{"Translate", 3, 0, 0, false},
    Grammar{"Scale", 3, 0, 0, false},
    Grammar{"Rotate", 4, 0, 0, false},
    Grammar{"LookAt", 9, 0, 0, false},
    Grammar{"Transform", 16, 0, 0, false},
    Grammar{"ConcatTransform", 16, 0, 0, false},
    Grammar{"TransformTimes", 2, 0, 0, false},
    Grammar{"CoordinateSystem", 0, 1, 1, false},
    Grammar{"CoordSysTransform", 0, 1, 1, false},
    Grammar{"ActiveTransform", 0, 1, 1, false},
    Grammar{"TransformBegin", 0, 0, 0, false},
    Grammar{"TransformEnd", 0, 0, 0, false},
    Grammar{"AttributeBegin", 0, 0, 0, false},
    Grammar{"AttributeEnd", 0, 0, 0, false},
    Grammar{"Attribute", 0, 1, 1, true},
    Grammar{"ReverseOrientation", 0, 0, 0, false},
    Grammar{"WorldBegin", 0, 0, 0, false},
    Grammar{"WorldEnd", 0, 0, 0, false},
    Grammar{"ObjectBegin", 0, 1, 1, false},
    Grammar{"ObjectEnd", 0, 0, 0, false},
    Grammar{"ObjectInstance", 0, 1, 1, false},
    Grammar{"Include", 0, 1, 1, false},
    Grammar{"Import", 0, 1, 1, false},
    Grammar{"Camera", 0, 1, 1, true},
    Grammar{"Film", 0, 1, 1, true},
    Grammar{"Sampler", 0, 1, 1, true},
    Grammar{"Integrator", 0, 1, 1, true},
    Grammar{"SurfaceIntegrator", 0, 1, 1, true},
    Grammar{"VolumeIntegrator", 0, 1, 1, true},
    Grammar{"Renderer", 0, 1, 1, true},
    Grammar{"PixelFilter", 0, 1, 1, true},
    Grammar{"Accelerator", 0, 1, 1, true},
    Grammar{"ColorSpace", 0, 1, 1, false},
    Grammar{"Option", 0, 0, 0, true},
    Grammar{"Shape", 0, 1, 1, true},
    Grammar{"Material", 0, 1, 1, true},
    Grammar{"MakeNamedMaterial", 0, 1, 1, true},
    Grammar{"NamedMaterial", 0, 1, 1, false},
    Grammar{"Texture", 0, 3, 3, true},
    Grammar{"LightSource", 0, 1, 1, true},
    Grammar{"AreaLightSource", 0, 1, 1, true},
    Grammar{"MakeNamedMedium", 0, 1, 1, true},
    Grammar{"MediumInterface", 0, 1, 2, false},
};

// A scene of a film has thousands of includes;
// a file that includes another twice, which does the same, has 2^n.
constexpr std::size_t kMostNested = 64, kMostIncludes = 20000;

const Grammar* find_grammar(const Token& token) {
  if (token.kind != Token::Kind::word) return nullptr;
  const auto* found = std::find_if(kGrammar.begin(), kGrammar.end(),
                                   [&](const Grammar& entry) { return entry.name == token.text; });
  return found != kGrammar.end() ? found : nullptr;
}

}  // namespace

Parser::Parser(const std::filesystem::path& path) : folder_(path.parent_path()) {
  open(path);
}

void Parser::open(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const std::string& name = paths_.emplace_back(path.string());
  std::error_code ignored;
  files_.push_back({std::filesystem::weakly_canonical(path, ignored),
                    std::make_unique<Tokenizer>(name, std::string(without_byte_order_mark(bytes))),
                    {}});
  place_ = {&name, 1};
  files_.back().token = files_.back().tokenizer->next();
}

std::filesystem::path Parser::resolve(const std::string& name) const {
  return folder_ / std::filesystem::path(name);  // an absolute name stays as it is
}

void Parser::include(const Directive& directive) {
  std::filesystem::path path = resolve(directive.strings[0]);

  // Names count from the main file's folder; files in a folder of their own sometimes count from there.
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    const std::filesystem::path beside = files_.back().path.parent_path() / directive.strings[0];
    if (std::filesystem::exists(beside, ignored)) path = beside;
  }
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, ignored);
  for (const OpenFile& file : files_)
    if (file.path == canonical)
      fail(directive.place, "includes " + in_quotes(directive.strings[0]) +
                                ", which is being read already: the files include each other in a circle");
  if (files_.size() >= kMostNested)
    fail(directive.place, "more than " + std::to_string(kMostNested) + " files are nested by Include");
  if (++included_ > kMostIncludes)
    fail(directive.place, "more than " + std::to_string(kMostIncludes) + " files are included");
  // Exporters leave a file for what the user may add.
  if (std::filesystem::is_regular_file(path, ignored) && std::filesystem::file_size(path, ignored) == 0)
    return;
  try {
    open(path);
  } catch (const FileError& error) {
    // An error in the first token of the new file has its own place;
    // one of the path gets that of the Include.
    if (place_.path != directive.place.path) throw;
    fail(directive.place, std::string("cannot include ") + error.what());
  }
}

bool Parser::next(Directive& directive) {
  while (!files_.empty()) {
    Tokenizer& tokenizer = *files_.back().tokenizer;
    Token& token = files_.back().token;
    const Place place = place_ = tokenizer.place(token);
    if (token.kind == Token::Kind::end) {
      files_.pop_back();
      continue;
    }

    // The name decides what must follow.
    const Grammar* grammar = find_grammar(token);
    if (grammar == nullptr)
      fail(place, "found " + describe(token) + ", expected a directive such as Shape or AttributeBegin");
    directive = {std::string(token.text), place, {}, {}, {}};
    token = tokenizer.next();

    // Numbers, in brackets or not.
    if (grammar->numbers > 0) {
      const bool in_brackets = token.kind == Token::Kind::open;
      if (in_brackets) token = tokenizer.next();
      for (int i = 0; i < grammar->numbers; ++i, token = tokenizer.next()) {
        if (token.kind != Token::Kind::word || find_grammar(token) != nullptr)
          fail(tokenizer.place(token), directive.name + " has " + std::to_string(i) + " numbers and then " +
                                           describe(token) + ", expected " +
                                           std::to_string(grammar->numbers) + " numbers");
        directive.numbers.push_back(number_of(tokenizer, token));
      }
      if (in_brackets) {
        if (token.kind != Token::Kind::close)
          fail(tokenizer.place(token), directive.name + " has " + std::to_string(grammar->numbers) +
                                           " numbers and then " + describe(token) + ", expected ']'");
        token = tokenizer.next();
      }
    }

    // Strings; ActiveTransform's is a bare word.
    const bool takes_word = directive.name == "ActiveTransform";
    for (int i = 0; i < grammar->most_strings; ++i, token = tokenizer.next()) {
      if (token.kind != (takes_word ? Token::Kind::word : Token::Kind::string)) {
        if (i >= grammar->least_strings) break;
        fail(tokenizer.place(token),
             directive.name + " is followed by " + describe(token) + ", expected a name in quotes");
      }
      directive.strings.emplace_back(token.text);
    }

    // Parameters. Each read leaves the token after it.
    while (grammar->has_parameters && token.kind == Token::Kind::string)
      directive.parameters.add(read_parameter(tokenizer, token));

    if (directive.name != "Include" && directive.name != "Import") return true;
    include(directive);
  }
  return false;
}

}  // namespace boxwood::io::pbrt
