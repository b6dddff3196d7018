# SPDX-License-Identifier: GPL-3.0-or-later
"""bake(): what leaves known places of known scenes, without Blender."""

import numpy as np
import pytest

import basicrt
from basicrt import BakePlan, BakeTarget, SceneError
from support.scenes import add, quad

NOWHERE = BakeTarget.NOWHERE
ALBEDO = (0.5, 0.25, 0.75)
SKY = (0.4, 0.8, 1.2)


def lit_quad(samples: int = 16) -> basicrt.Scene:
    """A diffuse square under an even sky; no camera."""
    scene = basicrt.Scene()
    add(scene, quad(), basicrt.DiffuseShader(color=ALBEDO, twosided=True))
    scene.environment = basicrt.Environment(radiance=SKY)
    scene.settings.samples = samples
    return scene


def target(size: int = 4, instance: int = 0) -> BakeTarget:
    """The square's texture: its lower right triangle is the first, the other the second."""
    place = (np.arange(size) + 0.5) / size
    u, v = np.meshgrid(place, place)
    is_first = u >= v
    # Corners (0, 0), (1, 0), (1, 1) and (0, 0), (1, 1), (0, 1).
    barycentrics = np.where(
        is_first[..., None], np.stack([u - v, v], axis=-1), np.stack([u, v - u], axis=-1)
    )
    return BakeTarget(instance, np.where(is_first, 0, 1), barycentrics)


def test_a_diffuse_surface_reflects_its_share_of_an_even_sky() -> None:
    picture = basicrt.bake(lit_quad(64), target())
    assert picture.shape == (4, 4, 4)
    np.testing.assert_allclose(
        picture, np.broadcast_to((*np.multiply(ALBEDO, SKY), 1), picture.shape), rtol=1e-4
    )


@pytest.mark.parametrize(
    ("plan", "expected"),
    [
        (BakePlan("diffuse"), np.multiply(ALBEDO, SKY)),
        (BakePlan("diffuse", color=False), SKY),
        (BakePlan("diffuse", direct=False, indirect=False), ALBEDO),
        (BakePlan("diffuse", direct=False), (0, 0, 0)),
        (BakePlan("glossy"), (0, 0, 0)),
        (BakePlan("combined", direct=False), (0, 0, 0)),
        (BakePlan("combined", diffuse=False), (0, 0, 0)),
        (BakePlan("ao"), (1, 1, 1)),
        (BakePlan("normal"), (0, 0, 1)),
        (BakePlan("shadow"), (1, 1, 1)),
        (BakePlan("roughness"), (1, 1, 1)),
        (BakePlan("environment"), SKY),
    ],
    ids=repr,
)
def test_parts_of_an_open_square(plan: BakePlan, expected: tuple[float, ...]) -> None:
    picture = basicrt.bake(lit_quad(64), target(), plan)
    assert (picture[..., 3] == 1).all()
    np.testing.assert_allclose(
        picture[..., :3], np.broadcast_to(expected, (4, 4, 3)), rtol=1e-4, atol=1e-6
    )


def test_places_and_texture_coordinates() -> None:
    scene = lit_quad(4)
    instance = scene.instances[0]
    # Turned about x by a right angle, twice as wide, moved.
    transform = np.array([[2, 0, 0, 1], [0, 0, -1, 2], [0, 1, 0, 3], [0, 0, 0, 1]], np.float32)
    instance.transform = transform
    scene.instances[0] = instance
    place = (np.arange(4) + 0.5) / 4
    u, v = np.meshgrid(place, place)
    uv = basicrt.bake(scene, target(), "uv")
    np.testing.assert_allclose(uv[..., 0], u, atol=2e-4)
    np.testing.assert_allclose(uv[..., 1], v, atol=2e-4)
    local = np.stack([2 * u - 1, 2 * v - 1, 0 * u, 0 * u + 1], axis=-1)
    position = basicrt.bake(scene, target(), "position")
    np.testing.assert_allclose(position[..., :3], (local @ transform.T)[..., :3], atol=1e-3)
    normal = basicrt.bake(scene, target(), "normal")
    np.testing.assert_allclose(normal[..., :3], np.broadcast_to((0, -1, 0), (4, 4, 3)), atol=1e-6)


def test_nothing_is_baked_nowhere() -> None:
    triangles = np.array([[0, NOWHERE]], np.uint32)
    picture = basicrt.bake(lit_quad(), BakeTarget(0, triangles, np.full((1, 2, 2), 0.25)))
    assert picture[0, 0, 3] == 1
    assert not picture[0, 1].any()


