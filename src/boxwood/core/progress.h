// progress.h: how far is a long piece of work, and should it go on?
#pragma once

#include <functional>
#include <string_view>

namespace boxwood {

/// Told now and then, from one thread at a time: which stage, and the share of it that is done, in [0, 1].
/// Returning false asks the work to stop: it then throws Cancelled, or keeps what it has where it says so.
using Progress = std::function<bool(std::string_view stage, double done)>;

}  // namespace boxwood
