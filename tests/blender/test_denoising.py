# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising of final renders: the passes, the error, and what is said where there is no denoiser."""

import importlib.util
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.engine import denoise
from addon.engine.final import BasicRTRenderEngine
from addon.export import denoising
from addon.report import shown_warnings

import basicrt
from basicrt.compare import relmse
from support.blender import (
    add_camera,
    add_lamp,
    add_plane,
    new_material,
    new_scene,
    render,
    render_passes,
    set_world,
)

needs_denoiser = pytest.mark.skipif(
    importlib.util.find_spec("pyoidn") is None,
    reason="pyoidn is not installed: pip install basicrt[denoise]",
)
NOISY, COMBINED = "ViewLayer.Noisy Image", "ViewLayer.Combined"


def noisy_scene(samples: int = 4, size: tuple[int, int] = (96, 64)) -> Any:
    """Balls in the soft shadow of a wide lamp, before nothing."""
    scene = new_scene(*size, samples)
    add_plane(4, 0, new_material("ShaderNodeBsdfDiffuse", "Floor", Color=(0.6, 0.5, 0.4)))
    for index, color in enumerate([(0.8, 0.2, 0.2), (0.2, 0.8, 0.2), (0.2, 0.2, 0.8)]):
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, location=(1.2 * index - 1.2, 0, 0.5))
        bpy.context.object.data.materials.append(
            new_material("ShaderNodeBsdfDiffuse", f"Ball {index}", Color=color)
        )
    add_lamp("AREA", (1, -2, 3), (0.4, 0.2, 0), energy=120, size=3)
    set_world((0.2, 0.25, 0.3))
    add_camera((0, -7, 3), (1.2, 0, 0), kind="PERSP", lens=50)
    scene.render.film_transparent = True
    return scene


@pytest.fixture(scope="module")
def pictures(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, np.ndarray]]:
    """Passes of the same scene: noisy, denoised, and of many samples."""
    folder = tmp_path_factory.mktemp("denoising")
    scene = noisy_scene()
    bpy.context.view_layer.use_pass_z = True
    made = {"noisy": render_passes(folder)}
    scene.basicrt.use_denoising = True
    made["denoised"] = render_passes(folder)
    scene.basicrt.use_denoising, scene.basicrt.samples = False, 1024
    made["reference"] = render_passes(folder)
    return made


@needs_denoiser
def test_most_of_the_error_is_gone(pictures: Any) -> None:
    noisy, denoised, reference = (pictures[kind][COMBINED][..., :3] for kind in pictures)
    before, after = relmse(noisy, reference), relmse(denoised, reference)
    print(f"relMSE {before:.5f}, denoised {after:.5f}")
    assert after < before / 4


@needs_denoiser
def test_the_noisy_picture_and_every_other_pass_stay(pictures: Any) -> None:
    noisy, denoised = pictures["noisy"], pictures["denoised"]
    assert denoised.keys() == {*noisy, NOISY}
    np.testing.assert_array_equal(denoised[NOISY], noisy[COMBINED])
    np.testing.assert_array_equal(denoised["ViewLayer.Depth"], noisy["ViewLayer.Depth"])
    np.testing.assert_array_equal(denoised[COMBINED][..., 3], noisy[COMBINED][..., 3])


@needs_denoiser
def test_the_picture_does_not_depend_on_threads_or_tiles(tmp_path: Path) -> None:
    scene = noisy_scene(2)
    scene.basicrt.use_denoising = True
    made = set()
    for threads, tile_size in ((1, 64), (2, 16), (3, 40)):
        scene.render.threads, scene.basicrt.tile_size = threads, tile_size
        made.add(render(tmp_path).tobytes())
    assert len(made) == 1


@needs_denoiser
@pytest.mark.parametrize("is_cropped", [False, True])
def test_a_border_is_denoised_alone(tmp_path: Path, is_cropped: bool) -> None:
    scene = noisy_scene(2)
    b_render = scene.render
    b_render.use_border, b_render.use_crop_to_border = True, is_cropped
    b_render.border_min_x, b_render.border_max_x = 0.25, 0.75
    b_render.border_min_y, b_render.border_max_y = 0.25, 0.75
    noisy = render(tmp_path)
    scene.basicrt.use_denoising = True
    passes = render_passes(tmp_path)
    difference = np.abs(passes[COMBINED] - noisy)
    assert (difference.shape[:2] == (32, 48)) is is_cropped
    if not is_cropped:
        assert difference[16:48, 24:72].max() > 0
        difference[16:48, 24:72] = 0
        assert not difference.any()


