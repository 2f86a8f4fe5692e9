// fuzz_reader.cpp: does any sequence of bytes crash a reader, make it leak, or keep it busy for ever?
//
// One program for each format (BOXWOOD_FUZZ_ENDING says which), driven by libFuzzer: it feeds the reader with
// mutations of tests/fuzz/seeds and of what it finds to reach new code. tools/fuzz.sh builds and runs them.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "boxwood/io/load.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Readers take paths, and find other files beside them: each process has a folder of its own.
  static const std::filesystem::path folder = [] {
    auto made = std::filesystem::temp_directory_path() / ("boxwood_fuzz_" + std::to_string(::getpid()));
    std::filesystem::create_directories(made);
    return made;
  }();
  const std::filesystem::path path = folder / (std::string("input.") + BOXWOOD_FUZZ_ENDING);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    const boxwood::SceneDesc desc = boxwood::io::load(path);
    boxwood::check(desc);  // what a reader lets through, everything else must be able to use
  } catch (const boxwood::FileError&) {
  }
  return 0;
}
