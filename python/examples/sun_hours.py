"""How many hours of sun does each spot of a landscape get in a day?

Every ten minutes from sunrise to sunset, a ray goes from each spot towards the sun; the spots that it leaves unhindered are in
the sun. The day is that of an equinox at 40 degrees north, where the sun stays low enough to throw long shadows.
"""

import time

import numpy as np

import boxwood as bw
import pictures
from pictures import plt

options = pictures.arguments(__doc__, spots=420, minutes=10)

scene = bw.load("terrain:256")
lower, upper = scene.bounds

# The spots: where rays from above meet the ground; and a little above it, so that none hits the ground it stands on.
x, z = np.meshgrid(np.linspace(lower[0], upper[0], options.spots + 2)[1:-1], np.linspace(lower[2], upper[2], options.spots + 2)[1:-1])
above = np.stack([x, np.full_like(x, upper[1] + 1), z], axis=-1)
ground = scene.closest_hit(above, [0, -1, 0])
places = scene.surface_at(above, [0, -1, 0], ground)

# Where the sun stands: x is east, -z is north.
latitude, start = np.radians(40), time.perf_counter()
hours, rays = np.zeros(x.shape, np.float32), 0
for hour in np.arange(6, 18, options.minutes / 60):
    angle = np.radians(15 * (hour - 12))
    sun = np.array([-np.sin(angle), np.cos(latitude) * np.cos(angle), np.sin(latitude) * np.cos(angle)])
    facing = ground.normal @ sun > 0
    towards = np.broadcast_to(sun, ground.normal.shape)
    is_lit = facing & ~scene.any_hit(places.spawn(towards), sun)
    hours += is_lit * options.minutes / 60
    rays += is_lit.size
print(f"{rays:,} rays in {time.perf_counter() - start:.2f} s")

# The map, shaded a little by the slope; where the ground is flat is the sea.
height = ground.position[..., 1]
shade = 0.78 + 0.22 * np.clip(ground.normal @ np.array([-0.5, 0.7, -0.5]), 0, 1)[..., None]
color = plt.cm.inferno(0.08 + 0.9 * hours / hours.max())[..., :3] * shade
sea = height < lower[1] + 1e-3
color[sea] = color[sea] * 0.25 + np.array([0.62, 0.73, 0.80]) * 0.75
figure, axes = plt.subplots(figsize=(6.6, 5.6), dpi=100)
axes.imshow(color)
levels = np.linspace(0.25, height.max(), 12)
axes.contour(height, levels=levels, colors="white", linewidths=0.35, alpha=0.45)
scale = figure.colorbar(plt.cm.ScalarMappable(plt.Normalize(0, hours.max()), "inferno"), ax=axes, fraction=0.042, pad=0.02)
scale.set_label("hours of sun")
axes.axis("off")
figure.tight_layout(pad=0.5)
pictures.save(figure, options.output)
