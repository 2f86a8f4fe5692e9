"""pictures.py: what do the examples share? A command line, a camera, and how a picture is saved."""

import argparse
import io
import pathlib

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

INK = "#2b2b2b"
plt.rcParams.update({"font.family": "DejaVu Sans", "font.size": 9, "text.color": INK, "axes.labelcolor": INK,
                     "axes.edgecolor": "#888888", "xtick.color": "#555555", "ytick.color": "#555555"})


def arguments(description, **sizes):
    """The command line of an example: where the picture goes, and how much is asked."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="the picture: .png or .jpg")
    for name, value in sizes.items():
        parser.add_argument(f"--{name}", type=int, default=value, help=f"[{value}]")
    return parser.parse_args()


def camera_rays(camera, width, height):
    """One origin (3,) and directions (height, width, 3) of unit length: a ray through the middle of each pixel."""
    m = camera.world_from_camera
    half = np.tan(np.radians(camera.fov_deg) / 2)
    x = (np.arange(width) + 0.5 - width / 2) * 2 * half / min(width, height)
    y = (height / 2 - np.arange(height) - 0.5) * 2 * half / min(width, height)
    directions = np.stack(np.broadcast_arrays(x[None, :], y[:, None], -1.0), axis=-1) @ m[:3, :3].T
    return m[:3, 3], directions / np.linalg.norm(directions, axis=-1, keepdims=True)


def save(figure, path):
    """Writes the figure; a .jpg comes out small."""
    buffer = io.BytesIO()
    kind = "jpg" if path.suffix in (".jpg", ".jpeg") else "png"
    figure.savefig(buffer, format=kind, dpi=figure.dpi, pil_kwargs={"quality": 85} if kind == "jpg" else None)
    path.write_bytes(buffer.getvalue())
    plt.close(figure)