def test_triangles_count_as_in_the_mesh_that_was_given() -> None:
    """Those without an area are left out of what is traced, and so are empty meshes."""
    scene = basicrt.Scene()
    empty = basicrt.Mesh(np.zeros((3, 3)), np.zeros((0, 3), np.uint32))
    add(scene, empty, basicrt.DiffuseShader())
    corners = np.array(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 5], [1, 0, 5], [0, 1, 5]], np.float32
    )
    mesh = basicrt.Mesh(corners, np.array([[0, 0, 1], [0, 1, 2], [3, 4, 5]]))
    add(scene, mesh, basicrt.DiffuseShader())
    triangles = np.array([[0, 1, 2]], np.uint32)
    with pytest.warns(basicrt.SceneWarning):
        picture = basicrt.bake(
            scene, BakeTarget(1, triangles, np.full((1, 3, 2), 0.25)), "position"
        )
    np.testing.assert_allclose(picture[0, 1:, 2], [0, 5], atol=1e-3)
    assert not picture[0, 0].any()


def closed_box(samples: int) -> basicrt.Scene:
    """The square within four walls and a lid, all diffuse."""
    scene = lit_quad(samples)
    corners = np.array([[x, y, z] for z in (-0.5, 1) for y in (-2, 2) for x in (-2, 2)], np.float32)
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    add(scene, basicrt.Mesh(corners, np.array(triangles)), basicrt.DiffuseShader(twosided=True))
    return scene


def test_occlusion_reaches_as_far_as_it_is_told() -> None:
    scene = closed_box(64)
    assert not basicrt.bake(scene, target(), "ao")[..., :3].any()
    scene.settings.ao_distance = 0.9  # the lid is 1 away
    assert basicrt.bake(scene, target(1), "ao")[0, 0, 0] == 1
    scene.settings.samples, scene.settings.ao_distance = 1024, 2.0  # nearer: within 60 degrees
    assert basicrt.bake(scene, target(1), "ao")[0, 0, 0] == pytest.approx(0.25, abs=0.02)


def test_emission_is_part_of_what_is_combined_and_can_be_left_out() -> None:
    scene = basicrt.Scene()
    add(scene, quad(), basicrt.EmissionShader(radiance=(1, 0.5, 0.25), strength=2))
    assert basicrt.bake(scene, target(1))[0, 0].tolist() == [2, 1, 0.5, 1]
    assert basicrt.bake(scene, target(1), "emit")[0, 0].tolist() == [2, 1, 0.5, 1]
    assert not basicrt.bake(scene, target(1), BakePlan(emission=False))[..., :3].any()


def test_what_is_transparent_is_a_hole() -> None:
    scene = lit_quad(256)
    material = basicrt.Material()
    clear = material.add(basicrt.TransparentShader())
    solid = material.add(basicrt.DiffuseShader(color=ALBEDO, twosided=True))
    material.surface = material.add(basicrt.MixShader(factor=0.25, first=solid, second=clear))
    scene.materials[0] = material
    picture = basicrt.bake(scene, target(1))[0, 0]
    np.testing.assert_allclose(picture, (*(0.75 * np.multiply(ALBEDO, SKY)), 0.75), rtol=1e-3)


def test_a_mirror_shows_what_is_above_it_or_what_the_camera_sees_in_it() -> None:
    scene = basicrt.Scene()
    add(scene, quad(), basicrt.GlossyShader(color=(1, 1, 1), roughness=0))
    for index, (x, z) in enumerate(
        ((0, 3), (3, 3))
    ):  # straight above, and at 45 degrees to the right
        shine = basicrt.EmissionShader(radiance=(1 - index, index, 0), twosided=True)
        moved = np.eye(4)
        moved[:3, 3] = x, 0, z
        add(scene, quad(0.5), shine, moved)
    place = BakeTarget(0, [[0]], [[[0.0, 0.5]]])  # the middle
    assert basicrt.bake(scene, place)[0, 0, :3].tolist() == [1, 0, 0]
    scene.camera = basicrt.look_at_camera((-3, 0, 3), (0, 0, 0), (0, 1, 0), 0.5, 1)
    assert basicrt.bake(scene, place, BakePlan(from_camera=True))[0, 0, :3].tolist() == [0, 1, 0]


def test_a_shadow_is_the_share_that_is_left_of_the_light() -> None:
    scene = lit_quad(64)
    scene.environment = basicrt.Environment()
    scene.lights.append(basicrt.SunLight(irradiance=(1, 1, 1)))
    lid = np.eye(4)
    lid[:3, 3] = 1, 0, 1  # over the right half
    add(scene, quad(2), basicrt.DiffuseShader(color=(0, 0, 0)), lid)
    shadow = basicrt.bake(scene, target(2), "shadow")[..., 0]
    np.testing.assert_allclose(shadow, [[1, 0], [1, 0]], atol=1e-6)
    assert not scene.instances[0].shadow_catcher


