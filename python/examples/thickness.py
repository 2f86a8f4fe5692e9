"""How thick is a part, along every ray of an X-ray picture?

All hits of a ray through a closed mesh come in pairs: it enters, and it leaves. The sum of the lengths in between is the
thickness that an X-ray sees.
"""

import time

import numpy as np

import boxwood as bw
import pictures
from pictures import plt

options = pictures.arguments(__doc__, width=560)


def turned(profile, segments):
    """The closed mesh of a profile (radius, height) that is turned about the y axis."""
    angle = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    radius, height = np.transpose(profile)
    vertices = np.stack(np.broadcast_arrays(radius[:, None] * np.cos(angle), height[:, None], radius[:, None] * np.sin(angle)), -1)
    i, j = np.meshgrid(np.arange(len(profile)), np.arange(segments), indexing="ij")
    a, b = i * segments + j, (i + 1) % len(profile) * segments + j
    c, d = (i + 1) % len(profile) * segments + (j + 1) % segments, i * segments + (j + 1) % segments
    return vertices.reshape(-1, 3), np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


# A pulley: hub, web and grooved rim.
profile = [(8, -14), (14, -14), (14, -5), (38, -3), (40, -12), (50, -12), (50, -9), (45, -4), (45, 4), (50, 9), (50, 12),
           (40, 12), (38, 3), (14, 5), (14, 14), (8, 14)]
desc = bw.SceneDesc()
pulley = desc.add_mesh(*turned(profile, 256), name="pulley")
ball = desc.add_mesh(*turned([(0.001 + 4 * np.sin(a), -4 * np.cos(a)) for a in np.linspace(0, np.pi, 40)], 64), name="ball")
tilt = np.radians(58)
turn = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
pose = np.eye(4)
pose[:3, :3] = turn
desc.add_instance(pulley, pose)
for angle in np.arange(8) * np.pi / 4:  # eight balls lie on its web
    pose = np.eye(4)
    pose[:3, :3] = turn
    pose[:3, 3] = turn @ [26 * np.cos(angle), 8.5, 26 * np.sin(angle)]
    desc.add_instance(ball, pose)
scene = bw.Scene(desc)

# Parallel rays, one for each pixel.
extent = 56.0
width, height = options.width, options.width * 7 // 8
x, y = np.meshgrid(np.linspace(-extent, extent, width), np.linspace(extent * 7 / 8, -extent * 7 / 8, height))
origins = np.stack([x, y, np.full_like(x, 100)], axis=-1)
start = time.perf_counter()
hits = scene.all_hits(origins, [0, 0, -1])
seconds = time.perf_counter() - start

# Leaving counts plus, entering minus; the sign is that of the normal along the ray.
leaves = np.sign(hits.normal @ np.array([0, 0, -1.0]))
ray = np.repeat(np.arange(width * height), np.diff(hits.offsets))
thickness = np.bincount(ray, weights=leaves * hits.t, minlength=width * height).reshape(height, width)
print(f"{origins.size // 3:,} rays and {len(hits):,} crossings in {seconds:.2f} s; at most {thickness.max():.1f} mm")

figure, fields = plt.subplots(1, 2, figsize=(9.6, 4.0), dpi=100)
bounds = (-extent, extent, -extent * 7 / 8, extent * 7 / 8)
fields[0].imshow(np.exp(-thickness / 18), cmap="bone", extent=bounds, vmin=0, vmax=1)
fields[0].set_title("X-ray")
image = fields[1].imshow(np.where(thickness > 0, thickness, np.nan), cmap="viridis", extent=bounds)
fields[1].set_title("thickness")
figure.colorbar(image, ax=fields[1], fraction=0.04, pad=0.02, label="mm")
for field in fields:
    field.axis("off")
figure.tight_layout(pad=0.6)
pictures.save(figure, options.output)
