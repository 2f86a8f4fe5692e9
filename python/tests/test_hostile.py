"""What nobody should hand over: nothing crashes, and nothing is quietly taken for something else."""

import copy
import ctypes
import os
import pickle
import random
import threading
import weakref

import numpy as np
import pytest

import boxwood as bw

DOWN = [0, 0, -1]
ABOVE = [0.1, 0.2, 5]


def raises(error, *words):
    return pytest.raises(error, match="(?s)" + ".*".join(map(str, words)))


# Arrays


def test_arrays_of_ctypes(scene):
    # They give no strides.
    above = (ctypes.c_double * 3)(*ABOVE)
    assert scene.closest_hit(above, (ctypes.c_byte * 3)(*DOWN)).t == scene.closest_hit(ABOVE, DOWN).t
    many = ((ctypes.c_float * 3) * 2)((0, 0, 5), (5, 5, 5))
    assert scene.any_hit(many, DOWN).tolist() == [True, False]
    assert bw.Scene.from_mesh(((ctypes.c_float * 3) * 3)(), ((ctypes.c_uint16 * 3) * 1)((0, 1, 2))).stats()["primitives"] == 1


def test_bytes_are_no_numbers(scene):
    with raises(TypeError, "origins", "S3", "floats or integers"):
        scene.closest_hit(b"abc", DOWN)


def test_masked_numbers_do_not_count(scene):
    above = np.ma.masked_array([ABOVE, ABOVE], mask=[[0, 0, 0], [0, 1, 0]])
    with raises(TypeError, "origins", "masked"):
        scene.closest_hit(above, DOWN)
    with raises(TypeError, "t_max", "masked"):
        scene.closest_hit(ABOVE, DOWN, t_max=np.ma.masked)
    with raises(TypeError, "triangles", "masked"):
        bw.Scene.from_mesh(np.eye(3), np.ma.masked_equal([[0, 1, 2]], 2))
    # Files are often read as masked arrays in which nothing is masked.
    assert scene.any_hit(above[:1], DOWN).tolist() == [True]
    assert scene.any_hit(above.filled(np.nan), DOWN).tolist() == [True, False]


@pytest.mark.parametrize("error, raised", [(KeyboardInterrupt, KeyboardInterrupt), (MemoryError, MemoryError),
                                           (RuntimeError, TypeError), (ValueError, ValueError)])
def test_what_an_array_raises(scene, error, raised):
    class Tensor:
        def __array__(self, *arguments, **kwargs):
            raise error("it is elsewhere")

    with raises(raised, "it is elsewhere") as found:
        scene.closest_hit(Tensor(), DOWN)
    assert "Traceback" not in str(found.value)
    if error in (RuntimeError, ValueError):
        assert str(found.value).startswith("origins: ") and isinstance(found.value.__cause__, error)


def test_numbers_too_large(scene):
    with raises(ValueError, "t_max", "too large"):
        scene.closest_hit(ABOVE, DOWN, t_max=10**400)
    assert scene.any_hit(ABOVE, DOWN, t_max=10**300)
    for index in (2**63, 2**64 - 1):
        with raises(ValueError, r"triangles\[0, 2\] is " + str(index) + ", expected 0 to 2"):
            bw.Scene.from_mesh(np.eye(3), np.array([[0, 1, index]], np.uint64))


def test_more_rays_than_memory_counts(scene):
    # By strides of zero such arrays take a few bytes. The sizes of their answers overflow 64 bits, some to 0.
    rows = lambda *shape: np.lib.stride_tricks.as_strided(np.zeros(3, "i1"), (*shape, 3), [0] * len(shape) + [1])
    for first, second in [((2**40,), (2**20, 1)), ((2**31, 1), (2**31,)), ((2**31, 1), (2**32,)), ((2**32, 1), (2**32,))]:
        for ask in (scene.closest_hit, scene.any_hit, scene.all_hits, scene.count_hits):
            with raises(MemoryError, "results need more memory"):
                ask(rows(*first), rows(*second))
        with raises(MemoryError, "results need more memory"):
            scene.closest_point(rows(*first), max_distance=rows(*second)[..., 0])
    with raises(MemoryError, "results need more memory"):
        scene.surface_at(ABOVE, DOWN, scene.closest_hit(ABOVE, DOWN)).spawn(rows(2**60))
    assert scene.closest_hit(rows(2**40, 0), rows(2**40, 1, 1)).shape == (2**40, 2**40, 0)


def test_more_dimensions_than_numpy_has(scene):
    most = 64 if np.lib.NumpyVersion(np.__version__) >= "2.0.0" else 32
    hits = scene.closest_hit(ABOVE, DOWN, t_max=np.full((1,) * most, 9))
    assert hits.t.shape == (1,) * most
    with raises(ValueError, str(most + 1), "dimensions"):
        hits.normal


