// fingerprint.h: is this the same scene?
//
// A number that two equal descriptions share and that different ones, but for a chance of 2^-64, do not: for
// work that is kept on disk or shared among machines and must not be mixed up.
#pragma once

#include "boxwood/scene/description.h"

namespace boxwood {

/// Looks at everything that can be seen: not at names and warnings; of AnyShape only at the boxes. The same
/// on every machine of one byte order. Cost: one pass over the data.
std::uint64_t fingerprint(const SceneDesc& desc);

}  // namespace boxwood
