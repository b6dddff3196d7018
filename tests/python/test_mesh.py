# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays that become meshes and textures: what is taken, what is refused and how, and who owns the memory."""

import gc
import weakref
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import basicrt
from basicrt import Mesh, SceneError

POSITIONS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], dtype=np.float32)
TRIANGLES = np.array([[0, 1, 2], [2, 1, 3]], dtype=np.uint32)
NORMALS = np.tile(np.array([0, 0, 1], dtype=np.float32), (2, 3, 1))
UVS = POSITIONS[TRIANGLES][..., :2]
SLOTS = np.array([0, 1], dtype=np.uint32)


def full_mesh() -> Mesh:
    return Mesh(POSITIONS, TRIANGLES, corner_normals=NORMALS, uvs=UVS, material_slots=SLOTS)


def test_arrays_come_back_as_they_went_in() -> None:
    mesh = full_mesh()
    for name, given in {
        "positions": POSITIONS,
        "triangles": TRIANGLES,
        "corner_normals": NORMALS,
        "uvs": UVS,
        "material_slots": SLOTS,
    }.items():
        stored = getattr(mesh, name)
        assert stored.dtype == given.dtype, name
        assert np.array_equal(stored, given), name


def test_optional_arrays_may_be_missing() -> None:
    mesh = Mesh(POSITIONS, TRIANGLES)
    assert mesh.corner_normals is None
    assert mesh.uvs is None
    assert mesh.material_slots is None
    assert mesh.motion_positions == mesh.motion_corner_normals == []
    assert repr(mesh) == "<Mesh of 4 positions, 2 triangles>"


def test_corners_may_come_in_one_row() -> None:
    mesh = Mesh(POSITIONS, TRIANGLES, corner_normals=NORMALS.reshape(6, 3), uvs=UVS.reshape(6, 2))
    assert np.array_equal(mesh.corner_normals, NORMALS)
    assert np.array_equal(mesh.uvs, UVS)


def test_a_mesh_that_deforms_has_its_arrays_at_further_times() -> None:
    positions = np.stack([POSITIONS + 1, POSITIONS + 2, POSITIONS * 3])
    normals = np.stack([NORMALS, -NORMALS, NORMALS * 2])
    for given in (normals, normals.reshape(3, 6, 3)):
        mesh = Mesh(
            POSITIONS,
            TRIANGLES,
            corner_normals=NORMALS,
            motion_positions=positions.astype(float),
            motion_corner_normals=given,
        )
        assert np.array_equal(mesh.positions, POSITIONS)
        assert np.array_equal(mesh.motion_positions, positions)
        assert np.array_equal(mesh.motion_corner_normals, normals)
        assert not mesh.motion_positions[0].flags.writeable
    assert Mesh(POSITIONS, TRIANGLES, motion_positions=[]).motion_positions == []


def test_a_mesh_knows_the_frames_before_and_after() -> None:
    positions = np.stack([POSITIONS + 1, POSITIONS * 3])
    mesh = Mesh(POSITIONS, TRIANGLES, adjacent_positions=positions)
    assert np.array_equal(mesh.adjacent_positions, positions)
    assert mesh.motion_positions == []
    assert Mesh(POSITIONS, TRIANGLES).adjacent_positions == []


@pytest.mark.parametrize("dtype", [np.float16, np.float64, np.int32, np.uint8, ">f4"])
def test_positions_of_other_real_types_are_converted(dtype) -> None:
    assert np.array_equal(Mesh(POSITIONS.astype(dtype), TRIANGLES).positions, POSITIONS)


@pytest.mark.parametrize("dtype", [np.int32, np.int64, np.uint8, np.uint64, ">u4"])
def test_triangles_of_other_integer_types_are_converted(dtype) -> None:
    assert np.array_equal(Mesh(POSITIONS, TRIANGLES.astype(dtype)).triangles, TRIANGLES)


def test_arrays_need_not_be_contiguous() -> None:
    wide = np.zeros((4, 6), dtype=np.float32)
    wide[:, ::2] = POSITIONS
    mesh = Mesh(wide[:, ::2], np.asfortranarray(TRIANGLES), uvs=UVS[:, ::-1][:, ::-1])
    assert np.array_equal(mesh.positions, POSITIONS)
    assert np.array_equal(mesh.triangles, TRIANGLES)
    assert np.array_equal(mesh.uvs, UVS)


def test_lists_are_arrays() -> None:
    mesh = Mesh(POSITIONS.tolist(), TRIANGLES.tolist())
    assert np.array_equal(mesh.positions, POSITIONS)


