#!/usr/bin/env python3
"""compare_mitsuba.py: how long do Boxwood and Mitsuba take to the same noise, and do their pictures agree?

    tools/compare_mitsuba.py build/release/boxwood kitchen/scene.pbrt [--variant llvm_ad_rgb] [--threads 2]
                             [--size 320x180] [--samples 64] [--reference 512] [--folder DIR]

Translates a pbrt scene for Mitsuba 3, as far as the public collection of such scenes needs it: meshes and spheres,
matte, substrate, metal, mirror, glass and uber (in version 4 diffuse, coateddiffuse, conductor and dielectric),
pictures as colors, and area lights. Renders it with both on the processor and compares time and noise as
measure_noise.py says. Both trace paths of up to 64 bounces through a box filter; Mitsuba's bounces but the first five
are ended by chance. Needs Mitsuba 3 (`pip install mitsuba`; tried with 3.9), and LLVM for its llvm variants (Debian:
apt-get install libllvm15).
"""

import itertools
import re
import time
from pathlib import Path

import numpy as np

from measure_noise import common_arguments, compare, render_boxwood

GREY = [0.18] * 3  # in place of pictures that are missing

# What version 4 calls otherwise.
MATERIALS = {"diffuse": "matte", "coateddiffuse": "substrate", "conductor": "metal", "dielectric": "glass"}
NUMBERS = {"glass": {"eta": "index"}, "matte": {"reflectance": "Kd"}, "substrate": {"reflectance": "Kd"}}


class Parameters(dict):
    """`"rgb Kd" [ 1 1 1 ]` and the like, by name: numbers as lists, names as text."""

    def __init__(self, tokens):
        words = iter(tokens)
        for word in words:
            kind, name = word[1:-1].split()
            first = next(words)
            listed = itertools.takewhile(lambda token: token != "]", words) if first == "[" else [first]
            values = [value.strip('"') if kind in ("string", "bool", "texture") else float(value) for value in listed]
            self[name] = values[0] if kind in ("string", "bool", "texture") else values


def directives(path):
    """Pairs of a directive and its tokens."""
    text = re.sub(r"#.*", "", path.read_text())
    name, rest = None, []
    for token in re.findall(r'"[^"]*"|[\[\]]|[^\s\[\]"]+', text):
        if re.fullmatch(r"[A-Z][A-Za-z]+", token):
            if name:
                yield name, rest
            name, rest = token, []
        else:
            rest.append(token)
    yield name, rest


