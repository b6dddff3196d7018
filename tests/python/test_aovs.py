# SPDX-License-Identifier: GPL-3.0-or-later
"""AOVs: what materials write into passes of their own."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import basicrt
from basicrt import AovShader, SceneError
from support.scenes import quad


def scene_of(*aovs: AovShader, passes: list[str], transform: Any = None) -> basicrt.Scene:
    """A grey square that fills the right half of the picture."""
    scene = basicrt.Scene()
    material = basicrt.Material()
    material.surface = material.add(basicrt.DiffuseShader(color=(0.5, 0.5, 0.5)))
    for aov in aovs:
        material.add(aov)
    scene.materials.append(material)
    scene.shapes.append(quad())
    place = np.eye(4)
    place[0, 3] = 1
    scene.instances.append(basicrt.Instance(shape=0, transform=place, materials=[0]))
    camera = np.eye(4)
    camera[2, 3] = 2
    scene.camera = basicrt.OrthographicCamera(
        transform=camera, window_min=(-1, -1), window_max=(1, 1)
    )
    scene.settings = basicrt.RenderSettings(
        width=4, height=4, samples=4, passes=passes, filter_type="box", filter_radius=0.5
    )
    return scene


def test_the_first_surface_says_what_is_in_them() -> None:
    aovs = AovShader(number=1, color=(0.25, -0.5, 4), value=-3), AovShader(number=16, value=7)
    names = ["AOV Color 01", "AOV Value 01", "AOV Value 16", "AOV Value 02"]
    pictures = basicrt.render(scene_of(*aovs, passes=["Combined", *names]))
    color = pictures["AOV Color 01"]
    assert color[:, 2:].reshape(-1, 4).tolist() == [[0.25, -0.5, 4, 1]] * 8
    assert not color[:, :2].any()
    assert pictures["AOV Value 01"][0, :, 0].tolist() == [0, 0, -3, -3]
    assert pictures["AOV Value 16"][0, :, 0].tolist() == [0, 0, 7, 7]
    assert not pictures["AOV Value 02"].any()


def test_the_picture_is_the_same_without_them() -> None:
    with_aov = basicrt.render(scene_of(AovShader(value=3), passes=["Combined", "AOV Value 01"]))
    without = basicrt.render(scene_of(passes=["Combined"]))
    assert with_aov["Combined"].tobytes() == without["Combined"].tobytes()


def test_they_vary_where_the_surface_does_not() -> None:
    scene = scene_of(passes=["Combined", "AOV Color 01"])
    material = scene.materials[0]
    place = material.add_operation(basicrt.SurfaceOperation(value="position"))
    material.add(AovShader(color=place))
    scene.materials[0] = material
    color = basicrt.render(scene)["AOV Color 01"]
    np.testing.assert_allclose(color[0, 2:, 0], [0.25, 0.75], atol=0.05)


def test_they_survive_a_file(tmp_path: Path) -> None:
    scene = scene_of(AovShader(number=3, value=2), passes=["Combined", "AOV Value 03"])
    path = tmp_path / "scene.json"
    scene.save(path)
    assert basicrt.render(basicrt.load_scene(path))["AOV Value 03"].max() == 2


@pytest.mark.parametrize("number", [0, 17])
def test_other_numbers_are_refused(number: int) -> None:
    with pytest.raises(SceneError, match=r"AovShader.number: must be in \[1, 16\], is "):
        AovShader(number=number)