def test_a_mesh_may_be_empty() -> None:
    for positions, triangles in (
        ([], []),
        (np.zeros((0, 3)), np.zeros((0, 3), int)),
        (POSITIONS, []),
    ):
        mesh = Mesh(positions, triangles, corner_normals=[], uvs=[], material_slots=[])
        assert mesh.triangles.shape == (0, 3)
        assert mesh.positions.shape == (len(positions), 3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"positions": POSITIONS * 1j}, "positions: must hold real numbers, is of complex"),
        ({"positions": POSITIONS > 0}, "positions: must hold real numbers, is of bool"),
        ({"positions": "no"}, "positions: must hold real numbers"),
        ({"positions": None}, "positions: must hold real numbers, is of object"),
        ({"positions": [[0, 0, 0], [1, 1]]}, "positions: can't be made an array"),
        ({"positions": POSITIONS[:, :2]}, r"positions: must have the shape \(N, 3\), is \(4, 2\)"),
        ({"positions": POSITIONS.ravel()}, r"positions: must have the shape \(N, 3\), is \(12,\)"),
        (
            {"positions": np.where(POSITIONS > 0, np.nan, 0)},
            r"positions\[1, 0\]: must be a finite number, is",
        ),
        (
            {"positions": POSITIONS.astype(float) * 1e39},
            r"positions\[1, 0\]: must be a finite number, is inf",
        ),
        ({"triangles": TRIANGLES.astype(float)}, "triangles: must hold integers, is of float64"),
        ({"triangles": TRIANGLES[:, :2]}, r"triangles: must have the shape \(N, 3\), is \(2, 2\)"),
        ({"triangles": [[0, 1, 4]]}, r"triangles\[0\].*4"),
        ({"triangles": [[0, 1, 2], [0, -1, 2]]}, r"triangles\[1, 1\]: must be in .*, is -1"),
        ({"triangles": [[0, 1, 2**32]]}, r"triangles\[0, 2\]: must be in .*, is 4294967296"),
        (
            {"corner_normals": NORMALS[:1]},
            r"corner_normals: .*\(2, 3, 3\) or \(6, 3\), is \(1, 3, 3\)",
        ),
        ({"corner_normals": []}, r"corner_normals: must have the shape \(2, 3, 3\)"),
        (
            {"corner_normals": NORMALS + np.inf},
            r"corner_normals\[0, 0, 0\]: must be a finite number",
        ),
        (
            {"uvs": UVS[..., :1]},
            r"uvs: must have the shape \(2, 3, 2\) or \(6, 2\), is \(2, 3, 1\)",
        ),
        (
            {"motion_positions": POSITIONS},
            r"motion_positions: must have the shape \(N, 4, 3\), is \(4, 3\)",
        ),
        (
            {"motion_positions": [POSITIONS[:3]]},
            r"motion_positions: must have the shape \(N, 4, 3\), is \(1, 3, 3\)",
        ),
        (
            {"motion_positions": [POSITIONS * np.nan]},
            r"motion_positions\[0, 0, 0\]: must be a finite number",
        ),
        (
            {"motion_positions": [POSITIONS], "corner_normals": NORMALS},
            "motion_corner_normals: must have as many keys as motion_positions",
        ),
        (
            {"motion_positions": [POSITIONS], "motion_corner_normals": [NORMALS]},
            "motion_corner_normals: must have as many keys as motion_positions",
        ),
        (
            {"adjacent_positions": [POSITIONS]},
            r"adjacent_positions: must have the shape \(2, 4, 3\), is \(1, 4, 3\)",
        ),
        ({"material_slots": [0]}, r"material_slots: must have the shape \(2,\), is \(1,\)"),
        ({"material_slots": [0, -1]}, r"material_slots\[1\]: must be in"),
        ({"material_slots": [0.0, 1.0]}, "material_slots: must hold integers"),
    ],
)
@pytest.mark.filterwarnings("ignore:overflow encountered in cast")
def test_bad_arrays_are_refused_by_name_rule_and_value(arguments, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        Mesh(**{"positions": POSITIONS, "triangles": TRIANGLES, **arguments})


def test_what_numpy_raises_for_other_reasons_is_not_hidden() -> None:
    class Broken:
        def __array__(self, *_args, **_keywords):
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        Mesh(Broken(), TRIANGLES)


def test_the_mesh_keeps_nothing_of_the_arrays() -> None:
    positions, triangles = POSITIONS.copy(), TRIANGLES.copy()
    mesh = Mesh(positions, triangles)
    watch = weakref.ref(positions)
    positions[:] = np.nan
    triangles[:] = 7
    del positions
    gc.collect()
    assert watch() is None
    assert np.array_equal(mesh.positions, POSITIONS)
    assert np.array_equal(mesh.triangles, TRIANGLES)


def test_views_are_read_only_and_keep_the_mesh_alive() -> None:
    mesh = full_mesh()
    views = [mesh.positions, mesh.triangles, mesh.corner_normals, mesh.uvs, mesh.material_slots]
    del mesh
    gc.collect()
    for view, given in zip(views, [POSITIONS, TRIANGLES, NORMALS, UVS, SLOTS], strict=True):
        assert view is not None
        assert not view.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            view[0] = 0
        assert np.array_equal(view, given)


def test_an_image_comes_back_as_it_went_in() -> None:
    pixels = np.random.default_rng(3).random((4, 5, 3)).astype(np.float32)
    image = basicrt.Image(pixels)
    assert np.array_equal(image.pixels, pixels)
    assert not image.pixels.flags.writeable
    assert repr(image) == "<Image of 5 x 4 pixels>"


def test_bytes_stay_bytes() -> None:
    pixels = np.arange(60, dtype=np.uint8).reshape(4, 5, 3)
    image = basicrt.Image(pixels, "linear")
    assert image.pixels.dtype == np.uint8
    assert np.array_equal(image.pixels, pixels)
    assert image.encoding == "linear"
    assert basicrt.Image(pixels[::-1, :, ::-1]).encoding == "srgb"
    assert np.array_equal(basicrt.Image(pixels[::-1, :, ::-1]).pixels, pixels[::-1, :, ::-1])


def test_textures_share_an_image() -> None:
    image = basicrt.Image(np.zeros((2, 2, 3)))
    textures = [basicrt.ImageTexture(image), basicrt.ImageTexture(image, extension="clip")]
    addresses = {t.image.pixels.__array_interface__["data"][0] for t in textures}
    assert addresses == {image.pixels.__array_interface__["data"][0]}


def test_a_texture_takes_pixels_for_an_image() -> None:
    pixels = np.random.default_rng(3).random((4, 5, 3)).astype(np.float32)
    assert np.array_equal(basicrt.ImageTexture(pixels).image.pixels, pixels)


@pytest.mark.parametrize(
    "sky",
    [
        basicrt.PreethamSky(sun_elevation=0.5, turbidity=4),
        basicrt.SingleScatteringSky(altitude=500, sun_disc=False),
        basicrt.MultipleScatteringSky(sun_rotation=1, aerosol_density=3),
    ],
)
@pytest.mark.filterwarnings("ignore:objects. the scene has none")
def test_a_sky_is_saved_and_read_back(sky: Any, tmp_path: Path) -> None:
    scene = basicrt.Scene()
    scene.environment.layers = [basicrt.EnvironmentLayer(sky=sky)]
    scene.save(tmp_path / "scene.json")
    (layer,) = basicrt.load_scene(tmp_path / "scene.json").environment.layers
    assert repr(layer.sky) == repr(sky)


def test_a_layer_has_an_image_or_a_sky_but_not_both() -> None:
    scene = basicrt.Scene()
    image = basicrt.Image(np.zeros((2, 4, 3), np.float32))
    layer = basicrt.EnvironmentLayer(image=image, sky=basicrt.PreethamSky())
    scene.environment.layers = [layer]
    with pytest.raises(basicrt.SceneError, match=r"environment.layers\[0\].sky: there is an image"):
        basicrt.render(scene)


def test_environment_layers_hold_images() -> None:
    environment = basicrt.Environment(layers=[basicrt.EnvironmentLayer((1, 2, 3))])
    image = basicrt.Image(np.ones((2, 4, 3)))
    environment.layers = [
        *environment.layers,
        basicrt.EnvironmentLayer(image=image, projection="mirror_ball", seen_by="camera"),
    ]
    plain, picture = environment.layers
    assert plain.image is None
    assert plain.radiance == (1, 2, 3)
    assert picture.image is not None
    assert picture.image.pixels.shape == (2, 4, 3)
    assert (picture.projection, picture.seen_by) == ("mirror_ball", "camera")


@pytest.mark.parametrize(
    ("pixels", "message"),
    [
        (np.zeros((4, 5)), r"pixels: must have the shape \(N, N, N\), is \(4, 5\)"),
        (np.zeros((4, 5, 5)), "pixels: must have 1 to 4 channels, has 5"),
        (np.zeros((0, 5, 3)), "pixels: must not be empty"),
        (np.full((1, 1, 1), np.nan), r"pixels\[0, 0, 0\]: must be a finite number"),
        (np.zeros((4, 5), np.uint8), r"pixels: must have the shape \(N, N, N\), has 2 dimensions"),
        (np.zeros((4, 5, 5), np.uint8), "pixels: must have 1 to 4 channels, has 5"),
    ],
)
def test_bad_images_are_refused(pixels, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        basicrt.ImageTexture(pixels)
