// checkpoint.h: how is a render kept, to be gone on with later?
//
// As bytes: what the job is (its facts), where it stands, each tile's sums, and a check sum. Because sums are
// exact and units remember that they came, a checkpoint may be taken at any moment while others render, and
// the job that goes on from it makes the very picture that it would have made.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "boxwood/render/job.h"

namespace boxwood::render {

/// One thing that two jobs must agree on to make the same picture, in words.
struct Fact {
  std::string name, value;
};
using Facts = std::vector<Fact>;

/// Everything that the picture's bits depend on: a fingerprint of the scene, size, samples ...
Facts facts_of(const RenderJob& job);

/// What differs first, as "samples: 64, not 128" with that of `theirs` first; empty when nothing does.
std::string first_difference(const Facts& theirs, const Facts& ours);

/// Hands the bytes to `sink`, piece by piece. During a round call it from `progress` only.
void write_checkpoint(const RenderJob& job, const std::function<void(std::string_view)>& sink);

/// Brings `job`, which has not run, to where the checkpoint was taken. Throws std::runtime_error that says
/// what is wrong: not a checkpoint, damaged, or of another job.
void read_checkpoint(RenderJob& job, std::string_view bytes);

}  // namespace boxwood::render
