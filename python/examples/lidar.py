"""What does a scanner that turns see of a city?

Sixty-four beams at fixed angles turn once around at each of a few stations along a street. What comes back is a point cloud,
colored by height; the rings on the ground are where the lower beams meet it.
"""

import time

import numpy as np

import boxwood as bw
import pictures
from pictures import plt

options = pictures.arguments(__doc__, beams=64, steps=1800)

scene = bw.load("city:1200")
elevation = np.radians(np.linspace(-24, 14, options.beams))
azimuth = np.linspace(0, 2 * np.pi, options.steps, endpoint=False)
directions = np.stack(np.broadcast_arrays(np.cos(elevation)[:, None] * np.cos(azimuth), np.sin(elevation)[:, None],
                                          np.cos(elevation)[:, None] * np.sin(azimuth)), axis=-1)

# Stations that stand in the open: nothing above them.
rng = np.random.default_rng(8)
spots = rng.uniform(-22, 22, (400, 3)) * [1, 0, 1] + [0, 1.2, 0]
stations = spots[~scene.any_hit(spots, [0, 1, 0]) & (scene.closest_point(spots).distance > 0.45)][:5]

start = time.perf_counter()
hits = scene.closest_hit(stations[:, None, None], directions, t_max=60)
seconds = time.perf_counter() - start
points = hits.position[hits.primitive_id >= 0]
points += rng.normal(0, 0.01, points.shape)
print(f"{hits.t.size:,} rays in {seconds:.2f} s, {len(points):,} points")

# Look at the cloud from above and aside: nearest points last.
eye = np.array([[0.80, 0.0, -0.60], [-0.36, 0.80, -0.48], [0.48, 0.60, 0.64]])
x, y, depth = eye @ points.T
order = np.argsort(depth)
figure = plt.figure(figsize=(9, 5.2), dpi=110, facecolor="#0c1220")
axes = figure.add_axes((0, 0, 1, 1))
axes.scatter(x[order], y[order], c=points[order, 1], s=0.35, cmap="turbo", vmin=-0.5, vmax=6, linewidths=0)
sx, sy, _ = eye @ stations.T
axes.scatter(sx, sy, s=28, facecolor="white", edgecolor="#0c1220", zorder=3)
axes.set(aspect="equal", xlim=(-30, 30), ylim=(-17, 17.6))
axes.axis("off")
pictures.save(figure, options.output)