@pytest.mark.parametrize("threads", [1, 2, 5])
@pytest.mark.parametrize("tile_size", [1, 3, 64])
def test_pictures_have_the_same_bytes_for_any_threads_and_tiles(
    threads: int, tile_size: int
) -> None:
    first = basicrt.bake(closed_box(8), target(6), threads=1)
    assert first.any()
    again = basicrt.bake(closed_box(8), target(6), threads=threads, tile_size=tile_size)
    assert again.tobytes() == first.tobytes()


def test_places_with_the_same_seed_have_the_same_noise() -> None:
    scene = closed_box(4)
    scene.settings.ao_distance = 2.0
    same = np.zeros((1, 2, 2)) + 0.25
    alike = basicrt.bake(scene, BakeTarget(0, [[0, 0]], same, seeds=[[7, 7]]), "ao")
    other = basicrt.bake(scene, BakeTarget(0, [[0, 0]], same, seeds=[[7, 8]]), "ao")
    assert (alike[0, 0] == alike[0, 1]).all()
    assert (other[0, 0] != other[0, 1]).any()


def test_samples_are_spread_over_the_pixel_within_the_triangle() -> None:
    scene = lit_quad(4096)
    middle = [[[0.25, 0.25]]]
    # The texture is x + y over the pixel from 0.15 to 0.35 each way, which lies in the triangle.
    across = BakeTarget(0, [[0]], middle, changes=[[[[0.2, 0], [0, 0.2]]]])
    uv = basicrt.bake(scene, across, "uv")[0, 0]
    np.testing.assert_allclose(uv[:2], (0.5, 0.25), atol=2e-3)
    # One that is far larger than the triangle stays in it.
    huge = BakeTarget(0, [[0]], middle, changes=[[[[9, 0], [0, 9]]]])
    u, v, _a, _b = basicrt.bake(scene, huge, "uv")[0, 0]
    assert 0 < v < u < 1


def test_baking_can_be_stopped() -> None:
    class StopError(Exception):
        pass

    def stop(progress: basicrt.Progress) -> None:
        raise StopError

    with pytest.raises(StopError):
        basicrt.bake(lit_quad(1 << 20), target(64), progress=stop)


def test_the_scene_stays_as_it_was() -> None:
    scene = lit_quad()
    before = scene.to_json()
    basicrt.bake(scene, target(), "shadow")
    assert scene.to_json() == before
    assert scene.camera is None


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: BakeTarget(0, [[2]], [[[0, 0]]]),
            r"BakeTarget.triangles\[0, 0\]: is 2, but the mesh has 2 triangles",
        ),
        (
            lambda: BakeTarget(1, [[0]], [[[0, 0]]]),
            "BakeTarget.instance: is 1, but the scene has 1 instances",
        ),
        (
            lambda: BakeTarget(0, [0], [[[0, 0]]]),
            r"BakeTarget.triangles: must have the shape \(N, N\), is \(1,\)",
        ),
        (
            lambda: BakeTarget(0, [[0]], [[0, 0]]),
            r"BakeTarget.barycentrics: must have the shape \(1, 1, 2\)",
        ),
        (
            lambda: BakeTarget(0, [[0]], [[[np.nan, 0]]]),
            "BakeTarget.barycentrics.* must be a finite number",
        ),
        (
            lambda: BakeTarget(0, np.zeros((0, 0), int), np.zeros((0, 0, 2))),
            "must have pixels, is 0 x 0",
        ),
    ],
)
def test_bad_targets_are_refused(make, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        basicrt.bake(lit_quad(), make())


def test_bad_plans_are_refused() -> None:
    with pytest.raises(SceneError, match=r'bake.kind: must be one of combined, .*, is "light"'):
        basicrt.bake(lit_quad(), target(), "light")
    with pytest.raises(SceneError, match="diffuse needs direct, indirect or color"):
        BakePlan("diffuse", direct=False, indirect=False, color=False)
    with pytest.raises(SceneError, match=r"BakeSettings.from_camera: the scene has no camera"):
        basicrt.bake(lit_quad(), target(), BakePlan(from_camera=True))
    scene = lit_quad()
    scene.settings.integrator = "intersection_test"
    with pytest.raises(SceneError, match=r"settings.integrator: must be path"):
        basicrt.bake(scene, target())
    scene = basicrt.Scene()
    add(scene, basicrt.Sphere(), basicrt.DiffuseShader())
    with pytest.raises(SceneError, match=r"BakeTarget.instance: must be of a mesh"):
        basicrt.bake(scene, target())
