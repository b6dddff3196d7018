# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole renders of scenes whose pictures are known: white furnaces, and a floor under each kind of light."""

from __future__ import annotations

import math

import numpy as np
import pytest

import basicrt
from support.scenes import add, aim, quad

ALBEDO = np.array([0.8, 0.5, 0.2])


def mean_and_error(scene: basicrt.Scene) -> tuple[np.ndarray, np.ndarray]:
    """The mean color of a picture, and the standard error of that mean by its pixels' spread."""
    pixels = basicrt.render(scene)["Combined"][..., :3].reshape(-1, 3).astype(float)
    assert np.isfinite(pixels).all()
    return pixels.mean(axis=0), pixels.std(axis=0) / math.sqrt(len(pixels))


def expect(scene: basicrt.Scene, expected: object, relative: float = 1e-3) -> None:
    """The picture has this color all over, within five standard errors and a little."""
    mean, error = mean_and_error(scene)
    expected = np.broadcast_to(np.asarray(expected, dtype=float), 3)
    print(f"mean {mean}, expected {expected}, standard error {error}")
    # A picture this noisy would agree with anything.
    assert (error <= 0.01 * np.maximum(expected, 1e-6)).all()
    assert (np.abs(mean - expected) <= 5 * error + relative * expected).all()


SURFACES = {
    "diffuse": (basicrt.DiffuseShader((1, 1, 1)), 1.0),
    "grey diffuse": (basicrt.DiffuseShader((0.5, 0.5, 0.5)), 0.5),
    "mirror": (basicrt.GlossyShader((1, 1, 1), 0), 1.0),
    "glass": (basicrt.GlassShader(eta=1.5), 1.0),
    "thin glass": (basicrt.GlassShader(eta=1.0), 1.0),
    "refraction": (basicrt.RefractionShader(eta=1.5), 1.0),
    "transparent": (basicrt.TransparentShader((1, 1, 1)), 1.0),
    "emission": (basicrt.EmissionShader((0.25, 0.25, 0.25)), 0.25),
}


@pytest.mark.parametrize("name", SURFACES)
def test_a_sphere_in_a_white_furnace(name: str) -> None:
    """A sphere that absorbs nothing can not be told from a sky that is the same everywhere."""
    surface, share = SURFACES[name]
    scene = basicrt.Scene()
    add(scene, basicrt.Sphere(), surface)
    sky = 1.0 if name == "emission" else 0.7
    scene.environment.radiance = (sky, sky, sky)
    aim(scene, (0, -4, 0), (0, 0, 0), math.radians(10), size=(32, 32), samples=64)
    settings = scene.settings
    settings.max_bounces = settings.diffuse_bounces = settings.glossy_bounces = 256
    settings.transmission_bounces = settings.transparent_bounces = 256
    expect(scene, share * sky, relative=1e-4)


def floor(samples: int = 256) -> basicrt.Scene:
    """A floor of which a tiny piece around the origin is seen, from aside."""
    scene = basicrt.Scene()
    add(scene, quad(4), basicrt.DiffuseShader(ALBEDO))
    aim(scene, (0, -6, 3), (0, 0, 0), math.radians(0.2), size=(16, 16), samples=samples)
    scene.settings.max_bounces = 0
    return scene


def place(height: float, scale: tuple[float, float] = (1, 1), tilt: float = 0) -> np.ndarray:
    """To the point of this height over the origin, turned about the y axis by `tilt` around the origin."""
    c, s = math.cos(tilt), math.sin(tilt)
    turn = np.array([[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1]])
    lift = np.eye(4)
    lift[2, 3] = height
    return turn @ lift @ np.diag([scale[0], scale[1], 1, 1])


def under_rectangle(width: float, length: float, height: float) -> float:
    """Irradiance over radiance under the middle of a rectangle: four times that under a corner (Howell, C-11)."""
    a, b = width / 2 / height, length / 2 / height
    corner = a / math.hypot(1, a) * math.atan(b / math.hypot(1, a))
    corner += b / math.hypot(1, b) * math.atan(a / math.hypot(1, b))
    return 4 * corner / 2


@pytest.mark.parametrize("tilt", [0, 1])
@pytest.mark.parametrize("radius", [0, 0.3])
def test_a_floor_under_a_point_light(radius: float, tilt: float) -> None:
    """A sphere lights like a point as long as all of it is above the horizon."""
    scene = floor()
    position = place(2, tilt=tilt)[:3, 3]
    scene.lights.append(basicrt.PointLight(position, (3, 2, 1), radius))
    expect(scene, ALBEDO / math.pi * np.array([3, 2, 1]) * math.cos(tilt) / 4)


