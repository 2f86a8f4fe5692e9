// mutations.h: does a reader survive what time and malice do to a file?
//
// Takes a good file, damages it in thousands of repeatable ways, and holds the reader to its word: a scene
// that passes check(), or a FileError of one line that names the file. Anything else, another exception or a
// crash, is a failure.
#pragma once

#include <string>

#include "boxwood/core/random.h"
#include "boxwood/io/load.h"
#include "io/files.h"

namespace boxwood::io {

/// One damaged copy: cut off, overwritten, with parts doubled or missing, with numbers that readers like to
/// believe, or noise from end to end.
inline std::string mutate(const std::string& good, Random& random) {
  using namespace std::string_literals;
  static const std::string kTraps[] = {"\xff\xff\xff\xff"s,
                                       "\0\0\0\0"s,
                                       "\x7f\xff\xff\xff"s,
                                       "\xff\xff\xff\x7f"s,
                                       "\0\0\xc0\x7f"s,
                                       "\0\0\x80\x7f"s,
                                       " nan "s,
                                       " -inf "s,
                                       " 1e999 "s,
                                       " -1 "s,
                                       " 4294967295 "s,
                                       " 18446744073709551616 "s,
                                       " 1000000000000 "s,
                                       "/"s,
                                       "\n"s,
                                       "{"s,
                                       "["s,
                                       "\""s,
                                       " 0 "s,
                                       "\0"s};
  std::string bytes = good;
  const auto place = [&] {
    return bytes.empty() ? 0 : random.below(static_cast<std::uint32_t>(bytes.size()));
  };
  switch (random.below(8)) {
    case 0:
      bytes.resize(place());
      return bytes;
    case 1:
      for (char& c : bytes) c = static_cast<char>(random.next());
      return bytes;
    default:
      break;
  }
  for (std::uint32_t times = 1 + random.below(6); times-- > 0;) {
    const std::size_t at = place(), length = 1 + random.below(24);
    const std::string& trap = kTraps[random.below(std::size(kTraps))];
    switch (random.below(6)) {
      case 0:
        if (!bytes.empty()) bytes[at] = static_cast<char>(random.next());
        break;
      case 1:
        bytes.replace(at, trap.size(), trap);
        break;
      case 2:
        bytes.insert(at, trap);
        break;
      case 3:
        bytes.erase(at, length);
        break;
      case 4:
        bytes.insert(place(), bytes.substr(at, length));
        break;
      case 5:
        if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
        break;
    }
  }
  return bytes;
}

/// Whether the message is one line that begins with the file's path.
inline bool is_clear(const std::string& message, const std::string& file) {
  return message.starts_with(file) && message.size() > file.size() + 2 &&
         message.find_first_of("\n\r") == std::string::npos && message.size() < file.size() + 400;
}

class BadInput : public Files {
 protected:
  /// Calls `use(file)` for `count` damaged copies of `good`, each written to the file `target`, and for every
  /// way to cut a small one short. `use` may throw FileError about a file in the same folder and nothing
  /// else.
  template <class Use>
  void expect_survives(const std::string& good, const std::string& target, int count, const Use& use) const {
    const std::string folder = folder_.string();
    int refused = 0;
    const auto attempt = [&](const std::string& bytes, const std::string& what) {
      const std::filesystem::path file = write(target, bytes);
      try {
        use(file);
      } catch (const FileError& error) {
        ++refused;
        EXPECT_TRUE(is_clear(error.what(), folder)) << what << ": " << error.what();
      } catch (const std::exception& error) {
        ADD_FAILURE() << what << " of " << target << ": not a FileError: " << error.what();
      }
    };
    use(write(target, good));
    for (std::size_t length = 0; length < std::min<std::size_t>(good.size(), 1500); ++length)
      attempt(good.substr(0, length), "cut to " + std::to_string(length) + " bytes");
    for (int i = 0; i < count; ++i) {
      Random random(static_cast<std::uint64_t>(i));
      attempt(mutate(good, random), "mutation " + std::to_string(i));
    }
    EXPECT_GT(refused, 0) << "no damage to " << target << " was noticed";
  }

  /// The same for scene files: what loads has passed check().
  void expect_load_survives(const std::string& good, const std::string& target, int count) const {
    expect_survives(good, target, count, [](const std::filesystem::path& file) {
      const SceneDesc desc = load(file);
      EXPECT_NO_THROW(check(desc));
      EXPECT_GT(defined_primitive_count(desc), 0u);
      for (const std::string& warning : desc.warnings)
        EXPECT_EQ(warning.find_first_of("\n\r"), std::string::npos) << warning;
    });
  }
};

}  // namespace boxwood::io
