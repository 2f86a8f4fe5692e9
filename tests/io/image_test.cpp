// What comes back from the pictures that are written, and what is said when they cannot be.
#include "boxwood/io/image.h"

#include <chrono>
#include <cmath>
#include <csignal>
#include <limits>
#include <thread>

#include <sys/resource.h>

#include "boxwood/io/file_bytes.h"
#include "boxwood/io/picture_check.h"
#include "io/files.h"

namespace boxwood::io {
namespace {

using Pictures = Files;

Image gradient(int width, int height, int channels) {
  Image image(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c)
        image.at(x, y)[c] = float(x + 1) / float(width) * float(c + 1) / 5 + float(y) * 0.01f;
  return image;
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

// How many threads this program has, from the operating system; 0 where it does not tell.
std::size_t thread_count() {
  std::error_code error;
  std::filesystem::directory_iterator tasks("/proc/self/task", error);
  return error ? 0 : static_cast<std::size_t>(std::distance(tasks, {}));
}

TEST_F(Pictures, PngKeepsEightBitsOfSrgb) {
  for (const int channels : {1, 3, 4}) {
    const Image image = gradient(37, 5, channels);
    write_image(path("a.png"), image);
    const Image back = read_image(path("a.png"));
    ASSERT_EQ(back.width, 37);
    ASSERT_EQ(back.height, 5);
    ASSERT_EQ(back.channels, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      EXPECT_NEAR(back.pixels[i], image.pixels[i], 0.0045f);
  }
  EXPECT_EQ(file_count(), 1u) << "a part was left behind";
}

TEST_F(Pictures, PngHasTheEncodingOfTheStandard) {
  Image image(4, 1);
  const float values[] = {0.0f, 0.214041f, 1.0f, 7.0f};
  for (int x = 0; x < 4; ++x) std::fill_n(image.at(x, 0), 3, values[x]);
  write_image(path("a.png"), image);
  const Texture texture = read_texture(path("a.png"));
  ASSERT_EQ(texture.texels.size(), 4u);
  EXPECT_TRUE(texture.is_srgb);
  EXPECT_EQ(texture.texels[0][0], 0);
  EXPECT_EQ(texture.texels[1][0], 128 - 1) << "0.5 in sRGB";
  EXPECT_EQ(texture.texels[2][0], 255);
  EXPECT_EQ(texture.texels[3][0], 255);
  EXPECT_EQ(texture.texels[0][3], 255);
}

TEST_F(Pictures, PngTakesNumbersThatAreNone) {
  Image image(3, 1);
  image.at(0, 0)[0] = std::numeric_limits<float>::quiet_NaN();
  image.at(1, 0)[0] = std::numeric_limits<float>::infinity();
  image.at(2, 0)[0] = -std::numeric_limits<float>::infinity();
  write_image(path("a.png"), image);
  const Texture texture = read_texture(path("a.png"));
  EXPECT_EQ(texture.texels[0][0], 0);
  EXPECT_EQ(texture.texels[1][0], 255);
  EXPECT_EQ(texture.texels[2][0], 0);
}

TEST_F(Pictures, PngKeepsColorsBehindTransparentAlpha) {
  Image image(1, 1, 4);
  image.pixels = {1, 1, 0, 0.2f};
  write_image(path("a.png"), image);
  EXPECT_EQ(read_texture(path("a.png")).texels[0], (std::array<std::uint8_t, 4>{255, 255, 0, 51}));
}

TEST_F(Pictures, ExrKeepsEveryFloatAndTheNames) {
  Image image = gradient(19, 7, 5);
  image.channel_names = {"R", "G", "B", "depth.Z", "normal.X"};
  image.at(3, 2)[3] = 1e30f;
  image.at(4, 2)[3] = std::numeric_limits<float>::infinity();
  write_image(path("a.exr"), image);
  const Image back = read_image(path("a.exr"));
  EXPECT_EQ(back.channel_names.size(), 5u);
  // Files order channels by name; find each by its own.
  for (int c = 0; c < 5; ++c) {
    const auto found =
        std::find(back.channel_names.begin(), back.channel_names.end(), image.channel_names[c]);
    ASSERT_NE(found, back.channel_names.end()) << image.channel_names[c];
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 19; ++x)
        EXPECT_EQ(back.at(x, y)[found - back.channel_names.begin()], image.at(x, y)[c]);
  }
}

TEST_F(Pictures, EqualPicturesAreEqualFilesWheneverTheyAreWritten) {
  const auto encoded = [&](const std::string& name) {
    write_image(path(name), gradient(7, 5, 3));
    return read_file(path(name));
  };
  for (const std::string name : {"a.png", "a.exr", "a.hdr"}) {
    const std::string first = encoded(name);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // files tell time by the second
    EXPECT_EQ(first, encoded(name)) << name;
  }
}

TEST_F(Pictures, HdrKeepsBrightLight) {
  Image image = gradient(33, 4, 3);
  image.at(1, 1)[0] = 5000;
  write_image(path("a.hdr"), image);
  const Image back = read_image(path("a.hdr"));
  EXPECT_NEAR(back.at(1, 1)[0], 5000, 50);
  EXPECT_NEAR(back.at(20, 3)[1], image.at(20, 3)[1], 0.01f);
}

TEST_F(Pictures, ReplacesTheFileThatWasThere) {
  write("a.png", "an old file");
  write_image(path("a.png"), gradient(2, 2, 3));
  EXPECT_EQ(read_image(path("a.png")).width, 2);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(Pictures, SaysWhyAPictureCannotBeWritten) {
  const Image image = gradient(4, 4, 3);
  const auto says = [](const std::filesystem::path& target, const Image& what) {
    return message_of<FileError>([&] { write_image(target, what); });
  };
  EXPECT_CONTAINS(says(path("a.xyz"), image),
                  "a.xyz: pictures are written as .png, .exr or .hdr, not as '.xyz'");
  EXPECT_CONTAINS(says(path("plain"), image), "not as ''");
  EXPECT_CONTAINS(says(path("none/a.png"), image), "there is no folder");
  std::filesystem::create_directory(path("folder.png"));
  EXPECT_CONTAINS(says(path("folder.png"), image), "folder.png: is a folder");
  EXPECT_CONTAINS(says(path("a.png"), Image()), "0 x 0");
  EXPECT_CONTAINS(says(path("a.png"), Image(1, 1, 2)), "1, 3 or 4 channels, not 2");
  EXPECT_CONTAINS(says(path("a.hdr"), Image(1, 1, 4)), "3 channels, not 4");
  Image torn(2, 2);
  torn.pixels.pop_back();
  EXPECT_CONTAINS(says(path("a.exr"), torn), "11 numbers");
  EXPECT_EQ(file_count(), 1u) << "something besides the folder was left behind";
}

TEST_F(Pictures, KeepsTheOldFileWhenTheDiskTakesOnlyAPart) {
  write("a.exr", "an old file");
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = message_of<FileError>([&] { write_image(path("a.exr"), gradient(64, 64, 3)); });
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_CONTAINS(message, "a.exr: cannot be written: ");
  EXPECT_EQ(read(path("a.exr")), "an old file");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(Pictures, SaysWhenAFolderTakesNoFiles) {
  if (!std::filesystem::is_directory("/proc/self"))
    GTEST_SKIP() << "this system has no /proc, which takes no files";
  EXPECT_CONTAINS(message_of<FileError>([&] { write_image("/proc/self/a.png", gradient(4, 4, 3)); }),
                  "/proc/self/a.png: cannot be written: ");
}

TEST_F(Pictures, BelievesNoSizeThatTheFileHasNoBytesFor) {
  // 60000 x 60000 pixels, with the check sum that belongs to it.
  const std::string png(
      "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\xea\x60\0\0\xea\x60\x08\x02\0\0\0\x0f\xb0\xe2\x15", 33);
  EXPECT_CONTAINS(message_of<FileError>([&] { read_texture(write("a.png", png)); }),
                  "tells of 60000 x 60000 pixels");
  write_image(path("a.exr"), gradient(4, 4, 3));
  std::string exr = read(path("a.exr"));
  const std::size_t window = exr.find("dataWindow");
  ASSERT_NE(window, std::string::npos);
  exr.replace(window + 21 + 8, 8, "\x5f\xea\0\0\x5f\xea\0\0", 8);
  EXPECT_CONTAINS(message_of<FileError>([&] { read_texture(write("a.exr", exr)); }),
                  "tells of 60000 x 60000 pixels");
}

TEST_F(Pictures, BelievesAPictureOfOneColor) {
  // A PNG of one bit for each pixel and a palette is that small.
  EXPECT_NO_THROW(check_picture_size("white.png", 2048, 2048, 4, 605));
  EXPECT_THROW(check_picture_size("white.png", 2048, 2048, 4, 200), FileError);
}

TEST_F(Pictures, ReadsTexturesFromMemory) {
  write_image(path("a.png"), gradient(8, 3, 3));
  const Texture from_file = read_texture(path("a.png"));
  const std::string bytes = read(path("a.png"));
  const Texture from_memory = read_texture(bytes_of(bytes), "image 0");
  EXPECT_EQ(from_memory.name, "image 0");
  EXPECT_EQ(from_memory.width, 8);
  EXPECT_EQ(from_memory.height, 3);
  EXPECT_EQ(from_memory.texels, from_file.texels);
}

TEST_F(Pictures, ReadsLinearTexturesAsSrgb) {
  Image image(1, 1);
  image.pixels = {0.214041f, 1, 0};
  write_image(path("a.exr"), image);
  const Texture texture = read_texture(path("a.exr"));
  EXPECT_TRUE(texture.is_srgb);
  EXPECT_EQ(texture.texels[0], (std::array<std::uint8_t, 4>{127, 255, 0, 255}));
}

TEST_F(Pictures, ReadsTgaTheRightWayUp) {
  // 1 x 2 pixels, uncompressed, rows from bottom to top (0x00) and from top to bottom (0x20).
  for (const bool from_top : {false, true}) {
    std::string tga(18, '\0');
    tga[2] = 2;
    tga[12] = 1;
    tga[14] = 2;
    tga[16] = 24;
    tga[17] = from_top ? 0x20 : 0;
    tga += std::string("\x00\x00\xff", 3) + std::string("\xff\x00\x00", 3);  // Red comes first, then blue.
    const Texture texture = read_texture(write("a.tga", tga));
    ASSERT_EQ(texture.texels.size(), 2u);
    EXPECT_EQ(texture.texels[from_top ? 0 : 1], (std::array<std::uint8_t, 4>{255, 0, 0, 255})) << from_top;
    EXPECT_EQ(texture.texels[from_top ? 1 : 0], (std::array<std::uint8_t, 4>{0, 0, 255, 255})) << from_top;
  }
}

TEST_F(Pictures, SaysWhyAPictureCannotBeRead) {
  const auto says = [](const std::filesystem::path& file) {
    return message_of<FileError>([&] { read_texture(file); });
  };
  EXPECT_CONTAINS(says(path("gone.png")), "gone.png: no such file");
  EXPECT_CONTAINS(says(folder_), "is a folder");
  EXPECT_CONTAINS(says(write("empty.png", "")), "empty.png: the file is empty");
  EXPECT_CONTAINS(says(write("noise.png", "these are no pixels")),
                  "noise.png:byte 0: is not a picture that can be read");
  EXPECT_CONTAINS(says(write("noise.jpg", "these are no pixels")),
                  "noise.jpg: is not a picture that can be read");
  EXPECT_CONTAINS(says(write("noise.xyz", "these are no pixels")),
                  "noise.xyz: is not a picture that can be read");
  EXPECT_CONTAINS(says(write("noise", "these are no pixels")), "noise: is not a picture that can be read");
  EXPECT_CONTAINS(message_of<FileError>([] { read_texture(std::span<const std::byte>(), "image 3"); }),
                  "image 3: ");
}

TEST_F(Pictures, StartsNoThreads) {
  const std::size_t before = thread_count();
  const Image image = gradient(512, 512, 3);
  for (const char* name : {"a.png", "a.exr", "a.hdr"}) {
    write_image(path(name), image);
    read_image(path(name));
    read_texture(path(name));
  }
  EXPECT_EQ(thread_count(), before);
}

}  // namespace
}  // namespace boxwood::io
