"""peers.py: how is each engine asked the same questions?

An engine has a name, and a method for each question that it answers: closest_hit(origins, directions, threads) and so on.
What a method returns is compared with the answers of boxwood before any time is believed. Work that a user would do once,
such as laying out rays in an engine's own tensor, is done by `prepare` and not timed.
"""

import importlib.util

import numpy as np

from .. import Scene

QUESTIONS = ("closest hit", "any hit", "all hits", "closest point")


class Boxwood:
    name = "boxwood"

    def __init__(self, vertices, triangles):
        self.scene = Scene.from_mesh(vertices, triangles)

    def prepare(self, question, origins, directions):
        return origins, directions

    def closest_hit(self, rays, threads):
        return self.scene.closest_hit(*rays, threads=threads).t

    def any_hit(self, rays, threads):
        return self.scene.any_hit(*rays, threads=threads)

    def all_hits(self, rays, threads):
        return np.diff(self.scene.all_hits(*rays, threads=threads).offsets)

    def closest_point(self, rays, threads):
        return self.scene.closest_point(rays[0], threads=threads).distance


class Embreex:
    """The module under trimesh's fast rays: Embree, one ray after the other on one thread."""

    name = "embreex"

    def __init__(self, vertices, triangles):
        from embreex import rtcore_scene
        from embreex.mesh_construction import TriangleMesh

        self.scene = rtcore_scene.EmbreeScene()
        TriangleMesh(scene=self.scene, vertices=np.array(vertices, np.float32), indices=np.array(triangles, np.int32))

    def prepare(self, question, origins, directions):
        return origins, directions

    def closest_hit(self, rays, threads):
        # With output=True it returns what boxwood does: t, u, v, normal, ids.
        found = self.scene.run(*rays, output=True)
        return np.where(found["primID"] >= 0, found["tfar"], np.inf)

    def any_hit(self, rays, threads):
        return self.scene.run(*rays, query="OCCLUDED") >= 0


class Trimesh:
    """trimesh with embreex below it."""

    name = "trimesh"

    def __init__(self, vertices, triangles):
        import trimesh

        self.mesh = trimesh.Trimesh(vertices, triangles, process=False)

    def prepare(self, question, origins, directions):
        return origins, directions

    def closest_hit(self, rays, threads):
        location, ray, _ = self.mesh.ray.intersects_location(*rays, multiple_hits=False)
        t = np.full(len(rays[0]), np.inf)
        t[ray] = np.einsum("ij,ij->i", location - rays[0][ray], rays[1][ray])
        return t

    def any_hit(self, rays, threads):
        return self.mesh.ray.intersects_any(*rays)

    def all_hits(self, rays, threads):
        _, ray = self.mesh.ray.intersects_id(*rays)
        return np.bincount(ray, minlength=len(rays[0]))

    def closest_point(self, rays, threads):
        from trimesh.proximity import closest_point

        return closest_point(self.mesh, rays[0])[1]


class Open3D:
    name = "open3d"

    def __init__(self, vertices, triangles):
        import open3d

        self.tensor = open3d.core.Tensor.from_numpy
        self.scene = open3d.t.geometry.RaycastingScene()
        self.scene.add_triangles(self.tensor(np.array(vertices, np.float32)), self.tensor(np.array(triangles, np.uint32)))

    def prepare(self, question, origins, directions):
        if question == "closest point":
            return self.tensor(origins)
        return self.tensor(np.concatenate([origins, directions], axis=1))

    def closest_hit(self, rays, threads):
        return self.scene.cast_rays(rays, nthreads=threads)["t_hit"].numpy()

    def any_hit(self, rays, threads):
        return self.scene.test_occlusions(rays, nthreads=threads).numpy()

    def all_hits(self, rays, threads):
        return np.diff(self.scene.list_intersections(rays, nthreads=threads)["ray_splits"].numpy())

    def closest_point(self, rays, threads):
        return self.scene.compute_closest_points(rays, nthreads=threads)["points"].numpy()


def installed():
    """The peers that can be imported here."""
    peers = [(Embreex, ["embreex"]), (Trimesh, ["trimesh", "embreex", "rtree"]), (Open3D, ["open3d"])]
    return [peer for peer, modules in peers if all(importlib.util.find_spec(m) for m in modules)]


def disagreement(question, ours, theirs, points, size):
    """The share of rays on which two answers differ by more than rounding does."""
    if question == "closest hit":
        differs = np.isinf(ours) != np.isinf(theirs)
        both = np.isfinite(ours) & np.isfinite(theirs)
        differs[both] = np.abs(ours[both] - theirs[both]) > 1e-3 * np.abs(ours[both]) + 1e-4 * size
    elif question == "closest point":
        if theirs.ndim == 2:
            theirs = np.linalg.norm(theirs - points, axis=1)
        differs = np.abs(ours - theirs) > 1e-3 * ours + 1e-4 * size
    else:
        differs = np.asarray(ours) != np.asarray(theirs)
    return float(np.mean(differs)) if len(differs) else 0.0
