"""Any dtype, any strides, any shape: the answers are those of plain float32 arrays, and the arrays stay as they were."""

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings

import boxwood as bw
from conftest import uv_sphere

SCENE = bw.Scene.from_mesh(*uv_sphere())
DTYPES = ["f2", "f4", "f8", "g", ">f4", ">f8", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", ">i4", ">u2"]


def layouts(array, draw):
    """The same numbers in another arrangement of memory."""
    kind = draw(st.sampled_from(["plain", "fortran", "every second", "backwards", "read-only", "unaligned", "list", "column of more"]))
    if kind == "fortran":
        array = np.asfortranarray(array)
    elif kind == "every second":
        wide = np.full([2 * n for n in array.shape], 77, array.dtype)
        wide[tuple(slice(None, None, 2) for _ in array.shape)] = array
        array = wide[tuple(slice(None, None, 2) for _ in array.shape)]
    elif kind == "backwards":
        array = array[..., ::-1].copy()[..., ::-1]
    elif kind == "read-only":
        array = array.copy()
        array.flags.writeable = False
    elif kind == "unaligned":
        raw = np.zeros(array.nbytes + 1, np.uint8)
        raw[1:] = np.frombuffer(array.tobytes(), np.uint8)
        array = np.frombuffer(raw.data, array.dtype, array.size, 1).reshape(array.shape)
    elif kind == "list" and array.size:
        return array.tolist()
    elif kind == "column of more":
        array = np.concatenate([array, array], axis=-1)[..., : array.shape[-1]]
    return array


@st.composite
def ray_arrays(draw):
    shapes = draw(hnp.mutually_broadcastable_shapes(num_shapes=4, max_dims=3, max_side=5, min_side=0))
    arrays = []
    for shape in shapes.input_shapes[:2]:
        dtype = np.dtype(draw(st.sampled_from(DTYPES)))
        values = draw(hnp.arrays(np.int8, (*shape, 3), elements=st.integers(-3 if dtype.kind != "u" else 0, 3)))
        arrays.append(layouts(values.astype(dtype), draw))
    limits = [np.zeros(shapes.input_shapes[2], draw(st.sampled_from(DTYPES))),
              np.full(shapes.input_shapes[3], 5, draw(st.sampled_from(DTYPES)))]
    return arrays, limits, shapes.result_shape


def plain(value, shape, row=()):
    return np.ascontiguousarray(np.broadcast_to(np.asarray(value, np.float32), (*shape, *row)))


@settings(max_examples=400, deadline=None)
@given(ray_arrays(), st.sampled_from([0, 1, 3]))
def test_rays_of_any_kind(rays, threads):
    (origins, directions), (t_min, t_max), shape = rays
    before = [np.array(a, copy=True) for a in (origins, directions, t_min, t_max)]
    hits = SCENE.closest_hit(origins, directions, t_min=t_min, t_max=t_max, threads=threads)
    for array, old in zip((origins, directions, t_min, t_max), before):
        np.testing.assert_array_equal(array, old)

    expected = SCENE.closest_hit(plain(origins, shape, (3,)), plain(directions, shape, (3,)), t_max=np.float32(5))
    assert hits.shape == shape and hits.t.shape == shape
    for name, row in [("t", ()), ("primitive_id", ()), ("geometry_id", ()), ("instance_id", ()), ("part", ()),
                      ("uv", (2,)), ("normal", (3,)), ("position", (3,))]:
        column = getattr(hits, name)
        assert column.shape == shape + row and column.flags.c_contiguous and column.flags.writeable
        np.testing.assert_array_equal(column, getattr(expected, name))

    any_hit = SCENE.any_hit(origins, directions, t_min=t_min, t_max=t_max, threads=threads)
    assert any_hit.dtype == bool and any_hit.shape == shape
    np.testing.assert_array_equal(any_hit, hits.primitive_id >= 0)
    counts = SCENE.count_hits(origins, directions, t_min=t_min, t_max=t_max, threads=threads)
    assert counts.shape == shape
    every = SCENE.all_hits(origins, directions, t_min=t_min, t_max=t_max, threads=threads)
    assert every.shape == shape
    np.testing.assert_array_equal(np.diff(every.offsets), counts.ravel())
    first = every.offsets[:-1][counts.ravel() > 0]
    np.testing.assert_array_equal(every.t[first], hits.t.ravel()[counts.ravel() > 0])


@settings(max_examples=150, deadline=None)
@given(ray_arrays(), st.sampled_from([0, 2]))
def test_points_of_any_kind(rays, threads):
    (points, _), (_, reach), _ = rays
    shape = np.broadcast_shapes(np.shape(points)[:-1], np.shape(reach))
    found = SCENE.closest_point(points, max_distance=reach, threads=threads)
    expected = SCENE.closest_point(plain(points, shape, (3,)), max_distance=5)
    assert found.shape == shape
    for name in ("distance", "position", "primitive_id", "geometry_id", "instance_id"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))