@needs_denoiser
def test_every_view_layer_is_denoised(tmp_path: Path) -> None:
    scene = noisy_scene(2)
    scene.view_layers.new("Second")
    scene.view_layers["Second"].cycles.use_denoising = False
    scene.view_layers.new("Third")
    scene.basicrt.use_denoising = True
    passes = render_passes(tmp_path)
    assert "Second.Noisy Image" not in passes
    np.testing.assert_array_equal(passes["Second.Combined"], passes[NOISY])
    np.testing.assert_array_equal(passes["Third.Combined"], passes[COMBINED])
    assert np.abs(passes["Third.Combined"] - passes[NOISY]).max() > 0


@needs_denoiser
def test_a_cancelled_render_stays_noisy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = noisy_scene(1 << 16)
    scene.basicrt.use_denoising = True
    monkeypatch.setattr(denoise.LayerDenoiser, "finish", lambda *_: pytest.fail("it was denoised"))
    monkeypatch.setattr(BasicRTRenderEngine, "_is_cancelled", lambda _: True)
    render(tmp_path)


def test_without_a_denoiser_there_is_one_warning_and_the_noisy_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    scene = noisy_scene(2, (16, 16))
    scene.view_layers.new("Second")
    noisy = render(tmp_path)
    monkeypatch.setitem(sys.modules, "pyoidn", None)
    scene.cycles.use_denoising = True  # a file that was made for Cycles
    passes = render_passes(tmp_path)
    np.testing.assert_array_equal(passes[COMBINED], noisy)
    np.testing.assert_array_equal(passes[NOISY], noisy)
    (warning,) = shown_warnings()
    assert [record.message for record in caplog.records] == [warning]
    assert warning.startswith(
        f'scene "{scene.name}": denoising needs Intel Open Image Denoise: install it with `'
    )
    assert warning.endswith("the picture stays noisy")


@needs_denoiser
def test_a_denoiser_that_fails_leaves_the_noisy_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = noisy_scene(2, (16, 16))
    noisy = render(tmp_path)
    scene.basicrt.use_denoising = True

    def fail(*_: Any) -> None:
        raise basicrt.DenoiserError("out of order")

    monkeypatch.setattr(denoise.LayerDenoiser, "finish", fail)
    np.testing.assert_array_equal(render(tmp_path), noisy)
    assert shown_warnings() == (f'scene "{scene.name}": out of order; the picture stays noisy',)


def test_settings_say_how() -> None:
    scene = new_scene()
    layer = bpy.context.view_layer
    assert denoising.convert(scene, layer) is None
    scene.basicrt.use_denoising = True
    albedo, normal = "Denoising Albedo", "Denoising Normal"
    assert denoising.convert(scene, layer) == denoising.Denoising(
        (albedo, normal), "accurate", "high"
    )
    scene.cycles.denoising_input_passes = "RGB_ALBEDO"
    scene.cycles.denoising_prefilter, scene.cycles.denoising_quality = "FAST", "BALANCED"
    assert denoising.convert(scene, layer) == denoising.Denoising((albedo,), "fast", "balanced")
    scene.basicrt.denoising_input_passes = "RGB"
    scene.basicrt.denoising_prefilter, scene.basicrt.denoising_quality = "NONE", "FAST"
    assert denoising.convert(scene, layer) == denoising.Denoising((), "none", "fast")


@needs_denoiser
def test_passes_that_are_only_stored_are_not_shown_to_the_denoiser(tmp_path: Path) -> None:
    scene = noisy_scene(2)
    scene.basicrt.use_denoising, scene.basicrt.denoising_input_passes = True, "RGB"
    bare = render(tmp_path)
    bpy.context.view_layer.cycles.denoising_store_passes = True
    np.testing.assert_array_equal(render(tmp_path), bare)
    scene.basicrt.denoising_input_passes = "RGB_ALBEDO_NORMAL"
    assert np.abs(render(tmp_path) - bare).max() > 0
