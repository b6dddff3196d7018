# SPDX-License-Identifier: GPL-3.0-or-later
"""load_scene: what Python adds to the native reader, and that its errors and warnings arrive."""

import json
from pathlib import Path

import numpy as np
import pytest

import basicrt
from basicrt import SceneError
from support.scenes import still_life

SCENE = {
    "integrator": {"type": "path", "spp": 3},
    "film": {"resolution": [8, 6]},
    "camera": {
        "position": [0, 0, 5],
        "look_at": [0, 0, 0],
        "ref_up": [0, 1, 0],
        "fov": 40,
        "focal_length": 1,
    },
    "textures": {"paint": {"type": "constant", "color": [0.5, 0.25, 0.125]}},
    "materials": {"paint": {"type": "diffuse", "texture_name": "paint"}},
    "objects": [{"type": "sphere", "material_name": "paint"}],
}


@pytest.fixture
def scene_path(tmp_path):
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(SCENE))
    return path


def test_a_file_becomes_a_scene(scene_path) -> None:
    scene = basicrt.load_scene(scene_path)
    settings = scene.settings
    assert (settings.width, settings.height, settings.samples) == (8, 6, 3)
    assert [type(shape) for shape in scene.shapes] == [basicrt.Sphere]
    assert isinstance(scene.camera, basicrt.PerspectiveCamera)
    assert basicrt.load_scene(str(scene_path)).to_json() == scene.to_json()


@pytest.mark.parametrize("as_text", [False, True])
def test_an_override_is_merged_into_the_file(scene_path, as_text: bool) -> None:
    override = {"integrator": {"spp": 7}, "film": {"resolution": [4, 2]}}
    scene = basicrt.load_scene(scene_path, override=json.dumps(override) if as_text else override)
    assert (scene.settings.width, scene.settings.height, scene.settings.samples) == (4, 2, 7)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"film": {', r"scene\.json:1:11: "),
        ('{\n"film": {"resolution": [1, 2}}', r"scene\.json:2:29: "),
        (json.dumps({**SCENE, "objcts": []}), 'objcts: .*"objects"'),
        (json.dumps({**SCENE, "materials": {"paint": {"type": "difuse"}}}), '"difuse".*"diffuse"'),
        (json.dumps({**SCENE, "film": {"resolution": [0, 2]}}), "resolution|width"),
        (
            json.dumps({**SCENE, "objects": [{"type": "mesh", "path": "no.obj"}]}),
            "no.obj",
        ),
    ],
)
def test_bad_files_are_scene_errors(scene_path, text: str, message: str) -> None:
    scene_path.write_text(text)
    with pytest.raises(SceneError, match=message) as caught:
        basicrt.render(basicrt.load_scene(scene_path))
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_named(tmp_path) -> None:
    with pytest.raises(SceneError, match=r"no\.json"):
        basicrt.load_scene(tmp_path / "no.json")
    with pytest.raises(TypeError, match="path must be"):
        basicrt.load_scene(3)  # type: ignore[arg-type]


def test_a_bad_override_is_named(scene_path) -> None:
    with pytest.raises(SceneError, match="override:1:2: "):
        basicrt.load_scene(scene_path, override="{")


def with_image(path, name: str) -> None:
    textures = {"paint": {"type": "image", "path": name}}
    path.write_text(json.dumps({**SCENE, "textures": textures}))


def test_exr_textures_are_read_by_python(scene_path) -> None:
    pixels = np.random.default_rng(4).random((3, 5, 4)).astype(np.float32)
    basicrt.write_exr(scene_path.parent / "paint.exr", {"Combined": pixels})
    with_image(scene_path, "paint.exr")
    (texture,) = basicrt.load_scene(scene_path).textures
    assert isinstance(texture, basicrt.ImageTexture)
    assert np.array_equal(texture.image.pixels[..., :3], pixels[..., :3])


def test_png_textures_are_srgb(scene_path) -> None:
    basicrt.write_png(scene_path.parent / "paint.png", np.full((2, 2, 3), 0.21586))
    with_image(scene_path, "paint.png")
    (texture,) = basicrt.load_scene(scene_path).textures
    assert isinstance(texture, basicrt.ImageTexture)
    assert np.allclose(texture.image.pixels[..., :3], 0.21586, atol=1e-5)  # the byte 128


@pytest.mark.parametrize("name", ["paint.exr", "paint.png"])
def test_a_missing_or_broken_texture_is_an_error(scene_path, name: str) -> None:
    with_image(scene_path, name)
    with pytest.raises((SceneError, OSError), match=name):
        basicrt.load_scene(scene_path)
    (scene_path.parent / name).write_text("no picture")
    with pytest.raises(SceneError, match=name):
        basicrt.load_scene(scene_path)


def test_warnings_point_at_the_caller(scene_path) -> None:
    # An integrator that we do not have is rendered with path, and said so.
    scene_path.write_text(json.dumps({**SCENE, "integrator": {"type": "bdpt", "spp": 1}}))
    with pytest.warns(basicrt.SceneWarning, match="bdpt") as caught:
        scene = basicrt.load_scene(scene_path)
    assert scene.settings.integrator == "path"
    assert caught[0].filename == __file__


def test_light_groups_survive_a_file(tmp_path: Path) -> None:
    scene = still_life()
    lamp = scene.lights[0]
    lamp.light_group = 16
    scene.lights[0] = lamp
    instance = scene.instances[1]
    instance.light_group = 2
    scene.instances[1] = instance
    scene.environment.light_group = 3
    scene.settings.passes = ["Combined", "Light Group 03", "Light Group 16"]
    scene.save(tmp_path / "scene.json")
    loaded = basicrt.load_scene(tmp_path / "scene.json")
    assert loaded.lights[0].light_group == 16
    assert [one.light_group for one in loaded.instances] == [0, 2, 0]
    assert loaded.environment.light_group == 3
    assert loaded.settings.passes == scene.settings.passes
    pictures = basicrt.render(loaded)
    total = pictures["Light Group 03"] + pictures["Light Group 16"]
    np.testing.assert_allclose(total, pictures["Combined"][..., :3], rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("group", [-1, 17])
def test_there_are_sixteen_light_groups(tmp_path: Path, group: int) -> None:
    scene = still_life()
    scene.save(tmp_path / "scene.json")
    override = json.dumps({"environment": {"light_group": group}})
    with pytest.raises(basicrt.SceneError, match=rf"environment.light_group: .*{group}"):
        basicrt.render(basicrt.load_scene(tmp_path / "scene.json", override=override))
