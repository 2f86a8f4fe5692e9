"""Scenes in the life of a program: threads, signals, pickles, memory."""

import base64
import copy
import json
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import boxwood as bw


def run(code):
    """Runs a program and returns what it prints."""
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.fixture(scope="module")
def rays():
    rng = np.random.default_rng(2)
    return rng.normal(size=(20_000, 3)), rng.normal(size=(20_000, 3))


@pytest.fixture(scope="module")
def mixed():
    """One of everything, with instances."""
    desc = bw.SceneDesc()
    desc.name = "mixed"
    mesh = desc.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], normals=[[0, 0, 1]] * 3, name="leaf")
    ids = [mesh, desc.add_spheres([[0, 0, 2]], [0.5]), desc.add_quads([[[0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 1]]]),
           desc.add_cuboids([[-1, -1, -1]], [[0, 0, 0]]), desc.add_disks([[1, 1, 1]], [[1, 1, 1]], [0.5])]
    for i, geometry in enumerate(ids):
        m = np.eye(4)
        m[:3, 3] = [i, 0, 0]
        desc.add_instance(geometry, m)
    return desc


def same(a, b, rays):
    x, y = a.closest_hit(*rays), b.closest_hit(*rays)
    assert (x.primitive_id >= 0).any()
    return all(np.array_equal(getattr(x, n), getattr(y, n), equal_nan=True)
               for n in ("t", "primitive_id", "geometry_id", "instance_id", "part", "uv", "normal", "position"))


@pytest.mark.parametrize("again", [lambda x: pickle.loads(pickle.dumps(x)), copy.copy, copy.deepcopy])
def test_scenes_pickle(mixed, scene, rays, again):
    for one in (bw.Scene(mixed), scene, bw.Scene(mixed, bw.BuildOptions.fast()), bw.Scene(mixed, compact())):
        other = again(one)
        assert repr(other) == repr(one) and same(one, other, rays)
        assert repr(other.options) == repr(one.options)
    assert same(bw.Scene(again(mixed)), bw.Scene(mixed), rays)


def test_what_a_file_says_is_pickled(tmp_path):
    made = bw.load("cornell")
    other = pickle.loads(pickle.dumps(made))
    assert other.name == made.name and other.camera.fov_deg == made.camera.fov_deg
    np.testing.assert_array_equal(other.camera.world_from_camera, made.camera.world_from_camera)