def test_columns_that_are_changed_while_they_are_read():
    scene = bw.load("soup:2000")
    rng = np.random.default_rng(1)
    origins, directions = rng.uniform(size=(300_000, 3)), rng.normal(size=(300_000, 3))
    hits = scene.closest_hit(origins, directions)
    kept, done = hits.primitive_id.copy(), threading.Event()

    def change():
        while not done.is_set():
            hits.primitive_id[:] = 2**31 - 1
            hits.primitive_id[:] = kept

    changer = threading.Thread(target=change)
    changer.start()
    for _ in range(60):
        try:
            scene.surface_at(origins, directions, hits)
        except ValueError as error:
            assert "on nothing of this scene" in str(error)
    done.set()
    changer.join()


@pytest.mark.parametrize("column, value", [("primitive_id", 1), ("primitive_id", -1), ("geometry_id", 1), ("instance_id", 7),
                                           ("part", 6), ("part", -1), ("part", 2**31 - 1)])
def test_hits_that_were_changed(column, value):
    desc = bw.SceneDesc()
    desc.add_cuboids([[-1, -1, -1]], [[1, 1, 1]])
    scene = bw.Scene(desc)
    hits = scene.closest_hit([ABOVE] * 3, DOWN)
    getattr(hits, column)[1] = value
    with raises(ValueError, "hit 1 is on nothing of this scene"):
        scene.surface_at([ABOVE] * 3, DOWN, hits)


# Other arguments


@pytest.mark.parametrize("threads, error, words", [
    (1.5, TypeError, ["got 1.5", "integer"]), (None, TypeError, ["None", "integer"]), ("2", TypeError, ["'2'", "integer"]),
    (True, TypeError, ["True", "integer"]), (2**31, ValueError, [2**31, "0 .all. to 1024"]),
    (-(2**70), ValueError, [-(2**70), "0 .all. to 1024"]), (np.int64(-1), ValueError, [-1, "0 .all. to 1024"]),
])
def test_threads(scene, threads, error, words):
    mesh = np.eye(3), [[0, 1, 2]]
    for ask in (lambda: scene.closest_hit(ABOVE, DOWN, threads=threads), lambda: scene.closest_point(ABOVE, threads=threads),
                lambda: bw.Scene.from_mesh(*mesh, threads=threads), lambda: bw.load("cornell", threads=threads),
                lambda: bw.Scene(bw.SceneDesc(), threads=threads)):
        with raises(error, "threads", *words):
            ask()
    assert scene.any_hit(ABOVE, DOWN, threads=np.int64(2))


def test_ids(scene):
    desc = bw.SceneDesc()
    desc.add_mesh(np.eye(3), [[0, 1, 2]])
    for wrong, words in [(-1, "-1"), (2**70, str(2**70)), (1, "1")]:
        with raises(IndexError, "geometry_id", words, "expected 0 to 0"):
            scene.mesh(wrong)
        with raises(IndexError, "instance_id", words, "expected 0 to 0"):
            scene.instance(wrong)
        with raises(ValueError, "geometry", words, "expected 0 to 0"):
            desc.add_instance(wrong)
    for wrong in (0.0, None, "0", True):
        for ask in (scene.mesh, scene.instance, desc.add_instance):
            with raises(TypeError, "geometry|instance_id", "integer"):
                ask(wrong)
    hits = scene.closest_hit([ABOVE], DOWN)
    assert len(scene.mesh(hits.geometry_id[0])[1]) == scene.stats()["primitives"]
    assert desc.add_instance(hits.geometry_id[0]) == 0


def test_disks_as_spheres():
    with raises(ValueError, r"radii\[0\]", "-1", "0 or more"):
        bw.SceneDesc().add_disks([[0, 0, 0]], [[0, 0, 1]], [-1])