@settings(max_examples=150, deadline=None)
@given(st.data(), st.sampled_from(DTYPES), st.sampled_from([d for d in DTYPES if np.dtype(d).kind in "iu"]))
def test_meshes_of_any_kind(data, float_type, index_type):
    vertices = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]])
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    scene = bw.Scene.from_mesh(layouts(vertices.astype(float_type), data.draw), layouts(triangles.astype(index_type), data.draw))
    got_vertices, got_triangles = scene.mesh()
    np.testing.assert_array_equal(got_vertices, vertices)
    np.testing.assert_array_equal(got_triangles, triangles)
    assert not got_vertices.flags.writeable
    assert scene.closest_hit([0.5, 1, 1], [0, 0, -1]).primitive_id == 1


@pytest.mark.parametrize("count", [0, 1, 2, 511, 512, 513, 4096, 100_001])
def test_long_and_short_batches_agree(count, rng):
    origins, directions = rng.normal(size=(count, 3)), rng.normal(size=(count, 3))
    many = SCENE.closest_hit(origins, directions)
    every = SCENE.all_hits(origins, directions)
    assert len(every.offsets) == count + 1
    for i in list(range(min(count, 3))) + list(range(max(0, count - 3), count)):
        one = SCENE.closest_hit(origins[i], directions[i])
        assert one.shape == () and one.t == many.t[i]
        np.testing.assert_array_equal(one.position, many.position[i])
        np.testing.assert_array_equal(every.t[every.offsets[i]:every.offsets[i + 1]], SCENE.all_hits(origins[i], directions[i]).t)


@pytest.mark.parametrize("count", [*range(1, 10), *range(126, 134), 4095, 4096, 4097])
def test_packed_float32_is_read_as_any_other(count, rng):
    origins, directions = rng.normal(size=(2, count, 3)).astype(np.float32)
    packed = SCENE.closest_hit(origins, directions, t_max=7)
    other = SCENE.closest_hit(np.asfortranarray(origins, float), np.asfortranarray(directions, float), t_max=7)
    for column in ("t", "uv", "normal", "position", "primitive_id", "geometry_id", "instance_id", "part"):
        np.testing.assert_array_equal(getattr(packed, column), getattr(other, column))
    is_hit = packed.primitive_id >= 0
    expected = origins + directions * packed.t[:, None]
    np.testing.assert_array_equal(packed.position[is_hit], expected[is_hit])
    assert np.isnan(packed.position[~is_hit]).all() and np.isnan(packed.normal[~is_hit]).all()
    np.testing.assert_array_equal(np.isfinite(packed.normal).all(1), is_hit)
    for i in (0, count // 2, count - 1):  # as one ray alone, which goes to no four
        one = SCENE.closest_hit(origins[i], directions[i], t_max=7)
        for column in ("t", "normal", "primitive_id", "geometry_id", "instance_id", "part"):
            np.testing.assert_array_equal(getattr(one, column), getattr(packed, column)[i])


def test_empty_scene():
    scene = bw.Scene.from_mesh(np.zeros((0, 3)), np.zeros((0, 3), int))
    hits = scene.closest_hit(np.zeros((4, 3)), [0, 0, 1])
    assert np.isinf(hits.t).all() and (hits.primitive_id == -1).all()
    assert bw.Scene(bw.SceneDesc()).any_hit([0, 0, 0], [0, 0, 1]) == np.False_


def test_arrays_share_their_result(rng):
    hits = SCENE.closest_hit(rng.normal(size=(10, 3)), [0, 0, 1])
    assert hits.t is hits.t
    t, copy = hits.t, hits.t.copy()
    del hits
    for _ in range(5):
        SCENE.closest_hit(rng.normal(size=(10, 3)), [0, 0, 1])
    np.testing.assert_array_equal(t, copy)


def test_odd_rays_miss():
    nan, inf = np.nan, np.inf
    for origin, direction, t_max in [([nan, 0, 0], [0, 0, 1], 9), ([0, 0, 0], [0, 0, 0], 9), ([0, 0, 0], [0, nan, 1], 9),
                                     ([inf, 0, 0], [0, 0, 1], 9), ([0, 0, 0], [0, 0, 1], nan), ([0, 0, 0], [0, 0, 1], -1),
                                     ([0, 0, 1e300], [0, 0, 1], 9)]:
        assert SCENE.closest_hit(origin, direction, t_max=t_max).primitive_id == -1
    assert SCENE.closest_point([nan, 0, 0]).primitive_id == -1


def test_other_libraries_arrays_and_memoryviews():
    import array

    assert SCENE.closest_hit(array.array("d", [0, 0, 5]), memoryview(np.array([0, 0, -1], "i2"))).t == 4
