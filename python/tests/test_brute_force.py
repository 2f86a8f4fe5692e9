"""Every question against brute force written in NumPy."""

import numpy as np
import pytest

import boxwood as bw
import brute


@pytest.fixture(params=["sphere", "soup"])
def mesh(request):
    return request.getfixturevalue(request.param)


@pytest.fixture
def rays(rng):
    return rng.uniform(-1.5, 1.5, (700, 3)).astype(np.float32), rng.normal(size=(700, 3)).astype(np.float32)


@pytest.mark.parametrize("t_min, t_max", [(0, np.inf), (0.3, np.inf), (0, 0.4), (0.2, 0.9)])
@pytest.mark.parametrize("threads", [0, 1, 2])
def test_closest_and_any_hit(mesh, rays, t_min, t_max, threads):
    scene = bw.Scene.from_mesh(*mesh)
    corners = brute.triangles_of(*mesh)
    t, margin = brute.ray_triangles(*rays, corners)
    expected_t, expected_id = brute.closest(t, t_min, t_max)
    with np.errstate(invalid="ignore"):
        far_from_ends = (np.abs(t - t_min) > 1e-4) & (np.abs(t - t_max) > 1e-4) | np.isinf(t)
    clear = brute.is_clear(margin) & far_from_ends.all(axis=1)
    assert clear.mean() > 0.5

    hits = scene.closest_hit(*rays, t_min=t_min, t_max=t_max, threads=threads)
    assert hits.t.dtype == np.float32 and hits.primitive_id.dtype == np.int32
    np.testing.assert_allclose(hits.t[clear], expected_t[clear], rtol=2e-4, atol=1e-5)
    np.testing.assert_array_equal(hits.primitive_id[clear], expected_id[clear])
    np.testing.assert_array_equal(scene.any_hit(*rays, t_min=t_min, t_max=t_max, threads=threads), hits.primitive_id >= 0)

    # The rest follows from t and the triangle.
    hit = hits.primitive_id >= 0
    assert 0 < hit.sum() < len(hit)
    np.testing.assert_array_equal(hits.geometry_id, np.where(hit, 0, -1))
    np.testing.assert_array_equal(hits.instance_id, np.where(hit, 0, -1))
    assert np.isinf(hits.t[~hit]).all() and np.isnan(hits.normal[~hit]).all() and np.isnan(hits.position[~hit]).all()
    a, b, c = np.moveaxis(corners[hits.primitive_id[hit]], 1, 0)
    u, v = hits.uv[hit].astype(np.float64).T
    np.testing.assert_allclose(hits.position[hit], a * (1 - u - v)[:, None] + b * u[:, None] + c * v[:, None], atol=1e-4)
    normal = np.cross(b - a, c - a)
    np.testing.assert_allclose(hits.normal[hit], normal / np.linalg.norm(normal, axis=1, keepdims=True), atol=1e-4)


@pytest.mark.parametrize("threads", [0, 1])
def test_all_hits_and_count_hits(mesh, rays, threads):
    scene = bw.Scene.from_mesh(*mesh)
    t, margin = brute.ray_triangles(*rays, brute.triangles_of(*mesh))
    clear = brute.is_clear(margin) & np.all((np.abs(t) > 1e-4) | np.isinf(t), axis=1)
    found = scene.all_hits(*rays, threads=threads)
    assert found.offsets[0] == 0 and found.offsets[-1] == len(found) == len(found.t) == len(found.normal)
    np.testing.assert_array_equal(np.diff(found.offsets), scene.count_hits(*rays, threads=threads))
    for i in np.flatnonzero(clear):
        ids = np.flatnonzero((t[i] >= 0) & np.isfinite(t[i]))
        ids = ids[np.argsort(t[i, ids])]
        mine = slice(found.offsets[i], found.offsets[i + 1])
        np.testing.assert_allclose(found.t[mine], t[i, ids], rtol=2e-4, atol=1e-5)
        assert sorted(found.primitive_id[mine]) == sorted(ids)
        assert (np.diff(found.t[mine]) >= 0).all()
        np.testing.assert_allclose(found.position[mine], rays[0][i] + rays[1][i] * found.t[mine][:, None], atol=1e-4)


