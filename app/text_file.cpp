#include "text_file.h"

#include <fstream>
#include <string>

#include <unistd.h>

#include "boxwood/core/error.h"

namespace boxwood::app {

void write_text(const std::filesystem::path& path, std::string_view text) {
  // The process id keeps two programs that write the same file apart.
  std::filesystem::path draft = path;
  draft += ".partial-" + std::to_string(getpid());

  std::ofstream out(draft, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();

  std::error_code error;
  const bool is_written = !out.fail();
  if (is_written) std::filesystem::rename(draft, path, error);
  if (is_written && !error) return;

  std::error_code ignored;
  std::filesystem::remove(draft, ignored);
  throw FileError(path.string(), "",
                  "cannot be written" + (error ? " (" + error.message() + ")" : std::string()));
}

}  // namespace boxwood::app
