import numpy as np
import pytest

import boxwood as bw


def uv_sphere(rings=12, segments=16, radius=1.0):
    """A closed mesh: (vertices, triangles), wound outward."""
    theta = np.linspace(0, np.pi, rings + 1)[1:-1]
    phi = np.arange(segments) * 2 * np.pi / segments
    ring = np.stack([np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi)),
                     np.outer(np.cos(theta), np.ones(segments))], -1).reshape(-1, 3)
    vertices = np.vstack([[0, 0, 1], ring, [0, 0, -1]]) * radius
    triangles = []
    index = lambda r, s: 1 + r * segments + s % segments
    for s in range(segments):
        triangles.append((0, index(0, s), index(0, s + 1)))
        triangles.append((len(vertices) - 1, index(rings - 2, s + 1), index(rings - 2, s)))
        for r in range(rings - 2):
            triangles.append((index(r, s), index(r + 1, s), index(r + 1, s + 1)))
            triangles.append((index(r, s), index(r + 1, s + 1), index(r, s + 1)))
    return vertices, np.array(triangles)


@pytest.fixture(scope="session")
def sphere():
    return uv_sphere()


@pytest.fixture(scope="session")
def scene(sphere):
    return bw.Scene.from_mesh(*sphere)


@pytest.fixture(scope="session")
def soup():
    """Random triangles: (vertices, triangles)."""
    rng = np.random.default_rng(3)
    centers = rng.uniform(-1, 1, (300, 1, 3))
    return (centers + rng.normal(0, 0.2, (300, 3, 3))).reshape(-1, 3), np.arange(900).reshape(-1, 3)


@pytest.fixture
def rng():
    return np.random.default_rng(11)
