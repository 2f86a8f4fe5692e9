// scene_type.h: what is a Scene to Python?
#pragma once

#include "boxwood/scene/scene.h"
#include "describe.h"

namespace boxwood::python {

/// A built scene and how it was built, which a pickle repeats.
struct SceneObject {
  Scene scene;
  BuildOptions options;
};

/// Builds without the GIL, and so that Ctrl-C ends it.
SceneObject build_scene(SceneDesc desc, BuildOptions options, nb::handle threads);

/// The class Scene: how it comes to be and what it tells of itself.
void bind_scene(nb::module_& module);

}  // namespace boxwood::python