class Translator:
    """From pbrt's directives to the dictionary that Mitsuba loads."""

    def __init__(self, mi, path, size, folder):
        """Meshes that the scene's file holds itself are written to `folder`."""
        self.mi, self.folder, self.size, self.own_folder = mi, path.parent, size, folder
        self.scene = {"type": "scene", "integrator": {"type": "path", "max_depth": 65}}
        self.pictures, self.materials = {}, {}
        self.material, self.light, self.saved, self.matrix, self.count = None, None, [], np.eye(4), 0
        for name, tokens in directives(path):
            getattr(self, name, self.unknown)(name, tokens)

    def unknown(self, name, tokens):
        if name not in ("Integrator", "Sampler", "PixelFilter", "Film", "WorldEnd"):
            print(f"left out: {name} {' '.join(tokens[:2])}")

    def Transform(self, name, tokens):
        self.matrix = np.array([float(t) for t in tokens if t not in "[]"]).reshape(4, 4).T

    def Camera(self, name, tokens):
        film = {"type": "hdrfilm", "width": self.size[0], "height": self.size[1], "rfilter": {"type": "box"}}
        # pbrt's camera has x to the right, Mitsuba's to the left.
        to_world = np.linalg.inv(self.matrix) @ np.diag([-1.0, 1, 1, 1])
        self.scene["camera"] = {
            "type": "perspective", "fov": Parameters(tokens[1:])["fov"][0], "fov_axis": "smaller",
            "to_world": self.mi.ScalarTransform4f(to_world), "film": film,
            "sampler": {"type": "independent", "sample_count": 1},
        }

    def WorldBegin(self, name, tokens):
        self.matrix = np.eye(4)

    def AttributeBegin(self, name, tokens):
        self.saved.append((self.material, self.light, self.matrix))

    def AttributeEnd(self, name, tokens):
        self.material, self.light, self.matrix = self.saved.pop()

    def Texture(self, name, tokens):
        path = self.folder / Parameters(tokens[3:])["filename"]
        self.pictures[tokens[0]] = {"type": "bitmap", "filename": str(path)} if path.is_file() else self.rgb(GREY)

    def MakeNamedMaterial(self, name, tokens):
        self.materials[tokens[0]] = self.bsdf(Parameters(tokens[1:]))

    def Material(self, name, tokens):
        self.material = self.bsdf(Parameters(['"string type"', *tokens]))

    def NamedMaterial(self, name, tokens):
        self.material = self.materials[tokens[0]]

    def AreaLightSource(self, name, tokens):
        self.light = {"type": "area", "radiance": self.rgb(Parameters(tokens[1:])["L"])}

    def Shape(self, name, tokens):
        given = Parameters(tokens[1:])
        if tokens[0] == '"sphere"':
            shape = {"type": "sphere", "radius": given["radius"][0]}
        else:
            path = self.folder / given["filename"] if tokens[0] == '"plymesh"' else self.write_mesh(given)
            shape = {"type": "ply", "filename": str(path), "flip_tex_coords": True}  # pbrt's pictures stand on v = 0
        shape["to_world"] = self.mi.ScalarTransform4f(self.matrix)
        shape["bsdf"] = self.material
        if self.light:
            shape["emitter"] = self.light
        self.scene[f"shape{self.count}"] = shape
        self.count += 1

    def write_mesh(self, given):
        points, triangles = np.reshape(given["P"], (-1, 3)), np.reshape(given["indices"], (-1, 3)).astype(int)
        path = self.own_folder / f"mesh{self.count}.ply"
        path.write_text(
            f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n"
            "property float x\nproperty float y\nproperty float z\n"
            f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
            + "".join("{} {} {}\n".format(*point) for point in points)
            + "".join("3 {} {} {}\n".format(*triangle) for triangle in triangles))
        return path

    @staticmethod
    def rgb(value):
        return {"type": "rgb", "value": list(value)}

    def color(self, given, name, other):
        value = given.get(name, other)
        return self.pictures[f'"{value}"'] if isinstance(value, str) else self.rgb(value)

    def bsdf(self, given):
        kind, width = given["type"], given.get("uroughness", [0])[0]
        kind = MATERIALS.get(kind, kind)
        given = {NUMBERS.get(kind, {}).get(name, name): value for name, value in given.items()}
        if width and given.get("remaproughness") != "false":
            raise SystemExit("a roughness that pbrt maps to a width: not translated")
        rough = {"distribution": "ggx", "alpha": width} if width else {}
        prefix = "rough" if width else ""
        if kind == "matte":
            return self.both_sides({"type": "diffuse", "reflectance": self.color(given, "Kd", [0.5] * 3)})
        if kind == "substrate":
            return self.both_sides({"type": prefix + "plastic", "int_ior": 1.5, "nonlinear": True, **rough,
                                    "diffuse_reflectance": self.color(given, "Kd", [0.5] * 3)})
        if kind == "metal":
            return self.both_sides({"type": prefix + "conductor", **rough, "eta": self.rgb(given["eta"]),
                                    "k": self.rgb(given["k"])})
        if kind == "mirror":
            return self.both_sides({"type": "conductor", "material": "none",
                                    "specular_reflectance": self.color(given, "Kr", [0.9] * 3)})
        if kind == "glass":
            return {"type": prefix + "dielectric", "int_ior": given.get("index", [1.5])[0], **rough,
                    "specular_transmittance": self.color(given, "Kt", [1] * 3)}
        if kind == "uber" and not any(given["Ks"]):
            below = self.both_sides({"type": "diffuse", "reflectance": self.color(given, "Kd", [0.25] * 3)})
            return {"type": "mask", "opacity": given["opacity"][0], "bsdf": below}
        raise SystemExit(f"material {kind}: not translated")

    @staticmethod
    def both_sides(bsdf):
        return {"type": "twosided", "bsdf": bsdf}


def main():
    parser = common_arguments(__doc__.splitlines()[0], "mitsuba-comparison", 64, 512)
    parser.add_argument("scene", type=Path)
    parser.add_argument("--variant", default="llvm_ad_rgb", help="of Mitsuba")
    parser.add_argument("--size", default="320x180")
    options = parser.parse_args()
    folder = Path(options.folder)
    folder.mkdir(parents=True, exist_ok=True)
    size = tuple(int(x) for x in options.size.split("x"))

    import mitsuba as mi  # here, so that --help works without

    mi.set_variant(options.variant)
    import drjit as dr

    dr.set_thread_count(options.threads)
    scene = mi.load_dict(Translator(mi, options.scene, size, folder).scene)

    def render_mitsuba(jobs):
        seconds = []
        for job in jobs:
            start = time.process_time()
            # Few at a time: the memory of the llvm variants grows with the samples.
            parts = [min(64, job.samples - i) for i in range(0, job.samples, 64)]
            first_seed = 1000 if job.is_reference else 0
            picture = sum(n * np.array(mi.render(scene, spp=n, seed=first_seed + i)) for i, n in enumerate(parts))
            seconds.append(time.process_time() - start)
            mi.Bitmap((picture / job.samples).astype(np.float32)).write(str(job.file))
        return seconds

    compare(options.boxwood, [
        ("Boxwood", lambda jobs: render_boxwood(options.boxwood, options.scene, options.threads, size, jobs)),
        ("Mitsuba", render_mitsuba),
    ], options.samples, options.reference, folder)


if __name__ == "__main__":
    main()