def test_a_floor_under_a_soft_point_light() -> None:
    """A disc of the sphere's radius that faces the floor: sin^2 of the angle that it is seen under, over radius^2."""
    scene = floor()
    scene.lights.append(basicrt.PointLight((0, 0, 2), (3, 2, 1), 0.5, soft=True))
    expect(scene, ALBEDO / math.pi * np.array([3, 2, 1]) / (4 + 0.25))


@pytest.mark.parametrize(("aside", "share"), [(0, 1), (0.15, 1), (0.42, None), (0.6, 0)])
def test_a_floor_under_a_spot_light(aside: float, share: float | None) -> None:
    scene = floor()
    angle, blend = 1.0, 0.5
    scene.lights.append(
        basicrt.SpotLight(place(2) @ place(0, tilt=aside), (3, 2, 1), angle=angle, blend=blend)
    )
    if share is None:  # within the blend: the smooth step of the cosine, as Blender has it
        t = (math.cos(aside) - math.cos(angle / 2)) / ((1 - math.cos(angle / 2)) * blend)
        assert 0 < t < 1
        share = t * t * (3 - 2 * t)
    if share == 0:
        assert not basicrt.render(scene)["Combined"][..., :3].any()
    else:
        expect(scene, share * ALBEDO / math.pi * np.array([3, 2, 1]) / 4)


@pytest.mark.parametrize("angle", [0, 0.5])
def test_a_floor_under_the_sun(angle: float) -> None:
    """Irradiance is told for a surface that faces the sun; the mean cosine of a disc is that of its middle."""
    scene = floor()
    direction = (math.sin(0.7), 0, -math.cos(0.7))
    scene.lights.append(basicrt.SunLight(direction, (3, 2, 1), angle))
    # The disc is uniform in solid angle: its irradiance on the floor is E cos(tilt) whatever its size, if E is what
    # a facing surface receives.
    expect(scene, ALBEDO / math.pi * np.array([3, 2, 1]) * math.cos(0.7))


@pytest.mark.parametrize("size", [(1, 1), (2, 0.5), (6, 6)])
def test_a_floor_under_a_rectangle(size: tuple[float, float]) -> None:
    scene = floor(samples=1024)
    scene.lights.append(basicrt.AreaLight(place(1.5, size), (3, 2, 1)))
    expect(scene, ALBEDO / math.pi * np.array([3, 2, 1]) * under_rectangle(*size, 1.5))


@pytest.mark.parametrize("is_lamp", [True, False], ids=["lamp", "mesh"])
def test_a_floor_under_a_rectangle_seen_as_lamp_or_mesh(is_lamp: bool) -> None:
    scene = floor(samples=1024)
    facing_down = place(1.5, (1, 2)) @ np.diag([1, -1, -1, 1])
    if is_lamp:
        scene.lights.append(basicrt.AreaLight(place(1.5, (1, 2)), (3, 2, 1)))
    else:
        add(scene, quad(1), basicrt.EmissionShader((3, 2, 1), twosided=False), facing_down)
    expect(scene, ALBEDO / math.pi * np.array([3, 2, 1]) * under_rectangle(1, 2, 1.5))


def test_a_floor_under_a_disc() -> None:
    """pi times sin^2 of the angle that the disc is seen under."""
    scene = floor(samples=1024)
    scene.lights.append(basicrt.AreaLight(place(1.5, (2, 2)), (3, 2, 1), ellipse=True))
    expect(scene, ALBEDO * np.array([3, 2, 1]) / (1 + 1.5**2))


def test_a_floor_under_a_shining_sphere() -> None:
    """A sphere of radiance L, all above the horizon, lights like a point: pi L (radius / distance)^2."""
    scene = floor(samples=1024)
    above = place(2)
    add(scene, basicrt.Sphere(radius=0.5), basicrt.EmissionShader((3, 2, 1)), above)
    expect(scene, ALBEDO * np.array([3, 2, 1]) * (0.5 / 2) ** 2)


def test_a_floor_under_the_sky() -> None:
    scene = floor()
    scene.environment.radiance = (3, 2, 1)
    scene.settings.max_bounces = 1
    expect(scene, ALBEDO * np.array([3, 2, 1]))


