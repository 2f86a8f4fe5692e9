// shard.h: how do shares of the samples become one picture?
//
// Machines that know nothing of each other render shards: shard i of n takes the i-th of n equal runs of each
// pixel's sample numbers. A shard's file shows its picture, and holds its exact sums beside it. Sums of sums
// are exact too, so the merged picture has the bits that one machine alone would have made.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "boxwood/render/checkpoint.h"
#include "boxwood/render/film.h"

namespace boxwood::render {

/// The sums of a film as planes of a picture: height x width x names.size() words.
struct FilmWords {
  std::vector<std::string> names;
  std::vector<std::uint32_t> words;
};

FilmWords words_of(const Film& film);
std::vector<std::string> word_names(std::size_t words_per_pixel);

/// Facts as the text of one attribute of a file, and back.
std::string text_of(const Facts& facts);
Facts facts_from(const std::string& text);

/// Adds up shards, one after another.
class ShardMerger {
 public:
  /// `words` in the order of word_names(). `name` (of the file) is for messages. Throws std::runtime_error
  /// when the shard does not belong to those before it, or is one of them again.
  void add(const std::string& name, const Facts& facts, const Image& image,
           std::span<const std::uint32_t> words);

  /// The picture of all shards. Throws std::runtime_error that names those that are missing.
  Image merged() const;
  Mode mode() const { return options_.mode; }

 private:
  RenderOptions options_;  // as far as facts tell: size, mode, layers, number of shards
  Facts facts_;            // without the shard's index
  std::string first_name_;
  std::map<int, std::string> names_;  // of the shards that there are, by index
  std::optional<Film> film_;
  Image first_image_;  // for layers that do not come from samples
};

}  // namespace boxwood::render
