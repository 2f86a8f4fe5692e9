// flat_shapes.h: what does a scene show, as one array of shapes in world space?
//
// The ladder compares structures over one span of one type, as the textbook does: no instances, no two
// levels. Meshes become triangles; spheres or blocks that stand where they were defined stay what they are;
// anything mixed or moved becomes AnyShape, at the price of a virtual call a test.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "boxwood/scene/description.h"
#include "boxwood/shape/triangle.h"

namespace boxwood::app {

using FlatShapes =
    std::variant<std::vector<Triangle>, std::vector<Sphere>, std::vector<Cuboid>, std::vector<AnyShape>>;

/// In the order of instances, and of primitives within each.
/// Throws std::invalid_argument as check(desc) does.
FlatShapes flatten(const SceneDesc& desc);

std::size_t shape_count(const FlatShapes& shapes);

/// "triangles", "spheres", "blocks" or "mixed shapes".
std::string kind_name(const FlatShapes& shapes);

}  // namespace boxwood::app