@pytest.mark.skipif(os.name == "nt", reason="names of files are text there")
def test_names_that_are_no_text(tmp_path):
    # Files in Latin-1, and files whose own names are: a name is shown as far as it can be read.
    folder = os.fsencode(tmp_path)
    good = os.path.join(folder, b"k\xf6rper.obj")
    with open(good, "wb") as file:
        file.write(b"g K\xf6rper\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    scene = bw.load(good)
    assert scene.geometry_names == ["K\ufffdrper"]
    assert pickle.loads(pickle.dumps(scene)).geometry_names == scene.geometry_names and "boxwood.Scene" in repr(scene)
    with open(os.path.join(folder, b"k\xe4lte.obj"), "wb") as file:
        file.write(b"f 1 2 3\n")
    with raises(bw.FileError, "k\ufffdlte.obj"):
        bw.load(os.path.join(folder, b"k\xe4lte.obj"))
    with pytest.raises(FileNotFoundError) as found:
        bw.load(os.path.join(folder, b"f\xe4hlt.obj"))
    assert os.fsencode(found.value.filename) == os.path.join(folder, b"f\xe4hlt.obj")


# Pickles


@pytest.fixture(scope="module")
def pickled():
    """One of everything that pickles."""
    desc = bw.SceneDesc()
    desc.name = "everything"
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    ids = [desc.add_mesh(corners, [[0, 1, 2]], normals=[[0, 0, 1]] * 3, uvs=corners[:, :2], name="leaf"),
           desc.add_spheres([[0, 0, 2]], [0.5]), desc.add_quads([[[0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 1]]]),
           desc.add_cuboids([[-1, -1, -1]], [[0, 0, 0]]), desc.add_disks([[1, 1, 1]], [[1, 1, 1]], [0.5])]
    for geometry in ids:
        desc.add_instance(geometry)
    scene = bw.Scene(desc)
    rays = np.array([ABOVE, [7, 7, 7], [0.3, 0.3, 3]]), DOWN
    hits = scene.closest_hit(*rays)
    return [desc, scene, bw.load("cornell"), bw.BuildOptions.best(), bw.load("cornell").camera, hits, scene.all_hits(*rays),
            scene.closest_point(rays[0]), scene.surface_at(*rays, hits)]


def columns(result):
    return {name: getattr(result, name) for name in dir(type(result))
            if not name.startswith("_") and not callable(getattr(result, name))}


@pytest.mark.parametrize("again", [lambda x: pickle.loads(pickle.dumps(x)), lambda x: pickle.loads(pickle.dumps(x, 2)), copy.copy,
                                   copy.deepcopy])
def test_everything_pickles(pickled, again):
    for one in pickled:
        other = again(one)
        assert type(other) is type(one)
        if not isinstance(one, (bw.Camera, bw.Surfaces)):
            assert repr(other) == repr(one)
        if isinstance(one, (bw.Hits, bw.AllHits, bw.Points, bw.Surfaces, bw.Camera)):
            assert len(columns(one)) >= 6
            for name, column in columns(one).items():
                np.testing.assert_array_equal(getattr(other, name), column)
    scene, hits = pickled[1], again(pickled[5])
    surfaces = scene.surface_at([ABOVE, [7, 7, 7], [0.3, 0.3, 3]], DOWN, hits)
    np.testing.assert_array_equal(again(surfaces).spawn([DOWN] * 3), pickled[8].spawn([DOWN] * 3))
    hits.t[:] = 0
    assert not (pickled[5].t == 0).any()  # nothing is shared


def spoil(state, rng):
    """The same with something wrong somewhere."""
    if isinstance(state, (tuple, list)) and len(state) and rng.random() < 0.9:
        if rng.random() < 0.1:
            return state[:rng.randrange(len(state))]
        if rng.random() < 0.05:
            return state + state
        i = rng.randrange(len(state))
        return (*state[:i], spoil(state[i], rng), *state[i + 1:])
    if isinstance(state, bytes) and state and rng.random() < 0.7:
        spoiled = bytearray(state)
        if rng.random() < 0.3:
            return bytes(spoiled[:rng.randrange(len(spoiled))])
        for _ in range(rng.randrange(1, 5)):
            spoiled[rng.randrange(len(spoiled))] = rng.randrange(256)
        return bytes(spoiled)
    return rng.choice([None, -1, 0, 77, 2**31, 2**62, 2**70, 1.5, float("nan"), b"", b"x" * 112, "", "\udcff", (), (1,), (1, 2, 3),
                       [], {}, True, np.zeros(3), np.zeros((3, 3), "f4"), np.array("x"), (2**32, 2**32), (0, 2**62)])


@pytest.mark.parametrize("seed", range(4))
def test_spoiled_pickles(pickled, seed):
    rng = random.Random(seed)
    refused = 0
    for _ in range(700):
        one = rng.choice(pickled)
        state = spoil(one.__getstate__(), rng)
        other = type(one).__new__(type(one))
        try:
            other.__setstate__(state)
        except (ValueError, TypeError, MemoryError):
            refused += 1
            continue
        # What was taken can be used, or says what is wrong with it.
        repr(other)
        pickle.dumps(other)
        try:
            if isinstance(other, bw.SceneDesc):
                other = bw.Scene(other)
            if isinstance(other, bw.Scene):
                other.closest_hit(np.full((50, 3), ABOVE), np.linspace(DOWN, ABOVE, 50))
            elif isinstance(other, bw.BuildOptions):
                bw.Scene(pickled[0], other)
            else:
                columns(other)
        except ValueError:
            pass
    assert refused > 200


def test_pickles_of_other_versions(scene):
    with raises(ValueError, "pickle", "version"):
        bw.BuildOptions.__new__(bw.BuildOptions).__setstate__(())


@pytest.mark.filterwarnings("ignore:nanobind")
def test_a_built_scene_is_not_set_again(scene):
    with pytest.raises(TypeError):
        scene.__setstate__(scene.__getstate__())
    with pytest.raises(TypeError):
        scene.__init__(bw.SceneDesc())
    assert scene.any_hit(ABOVE, DOWN)


# Objects


def test_weak_references(scene):
    hits = scene.closest_hit(ABOVE, DOWN)
    cache = weakref.WeakKeyDictionary({scene: 1, hits: 2})
    assert cache[scene] == 1 and cache[hits] == 2
    del hits
    assert len(cache) == 1
