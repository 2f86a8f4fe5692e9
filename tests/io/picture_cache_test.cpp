// Pictures that stay in their files, or in the bytes of one: what is read a tile at a time.
#include "boxwood/io/picture_cache.h"

#include <cmath>
#include <thread>
#include <vector>

#include "boxwood/core/random.h"
#include "boxwood/io/image.h"
#include "io/files.h"

namespace boxwood::io {
namespace {

class PictureCache : public Files {
 protected:
  /// A picture with several tiles of 64 x 64, which ends in the midst of one.
  std::filesystem::path written(const std::string& name, int channels) {
    Random random(static_cast<std::uint64_t>(channels));
    Image image(150, 97, channels);
    for (float& x : image.pixels) x = random.uniform();
    write_image(path(name), image);
    return path(name);
  }
  static std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
  }
};

/// The largest difference between a picture in memory and the same a tile at a time.
float difference(const Texture& whole, const Texture& tiled) {
  float most = 0;
  for (int y = 0; y < whole.height; ++y)
    for (int x = 0; x < whole.width; ++x)
      for (int c = 0; c < 4; ++c)
        most = max(most, std::fabs(whole.texels[std::size_t(y) * whole.width + x][c] / 255.0f -
                                   tiled.source->texel(0, x, y)[c]));
  return most;
}

TEST_F(PictureCache, TilesHoldWhatTheWholePictureDoes) {
  for (const int channels : {1, 3, 4}) {
    const auto file = written("p" + std::to_string(channels) + ".png", channels);
    const std::string bytes = read(file);
    const Texture whole = read_texture(file);
    for (const Texture& tiled : {open_texture(file), open_texture(bytes_of(bytes), "a name")}) {
      ASSERT_NE(tiled.source, nullptr);
      EXPECT_TRUE(tiled.texels.empty());
      EXPECT_TRUE(tiled.is_srgb);
      EXPECT_EQ(tiled.width, 150);
      EXPECT_EQ(tiled.height, 97);
      EXPECT_LE(difference(whole, tiled), 1e-6f) << channels << " channels";
    }
  }
}

TEST_F(PictureCache, TheSmallestLevelIsTheMean) {
  const auto file = written("p.png", 3);
  const Texture whole = read_texture(file);
  double mean = 0;
  for (const auto& texel : whole.texels) mean += texel[0] / 255.0 / double(whole.texels.size());
  const std::string bytes = read(file);
  const Texture tiled = open_texture(bytes_of(bytes), "p");
  EXPECT_EQ(tiled.source->levels(), 8);  // 150, 75, 37, 18, 9, 4, 2, 1
  EXPECT_NEAR(tiled.source->texel(7, 0, 0)[0], mean, 0.03);
}

TEST_F(PictureCache, BytesAreCopied) {
  std::string bytes = read(written("p.png", 3));
  const Texture whole = read_texture(bytes_of(bytes), "p"), tiled = open_texture(bytes_of(bytes), "p");
  bytes.assign(bytes.size(), '\0');
  EXPECT_LE(difference(whole, tiled), 1e-6f);
}

TEST_F(PictureCache, AFileThatChangedIsReadAnew) {
  const auto file = written("p.png", 3);
  (void)open_texture(file).source->texel(0, 0, 0);
  Image other(150, 97, 3);
  write_image(file, other);
  EXPECT_LE(difference(read_texture(file), open_texture(file)), 1e-6f);
}

TEST_F(PictureCache, ManyThreadsReadAndForget) {
  const std::string bytes = read(written("p.png", 3));
  const Texture whole = read_texture(bytes_of(bytes), "p"), shared = open_texture(bytes_of(bytes), "p");
  std::vector<float> most(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < most.size(); ++i)
    threads.emplace_back([&, i] {
      for (int round = 0; round < 10; ++round) {
        const Texture own = open_texture(bytes_of(bytes), "p");
        most[i] = max(most[i], max(difference(whole, own), difference(whole, shared)));
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const float x : most) EXPECT_LE(x, 1e-6f);
}

TEST_F(PictureCache, WhatIsNoPictureIsAnError) {
  EXPECT_CONTAINS(message_of<FileError>([&] { (void)open_texture(bytes_of("three bytes"), "its name"); }),
                  "its name");
  EXPECT_CONTAINS(message_of<FileError>([&] { (void)open_texture(path("gone.png")); }), "gone.png");
}

}  // namespace
}  // namespace boxwood::io
