#include "boxwood/render/shard.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <stdexcept>

#include "boxwood/render/picture.h"

namespace boxwood::render {
namespace {

const std::string& value_of(const Facts& facts, const std::string& name) {
  for (const Fact& fact : facts)
    if (fact.name == name) return fact.value;
  throw std::runtime_error("is not a shard of this version (it does not tell its " + name + ")");
}

/// Two numbers with a mark between them: "640x480", "3/16".
std::pair<int, int> two_numbers(const std::string& text, char mark) {
  int a = 0, b = 0;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, a);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == mark) {
    const auto second = std::from_chars(first.ptr + 1, end, b);
    if (second.ec == std::errc() && second.ptr == end) return {a, b};
  }
  throw std::runtime_error("is not a shard of this version ('" + text + "')");
}

RenderOptions options_from(const Facts& facts) {
  RenderOptions options;
  std::tie(options.width, options.height) = two_numbers(value_of(facts, "size"), 'x');
  std::tie(options.shard.index, options.shard.count) = two_numbers(value_of(facts, "shard"), '/');
  options.samples = kMaxSamples;
  try {
    options.mode = mode_from_name(value_of(facts, "mode"));
    std::istringstream layers(value_of(facts, "layers"));
    for (std::string name; std::getline(layers, name, ',');)
      if (name != "none") options.layers.push_back(layer_from_name(name));
    check(options);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(std::string("is not a shard of this version: ") + error.what());
  }
  return options;
}

Facts without_index(Facts facts, int count) {
  for (Fact& fact : facts)
    if (fact.name == "shard") fact.value = "one of " + std::to_string(count);
  return facts;
}

/// As RenderJob lays out its film.
std::vector<int> group_sizes(const RenderOptions& options) {
  std::vector<int> sizes{static_cast<int>(mode_channels(options.mode).size()), 1};
  for (const Layer layer : options.layers)
    if (is_mean(layer)) sizes.push_back(static_cast<int>(layer_channels(layer).size()));
  return sizes;
}

std::size_t channel_named(const Image& image, const std::string& name) {
  const auto found = std::find(image.channel_names.begin(), image.channel_names.end(), name);
  if (found == image.channel_names.end()) throw std::runtime_error("a shard has no channel " + name);
  return static_cast<std::size_t>(found - image.channel_names.begin());
}

}  // namespace

std::vector<std::string> word_names(std::size_t words_per_pixel) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < words_per_pixel; ++i) {
    // All of one length, so that the order of names is the order of numbers.
    std::string number = std::to_string(i);
    names.push_back("sums." + std::string(3 - std::min<std::size_t>(3, number.size()), '0') + number);
  }
  return names;
}

FilmWords words_of(const Film& film) {
  const TileGrid& grid = film.grid();
  const std::size_t per_pixel = film.empty_tile(0).words_per_pixel();
  FilmWords planes{word_names(per_pixel), {}};
  planes.words.resize(std::size_t(grid.width) * std::size_t(grid.height) * per_pixel);
  std::vector<std::uint32_t> words;
  for (std::size_t tile = 0; tile < grid.size(); ++tile) {
    film.with_tile(tile, [&words](const Film::Tile& held) {
      words.resize(held.sums.word_count());
      held.sums.to_words(words);
    });
    const TileArea area = grid.area(tile);
    const std::size_t row = std::size_t(area.x1 - area.x0) * per_pixel;
    for (int y = area.y0; y < area.y1; ++y)
      std::copy_n(
          &words[std::size_t(y - area.y0) * row], row,
          &planes.words[(std::size_t(y) * std::size_t(grid.width) + std::size_t(area.x0)) * per_pixel]);
  }
  return planes;
}

std::string text_of(const Facts& facts) {
  std::string text;
  for (const Fact& fact : facts) text += fact.name + "=" + fact.value + ";";
  return text;
}

Facts facts_from(const std::string& text) {
  Facts facts;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ';');) {
    const std::size_t mark = part.find('=');
    if (mark != std::string::npos) facts.push_back({part.substr(0, mark), part.substr(mark + 1)});
  }
  return facts;
}

void ShardMerger::add(const std::string& name, const Facts& facts, const Image& image,
                      std::span<const std::uint32_t> words) {
  const RenderOptions options = options_from(facts);
  const Facts common = without_index(facts, options.shard.count);
  if (!film_) {
    options_ = options;
    facts_ = common;
    first_name_ = name;
    film_.emplace(options.width, options.height, group_sizes(options));
    first_image_ = image;
  }
  if (const std::string difference = first_difference(common, facts_); !difference.empty())
    throw std::runtime_error("does not belong to the picture of " + first_name_ + " (" + difference + ")");
  if (image.width != options.width || image.height != options.height)
    throw std::runtime_error("holds a picture of another size than it says");
  const auto [before, is_new] = names_.emplace(options.shard.index, name);
  if (!is_new)
    throw std::runtime_error("is shard " + std::to_string(options.shard.index) + " of " +
                             std::to_string(options.shard.count) + " again, as " + before->second);

  // Bring the words of each tile together, row by row. A unit's number is of no use here: each shard comes
  // once.
  const TileGrid& grid = film_->grid();
  const std::size_t per_pixel = film_->empty_tile(0).words_per_pixel();
  if (words.size() != std::size_t(grid.width) * std::size_t(grid.height) * per_pixel)
    throw std::runtime_error("holds sums of another shape than it says");
  for (std::size_t tile = 0; tile < grid.size(); ++tile) {
    const TileArea area = grid.area(tile);
    std::vector<std::uint32_t> of_tile;
    for (int y = area.y0; y < area.y1; ++y) {
      const std::size_t begin = (std::size_t(y) * std::size_t(grid.width) + std::size_t(area.x0)) * per_pixel;
      const auto row = words.subspan(begin, std::size_t(area.x1 - area.x0) * per_pixel);
      of_tile.insert(of_tile.end(), row.begin(), row.end());
    }
    TileSums sums = film_->empty_tile(tile);
    sums.from_words(of_tile);
    film_->add(tile, 0, sums);
  }
  film_->begin_round();
}

Image ShardMerger::merged() const {
  if (!film_) throw std::runtime_error("there are no shards to merge");
  std::string missing;
  std::size_t missing_count = 0;
  for (int index = 1; index <= options_.shard.count; ++index) {
    if (names_.contains(index)) continue;
    constexpr std::size_t kMostNamed = 20;
    if (++missing_count <= kMostNamed) missing += (missing.empty() ? "" : ", ") + std::to_string(index);
    if (missing_count == kMostNamed + 1) missing += ", ...";
  }
  if (missing_count > 0)
    throw std::runtime_error("of " + std::to_string(options_.shard.count) + " shards, " + missing +
                             (missing_count == 1 ? " is missing" : " are missing"));

  // Names of things are the same in every shard. Files may have put channels in another order.
  Image image = picture_of(*film_, options_.mode, options_.layers);
  for (const Layer layer : options_.layers) {
    if (!is_name(layer)) continue;
    const std::size_t from = channel_named(first_image_, layer_channels(layer)[0]);
    const std::size_t to = channel_named(image, layer_channels(layer)[0]);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) image.at(x, y)[to] = first_image_.at(x, y)[from];
  }
  return image;
}

}  // namespace boxwood::render
