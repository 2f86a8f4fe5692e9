#include "boxwood/render/checkpoint.h"

#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "boxwood/scene/fingerprint.h"

namespace boxwood::render {
namespace {

constexpr std::string_view kMagic = "boxwood checkpoint 2\n";  // the number is that of the layout below

/// A check sum against torn and mixed files: FNV-1a, over words instead of bytes.
class CheckSum {
 public:
  void add(std::string_view bytes) {
    for (std::size_t at = 0; at < bytes.size(); at += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + at, std::min<std::size_t>(8, bytes.size() - at));
      sum_ = (sum_ ^ word) * 0x100000001b3u;
      sum_ ^= sum_ >> 32;
    }
  }
  std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325u;
};

template <class T>
std::string_view bytes_of(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

/// Takes bytes from the front of a file.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  std::string_view take(std::size_t size) {
    if (size > rest_.size()) throw std::runtime_error("the checkpoint ends too early");
    const std::string_view found = rest_.substr(0, size);
    rest_.remove_prefix(size);
    sum_.add(found);
    return found;
  }
  template <class T>
  T value() {
    T found;
    std::memcpy(&found, take(sizeof(T)).data(), sizeof(T));
    return found;
  }
  std::string text() { return std::string(take(value<std::uint32_t>())); }
  std::uint64_t check_sum() const { return sum_.value(); }
  bool is_at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
  CheckSum sum_;
};

/// Where a job stands, beside its tiles: plain data of a fixed layout.
struct Header {
  std::int32_t round_begin, round_end;
  double noise;  // negative: not known
};

/// What a tile holds, beside its sums.
struct TileHead {
  std::uint64_t units, rays, samples, dropped;
};

}  // namespace

Facts facts_of(const RenderJob& job) {
  const RenderOptions& options = job.options();
  char scene[17], noise[32];
  std::snprintf(scene, sizeof(scene), "%016llx",
                static_cast<unsigned long long>(fingerprint(job.scene().description())));
  std::snprintf(noise, sizeof(noise), "%.9g", options.noise);
  std::string layers;
  for (const Layer layer : options.layers)
    layers += (layers.empty() ? "" : ",") + std::string(layer_name(layer));
  return {{"size", std::to_string(options.width) + "x" + std::to_string(options.height)},
          {"mode", std::string(mode_name(options.mode))},
          {"samples", std::to_string(options.samples)},
          {"shard", std::to_string(options.shard.index) + "/" + std::to_string(options.shard.count)},
          {"bounces", std::to_string(options.bounces)},
          {"filter", std::string(filter_name(options.filter))},
          {"noise", noise},
          {"layers", layers.empty() ? "none" : layers},
          {"scene", scene}};
}

std::string first_difference(const Facts& theirs, const Facts& ours) {
  for (const Fact& fact : ours)
    for (const Fact& other : theirs)
      if (other.name == fact.name && other.value != fact.value)
        return fact.name + ": " + other.value + ", not " + fact.value;
  return theirs.size() == ours.size() ? "" : "its facts are of another version";
}

void write_checkpoint(const RenderJob& job, const std::function<void(std::string_view)>& sink) {
  CheckSum sum;
  const auto put = [&](std::string_view bytes) {
    sum.add(bytes);
    sink(bytes);
  };
  const auto put_text = [&](const std::string& text) {
    put(bytes_of(static_cast<std::uint32_t>(text.size())));
    put(text);
  };

  put(kMagic);
  const Facts facts = facts_of(job);
  put(bytes_of(static_cast<std::uint32_t>(facts.size())));
  for (const Fact& fact : facts) {
    put_text(fact.name);
    put_text(fact.value);
  }
  const RenderJob::State state = job.state();
  put(bytes_of(Header{state.round.begin, state.round.end, state.noise.value_or(-1)}));
  put({reinterpret_cast<const char*>(state.is_settled.data()), state.is_settled.size()});

  // Each tile is copied under its lock and written without.
  std::vector<std::uint32_t> words;
  for (std::size_t tile = 0; tile < job.film().grid().size(); ++tile) {
    const TileHead head = job.film().with_tile(tile, [&](const Film::Tile& held) {
      words.resize(held.sums.word_count());
      held.sums.to_words(words);
      return TileHead{held.units, held.effort.rays, held.effort.samples, held.effort.dropped};
    });
    put(bytes_of(head));
    put({reinterpret_cast<const char*>(words.data()), words.size() * 4});
  }
  sink(bytes_of(sum.value()));
}

void read_checkpoint(RenderJob& job, std::string_view bytes) {
  Reader reader(bytes);
  if (!bytes.starts_with(kMagic)) throw std::runtime_error("is not a checkpoint of this version");
  reader.take(kMagic.size());

  Facts facts(std::min<std::uint32_t>(reader.value<std::uint32_t>(), 64));
  for (Fact& fact : facts) {
    fact.name = reader.text();
    fact.value = reader.text();
  }
  if (const std::string difference = first_difference(facts, facts_of(job)); !difference.empty())
    throw std::runtime_error("is a checkpoint of another picture (" + difference + ")");

  const auto header = reader.value<Header>();
  RenderJob::State state;
  state.round = {header.round_begin, header.round_end};
  if (header.noise >= 0) state.noise = header.noise;
  const std::string_view settled = reader.take(job.film().grid().size());
  state.is_settled.assign(settled.begin(), settled.end());

  // Everything is read before anything is believed.
  std::vector<Film::Tile> tiles;
  std::vector<std::uint32_t> words;
  for (std::size_t tile = 0; tile < job.film().grid().size(); ++tile) {
    const auto head = reader.value<TileHead>();
    tiles.push_back({job.film().empty_tile(tile), {head.rays, head.samples, head.dropped}, head.units});
    words.resize(tiles.back().sums.word_count());
    std::memcpy(words.data(), reader.take(words.size() * 4).data(), words.size() * 4);
    tiles.back().sums.from_words(words);
  }
  const std::uint64_t expected = reader.check_sum();
  if (reader.value<std::uint64_t>() != expected || !reader.is_at_end())
    throw std::runtime_error("the checkpoint is damaged");

  for (std::size_t tile = 0; tile < tiles.size(); ++tile) job.film().set(tile, std::move(tiles[tile]));
  job.restore(state);
}

}  // namespace boxwood::render
