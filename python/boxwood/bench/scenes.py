"""scenes.py: which meshes and rays are measured?"""

import os
import pathlib

import numpy as np

from .. import load


def default_names():
    """Bunny, dragon and kitchen from the folder that BOXWOOD_MODELS names; without it, scenes that are made here."""
    folder = os.environ.get("BOXWOOD_MODELS")
    if folder:
        return [str(pathlib.Path(folder) / name) for name in ("bunny.obj", "dragon.ply", "kitchen/scene.pbrt")]
    return ["soup:70000", "terrain:512"]


def as_mesh(name):
    """A scene as one mesh in the world, so that every engine is given the same."""
    scene = load(name)
    vertices, triangles, first = [], [], 0
    for i in range(scene.instance_count):
        geometry, m = scene.instance(i)
        try:
            v, t = scene.mesh(geometry)
        except TypeError:  # spheres and such, which no peer has
            continue
        vertices.append(v @ m[:3, :3].T.astype(np.float32) + m[:3, 3].astype(np.float32))
        triangles.append(t.astype(np.int64) + first)
        first += len(v)
    if not triangles:
        raise SystemExit(f"{name}: there is no mesh in it")
    return np.concatenate(vertices).astype(np.float32), np.concatenate(triangles).astype(np.uint32)


def short_name(name):
    path = pathlib.Path(name)
    return path.parent.name if path.stem == "scene" else path.stem


def random_rays(vertices, count):
    """Incoherent: origins anywhere in the mesh's box, unit directions anywhere."""
    rng = np.random.default_rng(7)
    lower, upper = vertices.min(axis=0), vertices.max(axis=0)
    origins = rng.uniform(lower, upper, (count, 3)).astype(np.float32)
    directions = rng.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return origins, directions.astype(np.float32)
