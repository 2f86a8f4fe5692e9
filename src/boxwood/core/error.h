// error.h: how does the library say that something is wrong?
//
// At the doors (loaders, constructors, batch entry) by exceptions that say what, where and what was expected;
// inside by assertions; per ray never.
#pragma once

#include <stdexcept>
#include <string>

namespace boxwood {

/// A file that cannot be used. what() reads "path:place: what is wrong", with the place (a line, a byte, an
/// element) where one is known.
class FileError : public std::runtime_error {
 public:
  FileError(const std::string& path, const std::string& place, const std::string& message)
      : std::runtime_error(path + (place.empty() ? "" : ":" + place) + ": " + message) {}
};

/// The caller asked for the work to stop (see Progress).
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace boxwood
