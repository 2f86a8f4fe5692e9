// gltf_accessor.h: which numbers does an accessor hold?
//
// An accessor is a typed window on a buffer view, a buffer view on a buffer; elements may lie apart
// (interleaved), and a sparse accessor replaces some of them by others. Every step is checked against the
// size of what it looks into. See the glTF 2.0 specification, section 3.6.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "boxwood/core/affine.h"
#include "boxwood/io/gltf_model.h"

namespace boxwood::io::gltf {

/// The elements of an accessor as floats, one after the other; integers become fractions where the accessor
/// says that they are normalized. `where` names who asks ("mesh 0, primitive 1, NORMAL"), for messages.
/// Throws FileError when an index leads nowhere, a range does not fit, the type is not the expected one, or a
/// number is not finite.
std::vector<Vec2> read_vec2(const File& file, int accessor, const std::string& where);
std::vector<Vec3> read_vec3(const File& file, int accessor, const std::string& where);
/// Of four components, such as quaternions, joints and weights.
std::vector<std::array<float, 4>> read_vec4(const File& file, int accessor, const std::string& where);
/// Matrices of four by four, whose last row is taken for 0 0 0 1.
std::vector<Affine3> read_affine(const File& file, int accessor, const std::string& where);
/// Of three components or four; the fourth is 1 where there are three.
std::vector<std::array<float, 4>> read_colors(const File& file, int accessor, const std::string& where);

/// The elements of a scalar accessor of unsigned integers. Throws FileError as above.
std::vector<std::uint32_t> read_indices(const File& file, int accessor, const std::string& where);

/// The bytes of a buffer view. Throws FileError when they are not within the buffer.
std::span<const std::byte> view_bytes(const File& file, int view, const std::string& where);

}  // namespace boxwood::io::gltf