def test_lights_add_up() -> None:
    """The sum of all lights is the sum of the pictures with one of them each."""
    lights = [
        basicrt.PointLight((0.5, 0, 2), (3, 2, 1)),
        basicrt.SunLight((0.3, 0, -1), (0.2, 0.2, 0.5)),
        basicrt.AreaLight(place(1.5, (1, 2)), (1, 1, 0.1)),
    ]
    total = np.zeros(3)
    together = floor(samples=2048)
    for light in lights:
        alone = floor(samples=1024)
        alone.lights.append(light)
        together.lights.append(light)
        total += mean_and_error(alone)[0]
    expect(together, total, relative=3e-3)


def test_bounces_in_a_shining_shell_add_up_to_a_geometric_series() -> None:
    """Inside a closed shell of albedo a that shines with E, every ray sees E / (1 - a)."""
    scene = basicrt.Scene()
    material = basicrt.Material()
    paint = material.add(basicrt.DiffuseShader((0.5, 0.5, 0.5), twosided=True))
    shine = material.add(basicrt.EmissionShader((1, 1, 1)))
    material.surface = material.add(basicrt.AddShader(paint, shine))
    index = scene.materials.append(material)
    scene.instances.append(
        basicrt.Instance(scene.shapes.append(basicrt.Sphere(radius=3)), materials=[index])
    )
    aim(scene, (0, -1, 0), (0, 0, 0), size=(16, 16), samples=256)
    settings = scene.settings
    settings.max_bounces = settings.diffuse_bounces = 512
    expect(scene, 2.0, relative=2e-3)


def test_a_fisheye_is_transparent_black_outside_of_its_circle() -> None:
    scene = basicrt.Scene()
    scene.environment.radiance = (0.25, 0.5, 0.75)
    half = math.pi / 4
    scene.camera = basicrt.FisheyeEquidistantCamera(
        fov=2 * half, window_min=(-half, -half), window_max=(half, half)
    )
    size = 64
    settings = scene.settings
    settings.width = settings.height = size
    settings.samples = 16
    with basicrt.Session(scene) as session:
        pixels = np.zeros((size, size, 4), np.float32)
        for tile in session.tiles():
            if tile is not None:
                rows, columns = (
                    slice(tile.y, tile.y + tile.height),
                    slice(tile.x, tile.x + tile.width),
                )
                pixels[rows, columns] = tile["Combined"]
        assert session.progress.fraction == 1
    # Unseen samples count as black: a pixel on the rim is as bright as it is covered.
    np.testing.assert_allclose(pixels[..., :3], pixels[..., 3:] * [0.25, 0.5, 0.75], atol=1e-6)
    x, y = np.meshgrid(np.arange(size), np.arange(size))
    corners = [np.hypot(x + i - size / 2, y + j - size / 2) for i in (0, 1) for j in (0, 1)]
    is_inside = np.max(corners, axis=0) < size / 2
    is_outside = np.min(corners, axis=0) > size / 2
    assert (pixels[is_inside, 3] == 1).all()
    assert (pixels[is_outside, 3] == 0).all()
    # All together cover the circle.
    assert pixels[..., 3].mean() == pytest.approx(math.pi / 4, abs=2e-3)


def test_a_distant_point_blurs_to_the_shape_of_the_aperture() -> None:
    """Light from a far small disc spreads over pi (r z / f)^2 at its depth z, f being the depth in focus."""
    radius, focus, depth = 0.05, 2.0, 8.0
    scene = basicrt.Scene()
    ball = 0.03
    add(scene, basicrt.Sphere((0, 0, -depth), ball), basicrt.EmissionShader((1, 1, 1)))
    half = 0.05  # of the window, at depth 1
    scene.camera = basicrt.PerspectiveCamera(
        window_min=(-half, -half),
        window_max=(half, half),
        aperture_radius=radius,
        focus_distance=focus,
    )
    size = 32
    settings = scene.settings
    settings.width = settings.height = size
    settings.samples = 4096
    picture = basicrt.render(scene)["Combined"][..., 0].astype(float)
    blur = radius * (depth / focus - 1) / depth  # radius of the disc, in the window
    area = (2 * half / size) ** 2
    assert picture.sum() * area == pytest.approx(math.pi * (ball / depth) ** 2, rel=0.04)
    center = (np.arange(size) + 0.5) / size * 2 * half - half
    x, y = np.meshgrid(center, center)
    r = np.hypot(x, y)
    margin = ball / depth + half / size * 2
    inside = r < blur - margin
    assert picture[inside].mean() == pytest.approx((ball / depth / blur) ** 2, rel=0.04)
    assert (picture[r > blur + margin] == 0).all()
    # The disc is even: halves by height and by side carry the same.
    for half_disc in (inside & (x > 0), inside & (y > 0)):
        assert picture[half_disc].mean() == pytest.approx(picture[inside].mean(), rel=0.06)