@pytest.mark.parametrize("reach", [np.inf, 0.3])
def test_closest_point(mesh, rays, reach):
    scene = bw.Scene.from_mesh(*mesh)
    points = rays[0]
    distance = brute.closest_point_on_triangles(points, brute.triangles_of(*mesh))
    expected = distance.min(axis=1)
    found = scene.closest_point(points, max_distance=reach)
    is_near = expected <= reach
    decided = np.abs(expected - reach) > 1e-5
    np.testing.assert_allclose(found.distance[is_near & decided], expected[is_near & decided], atol=1e-5)
    assert (found.primitive_id[~is_near & decided] == -1).all() and np.isinf(found.distance[~is_near & decided]).all()
    hit = found.primitive_id >= 0
    assert hit.any() and np.isnan(found.position[~hit]).all()
    np.testing.assert_allclose(np.linalg.norm(found.position[hit] - points[hit], axis=1), found.distance[hit], atol=1e-5)
    # The primitive that is named is as near as any.
    np.testing.assert_allclose(distance[hit, found.primitive_id[hit]], expected[hit], atol=1e-5)


def test_spheres_and_instances(rng):
    centers, radii = rng.uniform(-2, 2, (40, 3)), rng.uniform(0.1, 0.5, 40)
    desc = bw.SceneDesc()
    balls = desc.add_spheres(centers, radii)
    shift, turn = np.eye(4), np.eye(4)
    shift[:3, 3] = [5, 0, 0]
    turn[:3, :3] = 2 * np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    transforms = [np.eye(4), shift, turn]
    assert [desc.add_instance(balls, m) for m in transforms] == [0, 1, 2]
    scene = bw.Scene(desc)

    origins, directions = rng.uniform(-4, 8, (500, 3)), rng.normal(size=(500, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    world = np.concatenate([centers @ m[:3, :3].T + m[:3, 3] for m in transforms])
    radius = np.concatenate([radii, radii, 2 * radii])
    to_center = world[None] - origins[:, None]
    along = np.einsum("kmc,kc->km", to_center, directions)
    under_root = radius**2 - (np.sum(to_center**2, -1) - along**2)
    with np.errstate(invalid="ignore"):
        half = np.sqrt(under_root)
    t = np.where(along - half >= 0, along - half, along + half)
    t = np.where(np.isnan(half) | (t < 0), np.inf, t)
    expected, index = brute.closest(t)
    clear = (np.abs(under_root) > 1e-3).all(axis=1) & (np.abs(t) > 1e-3).all(axis=1)

    hits = scene.closest_hit(origins, directions)
    np.testing.assert_allclose(hits.t[clear], expected[clear], rtol=1e-3, atol=1e-4)
    hit = clear & (index >= 0)
    assert hit.sum() > 50
    np.testing.assert_array_equal(hits.primitive_id[hit], index[hit] % 40)
    np.testing.assert_array_equal(hits.instance_id[hit], index[hit] // 40)
    outward = (hits.position[hit] - world[index[hit]]) / radius[index[hit], None]
    np.testing.assert_allclose(hits.normal[hit], outward, atol=2e-3)
    both = np.sum(np.stack([along - half >= 0, along + half >= 0]) & ~np.isnan(half), axis=(0, 2))
    np.testing.assert_array_equal(scene.count_hits(origins, directions)[clear], both[clear])
    near = scene.closest_point(origins)
    np.testing.assert_allclose(near.distance, np.abs(np.linalg.norm(to_center, axis=-1) - radius).min(axis=1), atol=2e-4)


def test_quads_cuboids_and_disks():
    desc = bw.SceneDesc()
    desc.add_quads([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]])
    desc.add_cuboids([[2, 0, 0]], [[3, 1, 1]])
    desc.add_disks([[5, 0.5, 0]], [[0, 0, 2]], [0.4])
    scene = bw.Scene(desc)
    hits = scene.closest_hit([[0.5, 0.5, 5], [2.5, 0.5, 5], [5, 0.5, 5], [5.5, 0.5, 5]], [0, 0, -1])
    np.testing.assert_allclose(hits.t, [5, 4, 5, np.inf])
    np.testing.assert_array_equal(hits.geometry_id, [0, 1, 2, -1])
    np.testing.assert_allclose(hits.normal[:3], [[0, 0, 1]] * 3)
