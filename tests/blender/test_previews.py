# SPDX-License-Identifier: GPL-3.0-or-later
"""Previews of materials, worlds and lights, as Blender asks engines for them, beside Cycles' of the same."""

import time
from typing import Any

import bpy
import numpy as np
import pytest
from addon import report
from addon.engine import BasicRTRenderEngine, preview

from support.blender import (
    add_lamp,
    add_node,
    add_plane,
    empty_material,
    new_material,
    new_scene,
    set_world,
)


def preview_of(owner: Any) -> np.ndarray:
    """(height, width, 4), as it is shown; nothing where Blender has rendered none."""
    if isinstance(owner, bpy.types.Material):  # only of what the scene has
        add_plane(1, 0, owner)
    owner.preview_ensure()
    bpy.ops.wm.previews_ensure()
    preview = owner.preview
    width, height = preview.image_size
    return np.array(preview.image_pixels_float, np.float32).reshape(height, width, 4)


def middle(picture: np.ndarray) -> np.ndarray:
    """The mean colour of what is in the middle: the ball."""
    size = len(picture)
    part = picture[size * 2 // 5 : size * 3 // 5, size * 2 // 5 : size * 3 // 5]
    return np.asarray(part[..., :3].mean(axis=(0, 1)))


def test_a_material_is_seen_in_its_colour() -> None:
    new_scene()
    red = preview_of(new_material("ShaderNodeBsdfDiffuse", "Red", Color=(0.8, 0.05, 0.05)))
    green = preview_of(new_material("ShaderNodeBsdfDiffuse", "Green", Color=(0.05, 0.8, 0.05)))
    assert red.shape[0] >= 32
    assert middle(red)[0] > 1.3 * middle(red)[1]
    assert middle(green)[1] > 1.3 * middle(green)[0]


def test_every_kind_of_owner_has_one() -> None:
    new_scene()
    world = set_world((0.2, 0.4, 0.8))
    lamp = add_lamp("POINT", energy=100).data
    for owner in (world, lamp):
        assert preview_of(owner)[..., :3].max() > 0.1


@pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="compared in one version: 5.0")
@pytest.mark.parametrize("kind", ["diffuse", "glass", "world", "light"])
def test_previews_are_like_cycles(kind: str) -> None:
    pictures = []
    for engine in ("BASICRT", "CYCLES"):
        scene = new_scene()
        scene.render.engine = engine
        if kind == "world":
            owner = set_world((0.2, 0.4, 0.8))
        elif kind == "light":
            owner = add_lamp("POINT", energy=100).data
        else:
            shader = "ShaderNodeBsdfDiffuse" if kind == "diffuse" else "ShaderNodeBsdfGlass"
            owner = new_material(shader, Color=(0.8, 0.5, 0.2))
        pictures.append(preview_of(owner))
    ours, theirs = pictures
    assert ours.shape == theirs.shape
    cells = [p.reshape(4, len(p) // 4, 4, len(p) // 4, 4).mean(axis=(1, 3)) for p in pictures]
    assert np.abs(cells[0] - cells[1]).max() < 0.05


def test_previews_are_quick_and_tell_no_tales(caplog: Any) -> None:
    """They are drawn again with each change: neither a log full of warnings nor a panel that shows them."""
    scene = new_scene()
    scene.basicrt.samples = 1 << 20
    material, tree, output = empty_material("Strange")
    tree.links.new(add_node(tree, "ShaderNodeBsdfHair").outputs[0], output.inputs["Surface"])
    report.show_warnings(report.Report())
    begin = time.monotonic()
    preview_of(material)
    assert time.monotonic() - begin < 30  # alone it is one second
    assert not report.shown_warnings()
    assert not [record for record in caplog.records if record.name == "basicrt"]


def test_a_preview_that_nobody_wants_any_more_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    new_scene()
    monkeypatch.setattr(preview, "SAMPLES", (1 << 20,))
    monkeypatch.setattr(BasicRTRenderEngine, "_is_cancelled", lambda _: True)
    begin = time.monotonic()
    preview_of(new_material("ShaderNodeBsdfDiffuse"))
    assert time.monotonic() - begin < 30  # all of it would take an hour


def test_the_engine_offers_previews() -> None:
    assert BasicRTRenderEngine.bl_use_preview
