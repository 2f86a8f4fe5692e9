"""Rays for trimesh: a class that stands where a mesh's own `ray` stands.

    mesh.ray = boxwood.trimesh.RayMeshIntersector(mesh)    # one mesh
    boxwood.trimesh.use_everywhere()                       # every mesh that is made from now on

The answers have the arrays and dtypes that trimesh documents, ordered by ray and along each ray. A crossing of an edge or a
vertex is one hit, not one for each triangle that meets there.
"""

import numpy as np
import numpy.typing as npt
import trimesh as _trimesh

from ._core import Scene

_Array = npt.NDArray[np.float64]
_Indices = npt.NDArray[np.int64]

# Directions that are parallel to nothing that people model.
_PROBES = np.array([[0.4395, 0.6176, 0.6522], [-0.7211, 0.3127, 0.6182], [0.2764, -0.8507, 0.4472]])


class RayMeshIntersector:
    """Answers rays for a `trimesh.Trimesh`; builds its trees at the first question, and again after the mesh has changed.

    threads: 0 means all. `scale_to_box` is accepted for the sake of trimesh and has no effect.
    """

    def __init__(self, geometry: "_trimesh.Trimesh", scale_to_box: bool = True, *, threads: int = 0) -> None:
        self.mesh = geometry
        self.threads = threads
        self._scale_to_box = scale_to_box
        self._built: "tuple[int, Scene, _Array, float] | None" = None

    def intersects_location(
        self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike, multiple_hits: bool = True, **kwargs: int
    ) -> tuple[_Array, _Indices, _Indices]:
        """Where rays hit: locations (h, 3), index_ray (h,), index_tri (h,)."""
        origins, directions, index_tri, index_ray, uv = self._find(ray_origins, ray_directions, multiple_hits, **kwargs)
        return self._locations(origins[index_ray], directions[index_ray], index_tri, uv), index_ray, index_tri

    def intersects_id(
        self,
        ray_origins: npt.ArrayLike,
        ray_directions: npt.ArrayLike,
        multiple_hits: bool = True,
        max_hits: "int | None" = None,
        return_locations: bool = False,
    ) -> "tuple[_Indices, _Indices] | tuple[_Indices, _Indices, _Array]":
        """Which triangles rays hit: index_tri (h,), index_ray (h,), and locations (h, 3) when they are asked for.

        multiple_hits: every hit of a ray, or the first alone. max_hits: at most so many of each ray; None means all.
        """
        origins, directions, index_tri, index_ray, uv = self._find(ray_origins, ray_directions, multiple_hits, max_hits)
        if not return_locations:
            return index_tri, index_ray
        return index_tri, index_ray, self._locations(origins[index_ray], directions[index_ray], index_tri, uv)

    def intersects_first(self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike) -> _Indices:
        """The first triangle that each ray hits, (m,); -1 for none."""
        origins, directions = self._rays(ray_origins, ray_directions)
        scene, local = self._scene(origins)
        return self._closest(scene, local, directions)[0]

    def intersects_any(self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Whether each ray hits anything, (m,)."""
        origins, directions = self._rays(ray_origins, ray_directions)
        scene, local = self._scene(origins)
        is_hit = scene.any_hit(local, directions, threads=self.threads)
        is_hit[self._graze(scene, local, directions, ~is_hit)[0]] = True
        return is_hit

    def contains_points(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Whether the mesh contains each point, (n,): whether a ray from there leaves it once more than it enters.

        Of a closed mesh every ray tells the same. Of an open one, whose rays may differ, six rays vote, and a point from
        which one of them escapes without any hit is outside.
        """
        points = np.asarray(points, np.float64)
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError(f"points: got shape {points.shape}, expected (n, 3)")
        scene, local = self._scene(points)
        contained = np.zeros(len(points), bool)

        # Most points are settled by one line through them, and those beyond the bounds by none.
        bounds = scene.bounds
        undecided = np.flatnonzero(((local >= bounds[0]) & (local <= bounds[1])).all(axis=1))
        counts = self._counts(scene, local[undecided], _PROBES[:1])
        odd = counts % 2 == 1
        agree = odd[0] == odd[1]
        contained[undecided[agree]] = odd[0][agree]
        undecided = undecided[~agree]
        counts = self._counts(scene, local[undecided], _PROBES)
        contained[undecided] = (np.sum(counts % 2 == 1, axis=0) > 3) & (counts > 0).all(axis=0)
        return contained

    def _find(
        self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike, multiple_hits: bool, max_hits: "int | None" = None
    ) -> "tuple[_Array, _Array, _Indices, _Indices, npt.NDArray[np.float32]]":
        """The rays as arrays; and of each hit its triangle, its ray, and where on the triangle it is."""
        origins, directions = self._rays(ray_origins, ray_directions)
        scene, local = self._scene(origins)
        if multiple_hits:
            found = scene.all_hits(local, directions, threads=self.threads)
            rows, moved = self._graze(scene, local, directions, np.diff(found.offsets) == 0)
            if len(rows):
                local[rows] = moved
                found = scene.all_hits(local, directions, threads=self.threads)
            counts = np.diff(found.offsets)
            index_ray = np.repeat(np.arange(len(counts)), counts)
            index_tri, uv = found.primitive_id.astype(np.int64), found.uv
            if max_hits is not None and len(counts) and counts.max() > max_hits:
                kept = np.arange(len(index_ray)) - found.offsets[index_ray] < max_hits
                index_ray, index_tri, uv = index_ray[kept], index_tri[kept], uv[kept]
        else:
            first, first_uv = self._closest(scene, local, directions)
            index_ray = np.flatnonzero(first >= 0)
            index_tri, uv = first[index_ray], first_uv[index_ray]
        return origins, directions, index_tri, index_ray.astype(np.int64), uv

    def _closest(self, scene: Scene, local: _Array, directions: _Array) -> "tuple[_Indices, npt.NDArray[np.float32]]":
        """The first triangle of each ray, (m,), and where on it, (m, 2)."""
        hits = scene.closest_hit(local, directions, threads=self.threads)
        first, uv = hits.primitive_id.astype(np.int64), hits.uv
        rows, moved = self._graze(scene, local, directions, first < 0)
        if len(rows):
            again = scene.closest_hit(moved, directions[rows], threads=self.threads)
            first[rows], uv[rows] = again.primitive_id, again.uv
        return first, uv

    def _graze(self, scene: Scene, local: _Array, directions: _Array, missed: npt.NDArray[np.bool_]) -> "tuple[_Indices, _Array]":
        """The rows of missed rays that graze the mesh, and origins from which they hit it.

        A scene counts a ray along an outline edge as inside of it or outside, by a rule that makes neighbours agree. trimesh
        counts it as a hit. So a ray that missed is tried again, a millionth of the mesh to each of four sides.
        """
        rows = np.flatnonzero(missed & np.isfinite(directions).all(axis=1))
        d = directions[rows]
        # Two directions across the ray.
        axis = np.eye(3)[np.argmin(np.abs(d), axis=1)] if len(rows) else np.zeros((0, 3))
        u = np.cross(d, axis)
        u /= np.linalg.norm(u, axis=1, keepdims=True)
        v = np.cross(d, u)
        sides = np.stack([u + 0.6 * v, v - 0.6 * u, -u - 0.6 * v, 0.6 * u - v])
        moved = local[rows] + 2.0**-20 * sides
        is_hit = scene.any_hit(moved, d, threads=self.threads)
        grazes = is_hit.any(axis=0)
        return rows[grazes], moved[np.argmax(is_hit, axis=0), np.arange(len(rows))][grazes]

    def _counts(self, scene: Scene, points: _Array, probes: _Array) -> _Indices:
        """Hits along each probe and against it, (2 * probes, points)."""
        directions = np.concatenate([probes, -probes])[:, None]
        return scene.count_hits(points[None], directions, threads=self.threads)

    @staticmethod
    def _rays(ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike) -> "tuple[_Array, _Array]":
        origins, directions = np.asarray(ray_origins, np.float64), np.asarray(ray_directions, np.float64)
        if origins.shape != directions.shape or origins.ndim != 2 or origins.shape[1] != 3:
            raise ValueError(
                f"ray_origins and ray_directions: got shapes {origins.shape} and {directions.shape}, expected (m, 3) for both"
            )
        with np.errstate(divide="ignore", invalid="ignore"):  # without a direction there is no ray, and it misses
            directions = directions / np.abs(directions).max(axis=1, keepdims=True)  # the squares of 1e300 are too large
            return origins, directions / np.linalg.norm(directions, axis=1, keepdims=True)

    def _scene(self, origins: _Array) -> "tuple[Scene, _Array]":
        """The scene, and `origins` as it sees them.

        trimesh counts in doubles, a scene in floats: the mesh is moved to the middle of its box and scaled to about 1, so
        that what is small, or far from the origin, keeps its digits.
        """
        key = hash(self.mesh)
        if self._built is None or self._built[0] != key:
            vertices = np.asarray(self.mesh.vertices, np.float64)
            center, size = np.zeros(3), 1.0
            finite = vertices[np.isfinite(vertices).all(axis=1)] if len(vertices) else vertices
            if len(finite):
                lower, upper = finite.min(axis=0), finite.max(axis=0)
                center = (lower + upper) / 2
                size = float(np.max(upper - lower)) or 1.0
            scale = float(2.0 ** -np.floor(np.log2(size)))  # a power of two moves no digit
            faces = np.asarray(self.mesh.faces).reshape(-1, 3)
            scene = Scene.from_mesh((vertices.reshape(-1, 3) - center) * scale, faces.astype(np.int64), threads=self.threads)
            self._built = key, scene, center, scale
        _, scene, center, scale = self._built
        return scene, (origins - center) * scale

    def _locations(self, origins: _Array, directions: _Array, index_tri: _Indices, uv: npt.NDArray[np.float32]) -> _Array:
        """Where the rays meet the planes of their triangles, in double; along a plane, by the barycentric coordinates."""
        corners = np.asarray(self.mesh.triangles, np.float64)[index_tri]
        a, ab, ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        normals = np.cross(ab, ac)
        slope = np.einsum("ij,ij->i", normals, directions)
        on_triangle = a + ab * uv[:, :1] + ac * uv[:, 1:]
        steep = np.abs(slope) > 1e-3 * np.linalg.norm(normals, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            t = np.einsum("ij,ij->i", normals, a - origins) / slope
            return np.where(steep[:, None], origins + directions * t[:, None], on_triangle)

    def __getstate__(self) -> "dict[str, object]":
        return {**self.__dict__, "_built": None}

    def __copy__(self) -> "RayMeshIntersector":
        return RayMeshIntersector(self.mesh, self._scale_to_box, threads=self.threads)

    def __deepcopy__(self, memo: object) -> "RayMeshIntersector":
        return self.__copy__()


def use_everywhere() -> None:
    """Makes every `trimesh.Trimesh` from now on answer its rays by boxwood."""
    import trimesh.ray.ray_triangle as ray_triangle

    ray_triangle.RayMeshIntersector = RayMeshIntersector
    if _trimesh.ray.has_embree:
        import trimesh.ray.ray_pyembree as ray_pyembree

        ray_pyembree.RayMeshIntersector = RayMeshIntersector
