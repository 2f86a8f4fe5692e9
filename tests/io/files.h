// files.h: where do the tests of this room put their files?
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <unistd.h>

namespace boxwood::io {

/// A folder of its own for each test, removed afterwards.
class Files : public testing::Test {
 protected:
  Files() : folder_(std::filesystem::temp_directory_path() / ("boxwood-io-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Files() override {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
  }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    // A new file each time: file systems may wait for the disk when an old one is overwritten.
    std::error_code error;
    std::filesystem::remove(path(name), error);
    std::ofstream(path(name), std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path(name);
  }
  static std::string read(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  std::filesystem::path folder_;
};

/// The error that `call` throws, as text; empty when it throws none.
template <class Error, class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The folder of real models; nullptr when the environment names none.
inline const char* models_folder() {
  return std::getenv("BOXWOOD_MODELS");
}

}  // namespace boxwood::io

#define EXPECT_CONTAINS(text, part) \
  EXPECT_NE(std::string(text).find(part), std::string::npos) << "got: " << (text)

#define BOXWOOD_NEEDS_MODELS()                                           \
  if (models_folder() == nullptr)                                        \
  GTEST_SKIP() << "BOXWOOD_MODELS does not name the folder of the real " \
                  "models"
