"""How much of the sky does each point of a scene see?

Rays through the pixels of a camera find the surface; from each point there, a few dozen rays go out into the hemisphere,
and the share of them that meets nothing nearby is the pixel's brightness.
"""

import time

import numpy as np

import boxwood as bw
import pictures
from pictures import plt

options = pictures.arguments(__doc__, width=900, samples=96)
width, height = options.width, options.width * 9 // 16

scene = bw.load("stilllife")
origin, directions = pictures.camera_rays(scene.camera, width, height)
start = time.perf_counter()
hits = scene.closest_hit(origin, directions)
surfaces = scene.surface_at(origin, directions, hits)
normal = np.where(np.sum(surfaces.shading_normal * directions, -1, keepdims=True) > 0, -1, 1) * surfaces.shading_normal

# Directions around the normal, more of them near it (by the cosine): a point on the unit ball, moved by the normal.
rng = np.random.default_rng(1)
sky_seen = np.zeros((height, width), np.float32)
for _ in range(options.samples):
    around = rng.normal(size=(height, width, 3)).astype(np.float32)
    around = normal + around / np.linalg.norm(around, axis=-1, keepdims=True)
    sky_seen += ~scene.any_hit(surfaces.spawn(around), around, t_max=2.5)
brightness = np.where(hits.primitive_id >= 0, sky_seen / options.samples, 1)
seconds = time.perf_counter() - start

rays = directions.size // 3 * (1 + options.samples)
print(f"{rays:,} rays in {seconds:.2f} s")
figure = plt.figure(figsize=(width / 100, height / 100), dpi=100)
axes = figure.add_axes((0, 0, 1, 1))
axes.imshow(brightness**0.8, cmap="gray", vmin=0, vmax=1)
axes.axis("off")
pictures.save(figure, options.output)
