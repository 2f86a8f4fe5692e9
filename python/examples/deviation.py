"""Where does a measured point cloud lie off its mesh?

The cloud is a scan of a teapot with a dent and a bulge, and noise. The nearest point of the mesh says how far off each point
lies, and the normal there says on which side.
"""

import time

import numpy as np

import boxwood as bw
import pictures
from pictures import plt

options = pictures.arguments(__doc__, points=300_000)

# The mesh as designed: the teapot of a made scene, in centimeters.
vertices, triangles = bw.load("stilllife").mesh(1)
vertices = (vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2) * 5.0
scene = bw.Scene.from_mesh(vertices, triangles)

# The "scan": points on the mesh, by area, that are moved a little.
rng = np.random.default_rng(4)
corners = vertices[triangles]
doubled_area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
which = rng.choice(len(triangles), options.points, p=doubled_area / doubled_area.sum())
u, v = rng.random((2, options.points))
u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
a, b, c = np.moveaxis(corners[which], 1, 0)
cloud = a + u[:, None] * (b - a) + v[:, None] * (c - a)
# What can be seen from outside is what a scanner sees.
normal = np.cross(b - a, c - a)
normal /= np.linalg.norm(normal, axis=1, keepdims=True)
seen = ~scene.any_hit(cloud + 1e-3 * normal, normal, t_max=2)
cloud, normal = cloud[seen], normal[seen]
bump = lambda center, size: np.exp(-np.sum((cloud - center) ** 2, axis=1) / (2 * size**2))
push = 0.25 * bump([1.2, 1.0, 7.5], 1.6) - 0.3 * bump([-5.5, -1.5, 6.0], 1.8)
cloud = cloud + (push + rng.normal(0, 0.01, len(cloud)))[:, None] * normal

start = time.perf_counter()
nearest = scene.closest_point(cloud)
seconds = time.perf_counter() - start
side = np.sign(np.sum((cloud - nearest.position) * normal, axis=1))
deviation = 10 * side * nearest.distance  # millimeters
print(f"{len(cloud):,} points in {seconds:.2f} s; {np.mean(np.abs(deviation) > 0.5):.1%} are off by more than 0.5 mm")

# Seen from the front and lit from above: what faces away is left out, the nearest come last.
towards = np.array([-0.35, 0.38, 0.86])
across = np.cross([0, 1, 0], towards)
eye = np.array([across, np.cross(towards, across), towards])
x, y, depth = eye @ cloud.T
front = (eye @ normal.T)[2] > 0
order = np.flatnonzero(front)[np.argsort(depth[front])]
color = plt.cm.coolwarm(deviation / 4 + 0.5)[:, :3] * (0.62 + 0.38 * np.clip(normal @ np.array([0.3, 0.8, 0.5]), 0, 1))[:, None]
figure, axes = plt.subplots(figsize=(8, 4.3), dpi=110)
axes.scatter(x[order], y[order], c=color[order], s=2.8, linewidths=0)
scale = plt.cm.ScalarMappable(plt.Normalize(-2, 2), "coolwarm")
figure.colorbar(scale, ax=axes, fraction=0.03, pad=0.01, label="mm off the mesh")
axes.set_aspect("equal")
axes.axis("off")
figure.tight_layout(pad=0.4)
pictures.save(figure, options.output)
