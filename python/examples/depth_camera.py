"""How far away is what a camera sees, and how does it lie?

One ray through each pixel gives what a depth camera gives: the distance along its axis, and with it the normals and which
thing each pixel shows.
"""

import time

import numpy as np

import boxwood as bw
import pictures
from pictures import plt

options = pictures.arguments(__doc__, width=640)
width, height = options.width, options.width * 3 // 4

scene = bw.load("stilllife")
origin, directions = pictures.camera_rays(scene.camera, width, height)
start = time.perf_counter()
hits = scene.closest_hit(origin, directions)
seconds = time.perf_counter() - start
print(f"{hits.t.size:,} rays in {seconds * 1000:.0f} ms")

# t counts along a unit direction; a depth camera counts along its axis.
axis = -scene.camera.world_from_camera[:3, 2]
depth = np.where(np.isfinite(hits.t), hits.t * (directions @ axis), np.nan)

figure, fields = plt.subplots(1, 3, figsize=(10.8, 2.98), dpi=100)
image = fields[0].imshow(depth, cmap="magma_r", vmin=np.nanmin(depth), vmax=np.nanpercentile(depth, 92))
scale = figure.colorbar(image, cax=fields[0].inset_axes((0.04, 0.88, 0.36, 0.05)), orientation="horizontal")
scale.ax.tick_params(colors="white", labelsize=7)
scale.outline.set_edgecolor("white")
fields[1].imshow(np.nan_to_num(hits.normal * 0.5 + 0.5, nan=1))
colors = np.random.default_rng(5).permutation(plt.cm.tab20.colors, axis=0)
fields[2].imshow(np.where(hits.geometry_id[..., None] >= 0, colors[hits.geometry_id % 20], 1))
for field, title in zip(fields, ("depth", "normals", "what it is")):
    field.set_title(title, pad=3)
    field.axis("off")
figure.tight_layout(pad=0.6)
pictures.save(figure, options.output)
