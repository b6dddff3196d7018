# SPDX-License-Identifier: GPL-3.0-or-later
"""Images in each colour space that Blender's configuration has: the same colours as in Cycles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.nodes import Textures, color_spaces
from addon.report import Report

import basicrt
from support.blender import new_image, render_both
from support.surfaces import plane

_NAMES: Any = bpy.types.ColorManagedInputColorspaceSettings.bl_rna.properties["name"]
EVEN = {"ACEScg", "ACES2065-1", "sRGB", "Rec.1886", "Display P3", "Non-Color"}
SPACES = [item.identifier for item in _NAMES.enum_items]
EVEN |= {name for name in SPACES if "Linear" in name}
# Cycles keeps half floats, before and after. Where a space is of logarithms, those before make a percent, in 5.2 some.
PRECISION = 2e-3
PRECISION_OF_LOGARITHMS = 1.5e-2 if bpy.app.version < (5, 2) else 5e-2


def picture(seed: int = 3, is_opaque: bool = True) -> np.ndarray:
    made = np.random.default_rng(seed).random((5, 4, 4))
    if is_opaque:
        made[..., 3] = 1
    return made


@pytest.fixture(autouse=True)
def shining() -> tuple[Any, Any, Any]:
    """The tree, the emission and the plane of a new scene."""
    return plane()


def both(shining: Any, image: Any, folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """A plane that shines as the image says, and a bit more, so that negative values show."""
    tree, emission, made = shining
    layer = made.data.uv_layers.active
    for item, uv in zip(layer.uv, [(0, 0), (1, 0), (1, 1), (0, 1)], strict=False):
        item.vector = uv
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image, texture.interpolation = image, "Closest"
    moved = tree.nodes.new("ShaderNodeVectorMath")
    moved.operation = "ADD"
    moved.inputs[1].default_value = (0.5, 0.5, 0.5)
    tree.links.new(texture.outputs["Color"], moved.inputs[0])
    tree.links.new(moved.outputs[0], emission.inputs["Color"])
    return render_both(folder)


def assert_same(shining: Any, image: Any, folder: Path) -> None:
    ours, theirs = (np.maximum(shown[..., :3], 0) for shown in both(shining, image, folder))
    assert theirs.std() > 0.01, "the picture must show something"
    is_even = image.colorspace_settings.name in EVEN
    precision = PRECISION if is_even else PRECISION_OF_LOGARITHMS
    differs = np.abs(ours - theirs) > precision * (1 + np.abs(theirs))
    # A sample within a hundredth of a pixel from the next colour.
    assert differs.any(axis=2).mean() < 0.01, np.abs(ours - theirs).max()


@pytest.mark.parametrize("space", SPACES)
def test_bytes_are_as_in_cycles(shining: Any, space: str, tmp_path: Path) -> None:
    if bpy.app.version >= (5, 2) and space == "ADX16":
        pytest.skip(
            "the Cycles of Blender 5.2 rounds so wide a range of logarithms too coarsely to compare"
        )
    assert_same(shining, new_image(picture(), space, is_float=False), tmp_path)


@pytest.mark.parametrize("alpha_mode", ["STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"])
@pytest.mark.parametrize("space", ["Filmic sRGB", "Linear Rec.2020"])
def test_alpha_is_as_in_cycles(shining: Any, space: str, alpha_mode: str, tmp_path: Path) -> None:
    if bpy.app.version >= (5, 2) and alpha_mode == "PREMUL":
        pytest.skip("the Cycles of Blender 5.2 means something else by images in memory")
    image = new_image(picture(is_opaque=False), space, is_float=False)
    image.alpha_mode = alpha_mode
    assert_same(shining, image, tmp_path)


@pytest.mark.parametrize("space", ["sRGB", "ACEScg"])
def test_floats_of_a_file_are_as_in_cycles(shining: Any, space: str, tmp_path: Path) -> None:
    made = new_image(picture())
    made.filepath_raw, made.file_format = str(tmp_path / "colors.exr"), "OPEN_EXR"
    made.save()
    image = bpy.data.images.load(made.filepath_raw)
    image.colorspace_settings.name = space
    assert_same(shining, image, tmp_path)


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="colours are linear Rec.709 before 5.0")
@pytest.mark.parametrize("space", ["sRGB", "Linear Rec.709", "Non-Color"])
def test_another_working_space_is_the_one_of_the_picture(
    shining: Any, space: str, tmp_path: Path
) -> None:
    image = new_image(picture(), space, is_float=False)
    bpy.ops.wm.set_working_color_space(working_space="Linear Rec.2020", convert_colors=False)
    try:
        assert_same(shining, image, tmp_path)
    finally:
        bpy.ops.wm.set_working_color_space(working_space="Linear Rec.709", convert_colors=False)


def test_no_picture_is_left_behind() -> None:
    image = new_image(picture(), "ACEScg", is_float=False)
    before = list(bpy.data.images)
    pixels = np.full((2, 3, 3), 128, np.uint8)
    assert color_spaces.decoded(image, pixels, is_associated=False) is not None
    assert list(bpy.data.images) == before


def test_a_space_that_cannot_be_converted_is_told_of(monkeypatch: pytest.MonkeyPatch) -> None:
    image = new_image(picture(), "ACEScg", is_float=False)
    monkeypatch.setattr(color_spaces, "_scene_linear", lambda _colors, _space: None)
    report = Report()
    converted = Textures(basicrt.Scene()).image(image, None, lambda text: report.warn("m", text))
    assert converted is not None
    assert converted.image.encoding == "srgb"
    assert report.warnings == (
        'm: image "Picture": the colour space ACEScg can\'t be converted: taken for sRGB',
    )
