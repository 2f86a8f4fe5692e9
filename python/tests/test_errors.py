"""What is wrong is refused at the door, with the argument's name, what came, and what was expected."""

import numpy as np
import pytest

import boxwood as bw

V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
T = np.array([[0, 1, 2]])


def raises(error, *words):
    return pytest.raises(error, match="(?s)" + ".*".join(map(str, words)))


@pytest.mark.parametrize("vertices, triangles, error, words", [
    (V[:, :2], T, ValueError, ["vertices", r"\(3, 2\)", r"\(\.\.\., 3\)"]),
    (V[0], T, ValueError, ["vertices", r"\(3,\)", r"\(n, 3\)"]),
    (V[None], T, ValueError, ["vertices", r"\(1, 3, 3\)", r"\(n, 3\)"]),
    (V, T[:, :2], ValueError, ["triangles", r"\(1, 2\)", r"\(\.\.\., 3\)"]),
    (np.where(V == 1, np.nan, V), T, ValueError, [r"vertices\[1, 0\]", "nan", "finite"]),
    (np.where(V == 1, np.inf, V), T, ValueError, [r"vertices\[1, 0\]", "inf", "finite"]),
    (np.where(V == 1, 1e300, V), T, ValueError, [r"vertices\[1, 0\]", "inf", r"2\^126"]),
    (V, [[0, 1, 3]], ValueError, [r"triangles\[0, 2\]", "3", "0 to 2"]),
    (V, [[0, -1, 2]], ValueError, [r"triangles\[0, 1\]", "-1", "0 to 2"]),
    (V, [[0, 1, 2**32]], ValueError, [r"triangles\[0, 2\]", str(2**32), "0 to 2"]),
    (V, np.array([[0, 1, 2**63 + 1]], np.uint64), ValueError, [r"triangles\[0, 2\]"]),
    (V, T.astype(float), TypeError, ["triangles", "float64", "integers"]),
    (V.astype(complex), T, TypeError, ["vertices", "complex128", "floats or integers"]),
    (V.astype(bool), T, TypeError, ["vertices", "bool", "floats or integers"]),
    (V.astype(str), T, TypeError, ["vertices", "<U", "floats or integers"]),
    (V.astype(object), T, TypeError, ["vertices", "object", "floats or integers"]),
    ([[0, 1], [2]], T, ValueError, ["vertices", "array"]),
    (None, T, TypeError, ["vertices", "object"]),
    (np.zeros((0, 3)), T, ValueError, [r"triangles\[0, 0\]", "no vertices"]),
])
def test_meshes(vertices, triangles, error, words):
    with raises(error, *words):
        bw.Scene.from_mesh(vertices, triangles)


def test_normals():
    with raises(ValueError, "normals", "got 2", "expected 3", "vertices"):
        bw.Scene.from_mesh(V, T, normals=V[:2])


@pytest.mark.parametrize("call", ["closest_hit", "any_hit", "all_hits", "count_hits"])
def test_rays(scene, call):
    ask = getattr(scene, call)
    with raises(ValueError, "origins", r"\(4, 2\)", r"\(\.\.\., 3\)"):
        ask(np.zeros((4, 2)), [0, 0, 1])
    with raises(ValueError, "directions", r"\(\)", r"\(\.\.\., 3\)"):
        ask([0, 0, 0], 1.0)
    with raises(ValueError, "directions", r"\(4,\)", r"\(5,\)", "origins"):
        ask(np.zeros((5, 3)), np.ones((4, 3)))
    with raises(ValueError, "t_max", r"\(2,\)", r"\(5,\)"):
        ask(np.zeros((5, 3)), [0, 0, 1], t_max=[1, 2])
    with raises(TypeError, "t_min", "complex", "floats or integers"):
        ask(np.zeros((5, 3)), [0, 0, 1], t_min=1j)
    with raises(ValueError, "threads", "-1", "1024"):
        ask(np.zeros((5, 3)), [0, 0, 1], threads=-1)
    with pytest.raises(ValueError):
        ask(np.zeros((5, 3)), [0, 0, 1], threads=5000)
    with pytest.raises(TypeError):
        ask(np.zeros((5, 3)), [0, 0, 1], threads=1.5)
    with pytest.raises(TypeError):
        ask(np.zeros((5, 3)))


def test_points(scene):
    with raises(ValueError, "points", r"\(3, 4\)", r"\(\.\.\., 3\)"):
        scene.closest_point(np.zeros((3, 4)))
    with raises(ValueError, "max_distance", r"\(2,\)", "points"):
        scene.closest_point(np.zeros((3, 3)), max_distance=[1, 2])


def test_shapes_and_instances():
    desc = bw.SceneDesc()
    with raises(ValueError, "radii", "got 1", "expected 2", "centers"):
        desc.add_spheres(np.zeros((2, 3)), [1])
    with raises(ValueError, r"radii\[1\]", "-1", "0 or more"):
        desc.add_spheres(np.zeros((2, 3)), [1, -1])
    with raises(ValueError, "corners", r"\(4, 3\)", r"\(\.\.\., 4, 3\)|\(n, 4, 3\)"):
        desc.add_quads(np.zeros((4, 3)))
    with raises(ValueError, "geometry", "got 0", "no geometries"):
        desc.add_instance(0)
    ball = desc.add_spheres([[0, 0, 0]], [1])
    with raises(ValueError, "world_from_object", r"\(3, 3\)", r"4, 4\)"):
        desc.add_instance(ball, np.eye(3))
    with raises(ValueError, "world_from_object", "inverted"):
        desc.add_instance(ball, np.diag([1, 1, 0, 1]))
    with raises(ValueError, "world_from_object", "last row", "0 0 0 1"):
        desc.add_instance(ball, np.eye(4).T + np.eye(4)[::-1])
    with raises(ValueError, "geometry", "got -1", "0 to 0"):
        desc.add_instance(-1)


def test_a_stretched_ball_has_no_closest_point():
    desc = bw.SceneDesc()
    desc.add_instance(desc.add_spheres([[0, 0, 0]], [1]), np.diag([1, 2, 1, 1]))
    with raises(ValueError, "closest_point", "similarity"):
        bw.Scene(desc).closest_point([3, 0, 0])


def test_surfaces_of_other_rays(scene):
    hits = scene.closest_hit([[0, 0, 5]], [0, 0, -1])
    with raises(ValueError, "hits", r"\(1,\)", r"\(2,\)"):
        scene.surface_at([[0, 0, 5]] * 2, [0, 0, -1], hits)
    with raises(ValueError, "nothing of this scene"):
        bw.Scene.from_mesh(np.zeros((0, 3)), np.zeros((0, 3), int)).surface_at([[0, 0, 5]], [0, 0, -1], hits)


def test_options():
    options = bw.BuildOptions()
    options.leaf_size = 0
    with raises(ValueError, "leaf_size"):
        bw.Scene.from_mesh(V, T, options=options)


def test_files(tmp_path):
    with pytest.raises(FileNotFoundError, match="nowhere.obj"):
        bw.load(tmp_path / "nowhere.obj")
    bad = tmp_path / "bad.obj"
    bad.write_text("f 1 2 3\n")
    with raises(bw.FileError, "bad.obj"):
        bw.load(bad)
    with raises(OSError, "endings"):
        bw.load(__file__)
    with raises(ValueError, "terrain"):
        bw.load("terrain:minus")
