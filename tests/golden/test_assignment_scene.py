# SPDX-License-Identifier: GPL-3.0-or-later
"""The assignment's scene against its closed form, computed here from the geometry.

L = albedo/pi * cos(theta) * flux/(4 pi r^2) at what a camera ray meets, directly or refracted once through the disc
(sin t = sin i / eta); black where anything stands between the point and the light. A pixel is the mean of that over its
square. All pixels of the picture are compared but those that hold an edge: the outline of a surface, a fold, the border
of a shadow. Everything in double precision, with brute-force intersection, sharing no code with the renderer but the
reading of the file.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import basicrt

ROOT = Path(__file__).resolve().parents[2]
SCENES = {
    "ours": ROOT / "scenes/cbox_no_light_refract/scene.json",
    "the assignment's": ROOT / "../shared/seed/cbox_no_light_refract.json",
}
TOLERANCE = 0.005
EDGE_PLACES = 16  # along each side of a pixel, at which an edge is looked for


@dataclass
class Triangles:
    """All triangles of a scene, in world space."""

    p0: np.ndarray  # (T, 3)
    e1: np.ndarray
    e2: np.ndarray
    normal: np.ndarray  # (T, 3) unit length
    plane: np.ndarray  # (T,) which plane each lies in
    albedo: np.ndarray  # (T, 3)
    eta: np.ndarray  # (T,) NaN for a diffuse one


def color_of(scene: basicrt.Scene, color: object) -> tuple[float, ...]:
    if isinstance(color, basicrt.TextureRef):
        texture = scene.textures[color.index]
        assert isinstance(texture, basicrt.ConstantTexture)
        return texture.color
    assert isinstance(color, tuple)
    return color


def gather(scene: basicrt.Scene) -> Triangles:
    corners, albedos, etas = [], [], []
    for instance in scene.instances:
        assert instance.shape is not None
        mesh = scene.shapes[instance.shape]
        assert isinstance(mesh, basicrt.Mesh)
        matrix = instance.transform.astype(float)
        positions = mesh.positions @ matrix[:3, :3].T + matrix[:3, 3]
        corners.append(positions[mesh.triangles])
        assert instance.materials[0] is not None
        (node,) = scene.materials[instance.materials[0]].nodes
        is_disc = isinstance(node, basicrt.RefractionShader)
        albedo = (0, 0, 0) if is_disc else color_of(scene, node.color)
        albedos += [albedo] * len(mesh.triangles)
        etas += [node.eta if is_disc else np.nan] * len(mesh.triangles)
    p = np.concatenate(corners)
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    normal = np.cross(e1, e2)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    equations = np.column_stack([normal, np.sum(normal * p[:, 0], axis=1)])
    _, plane = np.unique(np.round(equations, 4) + 0.0, axis=0, return_inverse=True)
    return Triangles(p[:, 0], e1, e2, normal, plane.ravel(), np.array(albedos), np.array(etas))


def nearest(
    triangles: Triangles, origin: np.ndarray, direction: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The first hit of each ray, (N,) triangle or -1 and (N,) distance: every ray against every plane."""
    # A point p of the plane has the barycentric coordinates (p - p0) . a and (p - p0) . b.
    n = np.cross(triangles.e1, triangles.e2)
    square = np.sum(n * n, axis=1, keepdims=True)
    axes = [n, np.cross(triangles.e2, n) / square, np.cross(n, triangles.e1) / square]
    offsets = [np.sum(axis * triangles.p0, axis=1) for axis in axes]
    hits, distances = [], []
    for rays in np.array_split(np.arange(len(origin)), len(origin) // 10000 + 1):
        o, d = origin[rays], direction[rays]
        at_start = [o @ axis.T - offset for axis, offset in zip(axes, offsets, strict=True)]
        per_length = [d @ axis.T for axis in axes]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = -at_start[0] / per_length[0]
            u, v = (at_start[i] + t * per_length[i] for i in (1, 2))
            t[~((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 1e-7))] = np.inf
        hit = np.argmin(t, axis=1)
        distance = t[np.arange(len(rays)), hit]
        hits.append(np.where(np.isfinite(distance), hit, -1))
        distances.append(distance)
    return np.concatenate(hits), np.concatenate(distances)


def camera_rays(
    scene: basicrt.Scene, x: np.ndarray, y: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Rays through places on the film in pixels, (0, 0) its lower left corner."""
    camera = scene.camera
    assert isinstance(camera, basicrt.PerspectiveCamera)
    (left, bottom), (right, top) = camera.window_min, camera.window_max
    local = np.stack(
        [
            left + (right - left) * x / scene.settings.width,
            bottom + (top - bottom) * y / scene.settings.height,
            np.full_like(x, -1),
        ],
        axis=1,
    )
    matrix = camera.transform.astype(float)
    direction = local @ matrix[:3, :3].T
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return np.broadcast_to(matrix[:3, 3], direction.shape), direction


@dataclass
class Seen:
    """What rays see: the closed form, and what tells smooth neighbourhoods from edges."""

    radiance: np.ndarray  # (N, 3)
    kind: np.ndarray  # (N,) the same for the same plane, route and visibility; -1 for nothing
    is_lit: np.ndarray  # (N,)
    is_refracted: np.ndarray  # (N,)


def look(scene: basicrt.Scene, triangles: Triangles, x: np.ndarray, y: np.ndarray) -> Seen:
    origin, direction = camera_rays(scene, x, y)
    hit, distance = nearest(triangles, origin, direction)

    # Through the disc: refracted where the ray enters, that is, comes from the side of the normal.
    is_refracted = (hit >= 0) & ~np.isnan(triangles.eta[hit])
    through = np.flatnonzero(is_refracted)
    normal, eta = triangles.normal[hit[through]], triangles.eta[hit[through]][:, None]
    cos_i = -np.sum(direction[through] * normal, axis=1, keepdims=True)
    assert (cos_i > 0).all()
    cos_t = np.sqrt(1 - (1 - cos_i**2) / eta**2)
    origin, direction = origin.copy(), direction.copy()
    origin[through] += distance[through, None] * direction[through]
    direction[through] = direction[through] / eta + (cos_i / eta - cos_t) * normal
    hit[through], distance[through] = nearest(triangles, origin[through], direction[through])
    assert np.isnan(triangles.eta[hit]).all()

    # One point light, with a shadow ray from the light to just short of the point.
    point = origin + np.where(hit >= 0, distance, 0)[:, None] * direction
    light = np.array(scene.settings.point_light_position, dtype=float)
    to_light = light - point
    r = np.linalg.norm(to_light, axis=1)
    normal = triangles.normal[hit]
    cosine = np.sum(normal * to_light, axis=1) / r
    faces_camera = np.sum(normal * direction, axis=1) < 0
    _, clear = nearest(triangles, np.broadcast_to(light, point.shape), -to_light / r[:, None])
    is_lit = (hit >= 0) & faces_camera & (cosine > 0) & (clear > r - 1e-4)
    flux = np.array(scene.settings.point_light_flux, dtype=float)
    irradiance = (cosine / (4 * np.pi * r**2))[:, None] * flux
    radiance = np.where(is_lit[:, None], triangles.albedo[hit] / np.pi * irradiance, 0)
    kind = np.where(hit >= 0, 4 * triangles.plane[hit] + 2 * is_refracted + is_lit, -1)
    return Seen(radiance, kind, is_lit, is_refracted)


def places(pixels: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """(2, N * O) x and y on the film of the places at offsets (O, 2) from each pixel's lower left corner."""
    return (pixels[:, None, :] + offsets).reshape(-1, 2).T


def pixels_without_edges(scene: basicrt.Scene, triangles: Triangles) -> np.ndarray:
    """(N, 2) pixels all over which rays see the same plane by the same route, all of it lit or all in shadow."""
    width, height = scene.settings.width, scene.settings.height
    y, x = np.mgrid[0 : height + 1, 0 : width + 1].astype(float)
    corners = look(scene, triangles, x.ravel(), y.ravel()).kind.reshape(y.shape)
    # Where the corners of a pixel and of its neighbours are all alike there is no edge: none is that small.
    padded = np.pad(corners, 1, mode="edge")
    around = np.stack([padded[j : j + height, i : i + width] for j in range(4) for i in range(4)])
    is_calm = (around == around[0]).all(axis=0)
    # Elsewhere an edge in the pixel crosses its border.
    pixels = np.argwhere(~is_calm)[:, ::-1]
    along = np.linspace(0, 1, EDGE_PLACES)
    sides = [np.stack(np.broadcast_arrays(along, end), axis=1) for end in (0.0, 1.0)]
    border = np.concatenate([*sides, *(side[:, ::-1] for side in sides)])
    kinds = look(scene, triangles, *places(pixels, border)).kind.reshape(len(pixels), -1)
    near_edges = pixels[(kinds == kinds[:, :1]).all(axis=1)]
    pixels = np.concatenate([np.argwhere(is_calm)[:, ::-1], near_edges])
    return pixels[corners[pixels[:, 1], pixels[:, 0]] >= 0]


@pytest.fixture(scope="module", params=SCENES)
def scene(request) -> basicrt.Scene:
    path = SCENES[request.param]
    if not path.exists():
        pytest.skip(f"{path.name} of {request.param} is not here")
    return basicrt.load_scene(path)


@pytest.fixture(scope="module")
def comparison(scene: basicrt.Scene) -> dict[str, np.ndarray]:
    """For all pixels without an edge: the rendered and the expected radiance, and what they see."""
    settings = scene.settings
    assert (settings.integrator, settings.samples) == ("intersection_test", 32)
    assert (settings.width, settings.height) == (512, 512)
    triangles = gather(scene)
    pixels = pixels_without_edges(scene, triangles)
    # Gauss's rule with two points along each axis: exact for cubics.
    low, high = 0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3)
    gauss = np.array([[low, low], [high, low], [low, high], [high, high]])
    seen = look(scene, triangles, *places(pixels, gauss))
    picture = basicrt.render(scene)["Combined"]
    return {
        "rendered": picture[pixels[:, 1], pixels[:, 0], :3].astype(float),
        "expected": seen.radiance.reshape(len(pixels), 4, 3).mean(axis=1),
        "is_lit": seen.is_lit.reshape(len(pixels), 4)[:, 0],
        "is_refracted": seen.is_refracted.reshape(len(pixels), 4)[:, 0],
    }


def test_hardly_a_pixel_is_left_out(scene: basicrt.Scene, comparison) -> None:
    share = len(comparison["rendered"]) / (scene.settings.width * scene.settings.height)
    print(f"{share:.1%} of all pixels")
    assert share > 0.9


@pytest.mark.parametrize("is_refracted", [False, True], ids=["directly", "through the disc"])
def test_lit_pixels_agree_with_the_closed_form(comparison, is_refracted: bool) -> None:
    chosen = comparison["is_lit"] & (comparison["is_refracted"] == is_refracted)
    rendered, expected = comparison["rendered"][chosen], comparison["expected"][chosen]
    error = np.abs(rendered / expected - 1)
    of_sum = np.abs(rendered.sum(axis=0) / expected.sum(axis=0) - 1)
    print(
        f"{len(error)} pixels: mean error {error.mean():.2e}, largest {error.max():.2e}, "
        f"of the sum {of_sum.max():.2e}"
    )
    assert len(error) > (20000 if is_refracted else 100000)
    assert error.max() < TOLERANCE
    # Without the noise: the picture as a whole is right to a hundredth of the tolerance.
    assert of_sum.max() < TOLERANCE / 100


@pytest.mark.parametrize("is_refracted", [False, True], ids=["directly", "through the disc"])
def test_pixels_in_shadow_are_black(comparison, is_refracted: bool) -> None:
    chosen = ~comparison["is_lit"] & (comparison["is_refracted"] == is_refracted)
    print(f"{chosen.sum()} pixels")
    assert chosen.sum() >= (50 if is_refracted else 5000)
    assert not comparison["rendered"][chosen].any()
