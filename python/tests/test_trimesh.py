"""The class that stands in for trimesh's own rays: the same arrays, checked against trimesh's slow exact engine."""

import copy
import pickle
import warnings

import numpy as np
import pytest
import trimesh
from trimesh.ray.ray_triangle import RayMeshIntersector as SlowIntersector

from boxwood.trimesh import RayMeshIntersector


@pytest.fixture(params=["icosphere", "torus", "box", "far away"])
def mesh(request):
    mesh = {"icosphere": lambda: trimesh.creation.icosphere(2), "torus": lambda: trimesh.creation.torus(2, 0.7),
            "box": lambda: trimesh.creation.box()}.get(request.param, lambda: trimesh.creation.icosphere(2))()
    if request.param == "far away":
        mesh.apply_translation([5000, -3000, 200])
    return mesh


@pytest.fixture
def rays(mesh, rng):
    size = np.max(mesh.extents)
    origins = mesh.bounds.mean(axis=0) + rng.normal(size=(400, 3)) * size
    targets = mesh.bounds.mean(axis=0) + rng.uniform(-0.8, 0.8, (400, 3)) * mesh.extents
    return origins, targets - origins


def by_ray_and_triangle(index_tri, index_ray, *more):
    order = np.lexsort((index_tri, index_ray))
    return [a[order] for a in (index_tri, index_ray, *more)]


def test_the_same_hits_as_the_slow_engine(mesh, rays):
    ours, slow = RayMeshIntersector(mesh), SlowIntersector(mesh)
    a = by_ray_and_triangle(*ours.intersects_id(*rays, return_locations=True))
    b = by_ray_and_triangle(*slow.intersects_id(*rays, return_locations=True))
    np.testing.assert_array_equal(a[0], b[0])
    np.testing.assert_array_equal(a[1], b[1])
    np.testing.assert_allclose(a[2], b[2], atol=1e-9 * max(1, np.abs(mesh.bounds).max()))
    assert a[0].dtype == a[1].dtype == np.int64 and a[2].dtype == np.float64

    first = ours.intersects_first(*rays)
    assert first.shape == (400,) and (first >= 0).any() and (first < 0).any()
    np.testing.assert_array_equal(first, slow.intersects_first(*rays))
    np.testing.assert_array_equal(ours.intersects_any(*rays), first >= 0)

    locations, index_ray, index_tri = ours.intersects_location(*rays, multiple_hits=False)
    np.testing.assert_array_equal(index_tri, first[first >= 0])
    np.testing.assert_array_equal(index_ray, np.flatnonzero(first >= 0))
    assert locations.shape == (len(index_ray), 3)


def test_contains_points(mesh, rng):
    points = mesh.bounds.mean(axis=0) + rng.uniform(-0.7, 0.7, (1000, 3)) * mesh.extents
    ours = RayMeshIntersector(mesh).contains_points(points)
    assert ours.any() and not ours.all()
    np.testing.assert_array_equal(ours, SlowIntersector(mesh).contains_points(points))


def test_tiny_and_huge_meshes_answer_alike(mesh, rays, rng):
    # A power of two changes no digit, so the answers are the same.
    points = mesh.bounds.mean(axis=0) + rng.uniform(-0.7, 0.7, (200, 3)) * mesh.extents
    expected = RayMeshIntersector(mesh)
    for scale in (2.0**-40, 2.0**40):
        scaled = RayMeshIntersector(mesh.copy().apply_scale(scale))
        np.testing.assert_array_equal(scaled.intersects_id(rays[0] * scale, rays[1]), expected.intersects_id(*rays))
        np.testing.assert_array_equal(scaled.contains_points(points * scale), expected.contains_points(points))


def test_max_hits(mesh, rays):
    ours = RayMeshIntersector(mesh)
    every, one = ours.intersects_id(*rays), ours.intersects_id(*rays, max_hits=1)
    assert len(one[0]) < len(every[0])
    np.testing.assert_array_equal(one, ours.intersects_id(*rays, multiple_hits=False))


