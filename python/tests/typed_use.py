"""A program with types, for test_types.py: both checkers must accept it, and see the types that it claims."""

import pathlib
from typing import TYPE_CHECKING, Optional

import numpy as np
import numpy.typing as npt

import boxwood as bw

if TYPE_CHECKING:
    from typing_extensions import assert_type

    scene: bw.Scene = bw.Scene.from_mesh(np.zeros((3, 3)), [[0, 1, 2]], options=bw.BuildOptions.fast(), threads=2)
    assert_type(bw.load(pathlib.Path("kitchen") / "scene.pbrt"), bw.Scene)
    hits = scene.closest_hit([0, 0, 5], np.ones((4, 3), np.float64), t_max=3, threads=1)
    assert_type(hits, bw.Hits)
    assert_type(hits.t, npt.NDArray[np.float32])
    assert_type(hits.primitive_id, npt.NDArray[np.int32])
    assert_type(hits.shape, tuple[int, ...])
    assert_type(scene.any_hit([0, 0, 0], [0, 0, 1]), npt.NDArray[np.bool_])
    assert_type(scene.all_hits([0, 0, 0], [0, 0, 1]).offsets, npt.NDArray[np.int64])
    assert_type(scene.count_hits([0, 0, 0], [0, 0, 1]), npt.NDArray[np.int64])
    assert_type(scene.closest_point([0, 0, 0], max_distance=np.ones(4)).position, npt.NDArray[np.float32])
    assert_type(scene.surface_at([0, 0, 0], [0, 0, 1], hits).spawn([0, 0, 1]), npt.NDArray[np.float32])
    assert_type(scene.stats()["nodes"], float)
    assert_type(scene.camera, Optional[bw.Camera])
    assert_type(scene.mesh(0), tuple[npt.NDArray[np.float32], npt.NDArray[np.uint32]])
    assert_type(scene.geometry_names, list[str])
    desc = bw.SceneDesc()
    assert_type(desc.add_mesh(np.zeros((3, 3)), [[0, 1, 2]], name="leaf"), int)
    desc.add_instance(0, np.eye(4))
    assert_type(bw.Scene(desc).name, str)
    assert_type(bw.cpu_target(), str)
    assert_type(bw.__version__, str)
