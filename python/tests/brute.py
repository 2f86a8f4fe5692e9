"""brute.py: what would be answered if there were no trees? NumPy, in double, every ray against every primitive."""

import numpy as np


def triangles_of(vertices, triangles):
    return np.asarray(vertices, np.float64)[np.asarray(triangles)]


def ray_triangles(origins, directions, corners):
    """t (k, m), inf where the ray misses, and how far the crossing is from the nearest edge (barycentric, k, m)."""
    o, d = np.asarray(origins, np.float64)[:, None], np.asarray(directions, np.float64)[:, None]
    a, e1, e2 = corners[None, :, 0], corners[None, :, 1] - corners[None, :, 0], corners[None, :, 2] - corners[None, :, 0]
    p = np.cross(d, e2)
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1 / np.sum(e1 * p, -1)
        s = o - a
        u = np.sum(s * p, -1) * inverse
        q = np.cross(s, e1)
        v = np.sum(d * q, -1) * inverse
        t = np.sum(e2 * q, -1) * inverse
        margin = np.minimum(np.minimum(u, v), 1 - u - v)
    margin = np.where(np.isnan(margin), -1, margin)
    return np.where(margin >= 0, t, np.inf), margin


def closest(t, t_min=0.0, t_max=np.inf):
    """(t, index) of the smallest t in [t_min, t_max] of each row; (inf, -1) for none."""
    inside = np.where((t >= np.reshape(t_min, (-1, 1))) & (t <= np.reshape(t_max, (-1, 1))), t, np.inf)
    if inside.shape[1] == 0:
        return np.full(len(t), np.inf), np.full(len(t), -1)
    index = np.argmin(inside, axis=1)
    best = inside[np.arange(len(t)), index]
    return best, np.where(np.isfinite(best), index, -1)


def is_clear(margin, slack=1e-4):
    """Rays that pass no edge so near that float and double could differ."""
    return np.all(np.abs(margin) > slack, axis=1) if margin.shape[1] else np.ones(len(margin), bool)


def closest_point_on_triangles(points, corners):
    """Distance (k, m) from each point to each triangle."""
    p = np.asarray(points, np.float64)[:, None]
    a, b, c = (corners[None, :, i] for i in range(3))
    best = np.full((len(points), len(corners)), np.inf)
    # Inside: the foot on the plane.
    n = np.cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        n = n / np.linalg.norm(n, axis=-1, keepdims=True)
    height = np.sum((p - a) * n, -1)
    foot = p - height[..., None] * n
    inside = np.ones_like(best, bool)
    for x, y in ((a, b), (b, c), (c, a)):
        inside &= np.sum(np.cross(y - x, foot - x) * n, -1) >= 0
    best = np.where(inside, np.abs(height), best)
    # Outside: the nearest point of an edge.
    for x, y in ((a, b), (b, c), (c, a)):
        e = y - x
        with np.errstate(divide="ignore", invalid="ignore"):
            s = np.clip(np.nan_to_num(np.sum((p - x) * e, -1) / np.sum(e * e, -1)), 0, 1)
        best = np.minimum(best, np.linalg.norm(p - (x + s[..., None] * e), axis=-1))
    return best