def test_rays_along_the_outline_hit():
    mesh = trimesh.creation.box(extents=[2, 2, 2])
    ray = RayMeshIntersector(mesh)
    x, y = (g.ravel() for g in np.meshgrid([-1, 0, 1], [-1, 0, 1]))
    origins = np.stack([x, y, np.full(9, 5)], axis=1)
    directions = np.tile([0, 0, -1], (9, 1))
    assert ray.intersects_any(origins, directions).all()
    assert (ray.intersects_first(origins, directions) >= 0).all()
    assert (np.bincount(ray.intersects_id(origins, directions)[1]) >= 1).all()
    assert not ray.intersects_any(origins + [2.001, 0, 0], directions)[x >= 0].any()


def test_a_mesh_that_changes_is_built_again():
    mesh = trimesh.creation.box()
    mesh.ray = RayMeshIntersector(mesh)
    ask = [[0, 0, 5]], [[0, 0, -1]]
    assert mesh.ray.intersects_location(*ask, multiple_hits=False)[0][0, 2] == 0.5
    mesh.apply_translation([0, 0, 2])
    assert mesh.ray.intersects_location(*ask, multiple_hits=False)[0][0, 2] == 2.5
    mesh.apply_translation([9, 0, 0])
    assert not mesh.ray.intersects_any(*ask)[0]


def test_open_meshes_and_no_points():
    mesh = trimesh.creation.icosphere(2)
    mesh.update_faces(np.arange(len(mesh.faces)) != 5)
    ray = RayMeshIntersector(mesh)
    assert ray.contains_points([[0, 0, 0], [0.2, 0.1, 0]]).all()
    assert ray.contains_points(np.zeros((0, 3))).shape == (0,)
    assert ray.intersects_first(np.zeros((0, 3)), np.zeros((0, 3))).shape == (0,)
    locations, index_ray, index_tri = ray.intersects_location([[9, 9, 9]], [[1, 0, 0]])
    assert locations.shape == (0, 3) and index_ray.shape == index_tri.shape == (0,)


def test_it_copies_and_pickles(rays, mesh):
    ray = RayMeshIntersector(mesh, threads=1)
    expected = ray.intersects_first(*rays)
    for other in (copy.copy(ray), copy.deepcopy(ray), pickle.loads(pickle.dumps(ray))):
        assert other.threads == 1
        np.testing.assert_array_equal(other.intersects_first(*rays), expected)


def test_wrong_shapes_are_refused():
    ray = RayMeshIntersector(trimesh.creation.box())
    with pytest.raises(ValueError, match=r"ray_origins.*\(2, 3\).*\(1, 3\)"):
        ray.intersects_any(np.zeros((2, 3)), np.ones((1, 3)))
    with pytest.raises(ValueError, match=r"points.*\(3,\)"):
        ray.contains_points([0, 0, 0])


def test_odd_numbers():
    broken = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [np.nan, 1, 0]], [[0, 1, 2]], process=False, validate=False)
    with pytest.raises(ValueError, match=r"vertices\[2, 0\] is nan"):
        RayMeshIntersector(broken).intersects_any([[0, 0, 5]], [[0, 0, -1]])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        directions = [[0, 0, 0], [0, 0, np.nan], [0, 0, -np.inf], [0, 0, -1e300], [0, 0, -1e-300]]
        is_hit = RayMeshIntersector(trimesh.creation.box()).intersects_any([[0.1, 0.2, 5]] * 5, directions)
        assert is_hit.tolist() == [False] * 3 + [True] * 2


def test_everywhere():
    import subprocess
    import sys

    code = """
import trimesh, boxwood.trimesh
boxwood.trimesh.use_everywhere()
mesh = trimesh.creation.box()
print(type(mesh.ray).__module__, mesh.contains([[0, 0, 0], [2, 0, 0]]).tolist())
"""
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert out.strip() == "boxwood.trimesh [True, False]"
