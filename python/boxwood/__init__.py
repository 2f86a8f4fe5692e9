"""What does a ray hit? A million rays from NumPy, at full speed.

    scene = boxwood.Scene.from_mesh(vertices, triangles)
    hits = scene.closest_hit(origins, directions)
    hits.t, hits.primitive_id, hits.normal
"""

from ._core import (
    AllHits,
    BuildOptions,
    Camera,
    FileError,
    Hits,
    Method,
    Points,
    Scene,
    SceneDesc,
    Surfaces,
    cpu_target,
    load,
    load_description,
)
from ._core import version as __version__

__all__ = [
    "AllHits",
    "BuildOptions",
    "Camera",
    "FileError",
    "Hits",
    "Method",
    "Points",
    "Scene",
    "SceneDesc",
    "Surfaces",
    "__version__",
    "cpu_target",
    "load",
    "load_description",
]
