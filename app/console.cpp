#include "console.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <unistd.h>

namespace boxwood::app {

void open_closed_streams() {
  // open() takes the lowest free number, which is the closed one: those below it are open by now.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1) (void)open("/dev/null", O_RDWR);
}

bool is_heard() {
  static const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
  return !rank || std::strcmp(rank, "0") == 0;
}

void check_output_arrived() {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw std::runtime_error("the output cannot be written to stdout: " +
                           std::string(errno != 0 ? std::strerror(errno) : "it took only a part"));
}

}  // namespace boxwood::app
