# SPDX-License-Identifier: GPL-3.0-or-later
"""Point clouds and curves from Python: arrays in and out, errors, files, pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import basicrt

POINTS = np.array([[-0.6, 0, 0], [0, 0.3, 0], [0.7, -0.2, 0.1], [0, -0.7, 0]], np.float32)
RADII = np.array([0.3, 0.2, 0.35, 0.1], np.float32)


def curves(**more: Any) -> basicrt.Curves:
    points = [[-1, -1, 0], [0, 0.5, 0], [1, -1, 0], [-1, 0.8, 0], [1, 0.9, 0.2]]
    return basicrt.Curves(points, [0.2, 0.1, 0.05, 0.1, 0.1], [0, 3], **more)


def scene_of(*shapes: Any) -> basicrt.Scene:
    scene = basicrt.Scene()
    for shape in shapes:
        index = scene.shapes.append(shape)
        scene.instances.append(basicrt.Instance(shape=index))
    scene.lights.append(basicrt.SunLight(direction=(0.3, -0.5, -1), irradiance=(3, 3, 3)))
    scene.environment = basicrt.Environment(radiance=(0.2, 0.3, 0.4))
    scene.camera = basicrt.PerspectiveCamera(
        transform=[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4], [0, 0, 0, 1]]
    )
    scene.settings = basicrt.RenderSettings(width=48, height=40, samples=8)
    return scene


def test_arrays_are_kept() -> None:
    cloud = basicrt.PointCloud(POINTS, RADII, randoms=[0, 0.25, 0.5, 1])
    np.testing.assert_array_equal(cloud.positions, POINTS)
    np.testing.assert_array_equal(cloud.radii, RADII)
    np.testing.assert_array_equal(cloud.randoms, np.array([0, 0.25, 0.5, 1], np.float32))
    values = np.arange(15, dtype=np.float32).reshape(5, 3)
    hair = curves(form="ribbon", uvs=[[0, 1], [2, 3]], attributes=[("dye", "vertex", values)])
    assert (hair.form, list(hair.firsts)) == ("ribbon", [0, 3])
    assert hair.randoms is None
    assert hair.uvs is not None
    np.testing.assert_array_equal(hair.uvs, [[0, 1], [2, 3]])
    name, domain, kept = hair.attributes[0]
    assert (name, domain) == ("dye", "vertex")
    np.testing.assert_array_equal(kept, values)
    np.testing.assert_array_equal(basicrt.PointCloud(POINTS, 0.5).radii, [0.5] * 4)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: basicrt.PointCloud(POINTS, [1, 2]), r"radii.*4"),
        (lambda: basicrt.PointCloud(POINTS, [1, 1, -1, 1]), r"radii\[2\].*at least 0.*-1"),
        (lambda: basicrt.PointCloud([[np.nan, 0, 0]], 1), r"positions.*finite"),
        (lambda: basicrt.Curves(POINTS, 1, [0, 9]), r"firsts\[1\].*point 9.*there are 4"),
        (lambda: basicrt.Curves(POINTS, 1, [1]), r"firsts\[0\].*must be 0, is 1"),
        (lambda: basicrt.Curves(POINTS, 1, [0, 2, 2]), r"firsts\[2\].*greater.*2 after 2"),
        (lambda: basicrt.Curves(POINTS, 1, []), r"firsts.*empty"),
        (lambda: basicrt.Curves(POINTS, 1, [0], form="flat"), r"form.*flat"),
        (lambda: basicrt.Curves(POINTS, 1, [0], uvs=[[0, 0], [1, 1]]), r"uvs"),
        (lambda: curves(attributes=[("a", "corner", [[0, 0, 0]])]), r'"a".*corner'),
        (lambda: curves(attributes=[("a", "face", [[0, 0, 0]])]), r'"a".*2.*has 1'),
    ],
)
def test_bad_arrays_are_told(make: Any, message: str) -> None:
    with pytest.raises(basicrt.SceneError, match=message):
        make()


def test_files_keep_them(tmp_path: Path) -> None:
    values = np.arange(6, dtype=np.float32).reshape(2, 3)
    hair = curves(
        form="ribbon",
        randoms=[0.1, 0.2],
        intercepts=[0, 0.4, 1, 0, 1],
        attributes=[("dye", "face", values)],
    )
    scene = scene_of(hair, basicrt.PointCloud(POINTS, RADII, randoms=[0, 0.1, 0.2, 0.3]))
    first, second = tmp_path / "first.json", tmp_path / "second.json"
    scene.save(first)
    loaded = basicrt.load_scene(first)
    loaded.save(second)
    assert first.read_text() == second.read_text()
    np.testing.assert_array_equal(
        basicrt.render(loaded)["Combined"], basicrt.render(scene)["Combined"]
    )


def test_a_cloud_looks_like_its_spheres() -> None:
    together = basicrt.render(scene_of(basicrt.PointCloud(POINTS, RADII)))["Combined"]
    spheres = [
        basicrt.Sphere(center=point.tolist(), radius=float(radius))
        for point, radius in zip(POINTS, RADII, strict=True)
    ]
    alone = basicrt.render(scene_of(*spheres))["Combined"]
    np.testing.assert_array_equal(together, alone)


@pytest.mark.parametrize("form", ["round", "ribbon"])
def test_pictures_do_not_depend_on_threads_or_tiles(form: str) -> None:
    scene = scene_of(curves(form=form), basicrt.PointCloud(POINTS, RADII))
    first = basicrt.render(scene, threads=1)["Combined"]
    np.testing.assert_array_equal(basicrt.render(scene, threads=3, tile_size=16)["Combined"], first)
    assert first[..., :3].std() > 0.1


def test_those_that_shine_light_others() -> None:
    """A white sphere in a shell of shining points sees their radiance all around."""
    scene = scene_of(basicrt.Sphere(radius=0.3))
    scene.lights.clear()
    scene.environment = basicrt.Environment()
    material = basicrt.Material("light")
    material.surface = material.add(basicrt.EmissionShader(radiance=(1, 1, 1), twosided=True))
    index = scene.materials.append(material)
    shape = scene.shapes.append(basicrt.PointCloud([[0, 0, 0]], 10.0))
    scene.instances.append(basicrt.Instance(shape=shape, materials=[index]))
    picture = basicrt.render(scene)["Combined"]
    assert picture[20, 24, 0] == pytest.approx(0.8, abs=0.02)  # the default material's reflectance