def test_cameras_of_files(tmp_path):
    triangle = base64.b64encode(np.eye(3, dtype="<f4").tobytes()).decode()
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"camera": 0, "mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + triangle}],
            "cameras": [{"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "zfar": 100, "znear": 0.1}}]}
    (tmp_path / "flat.gltf").write_text(json.dumps(gltf))
    assert bw.load(tmp_path / "flat.gltf").camera.orthographic_size == 4  # parallel rays
    (tmp_path / "lens.pbrt").write_text(
        'Camera "perspective" "float fov" 40 "float lensradius" 0.25 "float focaldistance" 7\nWorldBegin\nShape "sphere"\n')
    camera = bw.load(tmp_path / "lens.pbrt").camera
    assert (camera.fov_deg, camera.lens_radius, camera.focus_distance, camera.orthographic_size) == (40, 0.25, 7, 0)


def test_repr_and_stats(mixed, scene):
    text = repr(bw.Scene(mixed))
    for word in ("mixed", "1 mesh of 1 triangle", "1 sphere", "1 quad", "1 cuboid", "1 disk", "5 instances"):
        assert word in text
    assert repr(mixed).startswith("<boxwood.SceneDesc: 1 mesh of 1 triangle")
    hits = scene.closest_hit([[0, 0, 5], [0, 5, 5]], [0, 0, -1])
    assert repr(hits) == "<boxwood.Hits: shape (2,), 1 of 2 hit>" and len(hits) == 2
    assert "2 crossings of rays of shape (1,)" in repr(scene.all_hits([[0.1, 0, 5]], [0, 0, -1]))
    assert "2 of 2 found" in repr(scene.closest_point([[0, 0, 5], [0, 5, 5]]))
    assert "binned_sah" in repr(bw.BuildOptions())
    stats = scene.stats()
    assert stats["primitives"] == 12 * 16 * 2 - 32 and stats["nodes"] > 0 and stats["build_ms"] > 0
    np.testing.assert_allclose(scene.bounds, [[-1, -1, -1], [1, 1, 1]], atol=1e-6)


def test_instances_and_meshes_can_be_read(mixed):
    scene = bw.Scene(mixed)
    assert scene.geometry_names == mixed.geometry_names == ["leaf", "", "", "", ""]
    assert scene.geometry_count == 5 and scene.instance_count == 5
    geometry, m = scene.instance(3)
    assert geometry == 3 and m[0, 3] == 3 and m.shape == (4, 4)
    vertices, triangles = scene.mesh(0)
    del scene
    assert vertices[1, 0] == 1 and triangles.tolist() == [[0, 1, 2]]
    with pytest.raises(TypeError, match="not a mesh"):
        bw.Scene(mixed).mesh(1)
    with pytest.raises(IndexError):
        bw.Scene(mixed).instance(5)


def compact():
    options = bw.BuildOptions.balanced()
    options.is_compact = True
    options.block_size = 2
    return options


@pytest.mark.parametrize("options", [bw.BuildOptions.fast(), bw.BuildOptions.best(), compact()])
def test_answers_do_not_depend_on_builder_or_threads(sphere, scene, rays, options):
    for threads in (0, 1, 2):
        other = bw.Scene.from_mesh(*sphere, options=options, threads=threads)
        assert same(scene, other, rays)
        a, b = scene.closest_hit(*rays), scene.closest_hit(*rays, threads=threads)
        np.testing.assert_array_equal(a.position, b.position)


def test_many_threads_ask_one_scene(scene, rays):
    expected = scene.closest_hit(*rays).t
    wrong = []

    def ask():
        for threads in (1, 2, 0):
            if not np.array_equal(scene.closest_hit(*rays, threads=threads).t, expected):
                wrong.append(threads)

    askers = [threading.Thread(target=ask) for _ in range(6)]
    for thread in askers:
        thread.start()
    for thread in askers:
        thread.join()
    assert not wrong


def test_the_gil_is_released():
    # While one thread asks a long question, another counts: it could not if the question held the lock.
    scene = bw.load("soup:20000")
    rng = np.random.default_rng(1)
    origins, directions = rng.uniform(0, 1, (300_000, 3)), rng.normal(size=(300_000, 3))
    counted, done = 0, threading.Event()

    def ask():
        scene.all_hits(origins, directions, threads=1)
        done.set()

    asker = threading.Thread(target=ask)
    asker.start()
    while not done.is_set():
        counted += 1
        time.sleep(0.001)
    asker.join()
    assert counted > 5


def square(scene_and_rays):
    scene, rays = scene_and_rays
    return scene.closest_hit(*rays).t


@pytest.mark.parametrize("method", ["fork", "spawn"])
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_processes(scene, rays, method):
    expected = scene.closest_hit(*rays).t
    with multiprocessing.get_context(method).Pool(2) as pool:
        for t in pool.map(square, [(scene, rays)] * 3):
            np.testing.assert_array_equal(t, expected)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_a_fork_in_the_middle_of_a_question():
    # A fork has none of the threads that work, and whatever they had locked stays locked.
    out = run("""
        import os, threading, time, warnings, numpy as np, boxwood as bw
        warnings.simplefilter("ignore")
        scene = bw.load("soup:5000")
        rng = np.random.default_rng(1)
        rays = rng.uniform(size=(200_000, 3)), rng.normal(size=(200_000, 3))
        expected, is_over = scene.closest_hit(*rays).t, threading.Event()
        def ask():
            while not is_over.is_set():
                scene.closest_hit(*rays)
        threading.Thread(target=ask).start()
        children, same = [], 0
        for _ in range(12):
            time.sleep(0.03)
            child = os.fork()
            if child == 0:
                again = bw.Scene.from_mesh(*scene.mesh())
                answers = [scene.closest_hit(*rays, threads=n).t for n in (0, 2)] + [again.closest_hit(*rays).t]
                os._exit(0 if all(np.array_equal(t, expected) for t in answers) else 1)
            children.append(child)
        end = time.monotonic() + 60
        while children and time.monotonic() < end:
            child, status = os.waitpid(children[0], os.WNOHANG)
            if child:
                children.pop(0)
                same += status == 0
            else:
                time.sleep(0.01)
        is_over.set()
        for child in children:
            os.kill(child, 9)
        print(same)
    """)
    assert out == "12"


@pytest.mark.parametrize("work", [
    "scene.closest_hit(origins, directions, threads={threads})",
    "scene.all_hits(origins, directions, threads={threads})",
    "scene.closest_point(origins, threads={threads})",
    "bw.Scene.from_mesh(vertices, triangles, threads={threads}, options=bw.BuildOptions.best())",
])
@pytest.mark.parametrize("threads", [1, 2])
def test_ctrl_c(work, threads):
    # The work would take a minute or more. Ctrl-C comes while it runs, and ends it long before its end.
    out = run(f"""
        import os, signal, threading, time, numpy as np, boxwood as bw
        signal.signal(signal.SIGINT, signal.default_int_handler)  # tests in the background are started without it
        scene = bw.load("soup:2000")
        rng = np.random.default_rng(1)
        if "from_mesh" in {work!r}:
            vertices = rng.uniform(0, 1, (9_000_000, 3)).astype("f4")
            triangles = np.arange(9_000_000).reshape(-1, 3)
        # A billion rays, by a stride of zero.
        origins = np.broadcast_to(rng.uniform(0, 1, (1000, 3)).astype("f4"), (50_000, 1000, 3))
        directions = np.array([0.3, 0.5, 0.8], "f4")
        def interrupt():
            time.sleep(0.5)
            os.kill(os.getpid(), signal.SIGINT)
        threading.Thread(target=interrupt).start()
        try:
            {work.format(threads=threads)}
        except KeyboardInterrupt:
            print("interrupted", bool(scene.any_hit([0.5, 0.5, 0.5], [0, 0, 1])) in (True, False))
    """)
    assert out == "interrupted True"


@pytest.mark.parametrize("work", ["scene.surface_at(origins, down, hits, threads={threads})",
                                  "surfaces.spawn(many, threads={threads})"])
@pytest.mark.parametrize("threads", [1, 2])
def test_ctrl_c_among_surfaces(work, threads):
    # Seconds of work, and the signal comes at its beginning.
    out = run(f"""
        import os, signal, threading, time, numpy as np, boxwood as bw
        signal.signal(signal.SIGINT, signal.default_int_handler)
        scene = bw.Scene.from_mesh(np.eye(3) * 9, [[0, 1, 2]])
        origins, down = np.broadcast_to(np.array([1, 1, 9], "f4"), (6000, 1000, 3)), np.array([0, 0, -1], "f4")
        hits = scene.closest_hit(origins, down)
        surfaces = scene.surface_at(origins[0, 0], down, scene.closest_hit(origins[0, 0], down))
        many = np.broadcast_to(down, (60_000_000, 3))
        start = time.perf_counter()
        {work.format(threads=threads)}
        whole = time.perf_counter() - start
        def interrupt():
            time.sleep(0.1)
            os.kill(os.getpid(), signal.SIGINT)
        start = time.perf_counter()
        threading.Thread(target=interrupt).start()
        try:
            {work.format(threads=threads)}
        except KeyboardInterrupt:
            print("interrupted", time.perf_counter() - start < 0.1 + 0.7 * (whole - 0.1))
    """)
    assert out == "interrupted True"


COLUMNS = ("t", "primitive_id", "geometry_id", "instance_id", "part", "uv", "normal", "position")


@pytest.mark.parametrize("question, rays, share", [("closest_hit", 3_000_000, 0.25), ("all_hits", 1_000_000, 1)])
def test_peak_memory(question, rays, share):
    # Beside its results a call needs less memory than they take.
    out = run(f"""
        import numpy as np, boxwood as bw
        def memory(key):
            return next(int(line.split()[1]) * 1024 for line in open("/proc/self/status") if line.startswith(key))
        scene = bw.load("soup:2000")
        rng = np.random.default_rng(1)
        origins, directions = rng.uniform(0, 1, ({rays}, 3)), rng.normal(size=({rays}, 3))
        scene.{question}(origins[:10000], directions[:10000])
        before = memory("VmRSS")
        open("/proc/self/clear_refs", "w").write("5")
        hits = scene.{question}(origins, directions)
        peak = memory("VmHWM") - before
        size = sum(getattr(hits, name).nbytes for name in {COLUMNS} + (("offsets",) if hasattr(hits, "offsets") else ()))
        assert peak - size < {share} * size, (peak, size)
        print("small")
    """)
    assert out == "small"


def test_the_memory_of_old_results_is_used_again_and_lent_to_the_system():
    out = run(f"""
        import numpy as np, boxwood as bw
        def lent():  # of this process, by the system's own account
            return next(int(line.split()[1]) * 1024 for line in open("/proc/self/smaps_rollup") if line.startswith("LazyFree"))
        scene = bw.load("soup:2000")
        rng = np.random.default_rng(1)
        origins, directions = rng.uniform(0, 1, (2_000_000, 3)), rng.normal(size=(2_000_000, 3))
        hits = scene.closest_hit(origins, directions)
        expected = {{name: getattr(hits, name).copy() for name in {COLUMNS}}}
        place = hits.t.ctypes.data
        size = sum(column.nbytes for column in expected.values())
        kept = hits.normal  # an array keeps all of it
        del hits
        assert lent() < 0.1 * size, lent()
        del kept
        assert lent() > 0.9 * size, lent()
        again = scene.closest_hit(origins, directions)
        assert again.t.ctypes.data == place and lent() < 0.1 * size
        for name, column in expected.items():
            np.testing.assert_array_equal(getattr(again, name), column)
        print("again")
    """)
    assert out == "again"


def test_import_brings_numpy_alone():
    out = run("""
        import sys, numpy
        before = set(sys.modules)
        import boxwood
        print(sorted(m.split(".")[0] for m in set(sys.modules) - before if not m.startswith("boxwood")))
    """)
    assert out in ("[]", "['atexit']")


def test_cpu_target():
    assert bw.cpu_target() in ("avx512", "avx2", "sse4", "neon", "scalar")
    code = "import boxwood as b; print(b.cpu_target(), b.load('soup:500').closest_hit([.5]*3, [1, 2, 3]).t.tobytes().hex())"
    answers = set()
    for target in ("scalar", bw.cpu_target()):
        done = subprocess.run([sys.executable, "-c", code], env={**os.environ, "BOXWOOD_TARGET": target}, capture_output=True, text=True)
        name, answer = done.stdout.split()
        assert name == target
        answers.add(answer)
    assert len(answers) == 1


def test_next_rays_start_beyond_the_surface(sphere, scene, rng):
    origins = rng.normal(size=(2000, 3)) * 3
    directions = -origins
    hits = scene.closest_hit(origins, directions)
    surfaces = scene.surface_at(origins, directions, hits)
    np.testing.assert_allclose(surfaces.position, hits.position, atol=1e-5)
    assert (np.abs(surfaces.position - hits.position) <= surfaces.error + 1e-5).all()
    np.testing.assert_array_equal(surfaces.normal, hits.normal)
    outward = rng.normal(size=(4, 2000, 3))
    outward *= np.sign(np.sum(outward * hits.normal, -1, keepdims=True))
    starts = surfaces.spawn(outward)
    np.testing.assert_array_equal(surfaces.spawn(outward, threads=1), starts)
    assert starts.shape == (4, 2000, 3)
    assert not scene.any_hit(starts, outward).any()  # a convex body: nothing is hit from outside
    inward = scene.closest_hit(surfaces.spawn(-outward), -outward)
    assert (inward.primitive_id >= 0).all()
    assert (inward.primitive_id != hits.primitive_id).all()  # and never the triangle that the ray leaves
    with pytest.raises(ValueError, match="directions"):
        surfaces.spawn(outward[0, :7])
