# SPDX-License-Identifier: GPL-3.0-or-later
"""`basicrt render scene.blend`: its options count before what the file says."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np
import pytest

import basicrt
from support.blender import add_camera, add_lamp, add_plane, new_scene

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("basicrt.blender_addon") is None,
    reason="this basicrt carries no add-on",
)


@pytest.fixture
def blend(tmp_path: Path) -> Path:
    """A soft shadow's noise; the view layer has samples of its own."""
    new_scene(24, 16, 3)
    bpy.context.view_layer.samples = 2
    add_plane(1.5)
    add_plane(0.4, z=0.5)
    add_lamp("AREA", (0.5, 0, 2), size=1)
    add_camera(ortho_scale=1)
    path = tmp_path / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def render(blend: Path, *options: object) -> np.ndarray:
    out = blend.with_name("out.exr")
    command = [sys.executable, "-m", "basicrt", "render", blend, "-o", out, *options]
    done = subprocess.run(
        [str(part) for part in command], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return basicrt.read_exr(out)["Combined"]


def error(picture: np.ndarray, reference: np.ndarray) -> float:
    return float(np.square(picture[..., :3] - reference[..., :3]).mean())


def test_samples_and_seed_are_those_of_the_options(blend: Path) -> None:
    own = render(blend)
    np.testing.assert_array_equal(render(blend, "--spp", 2, "--threads", 1), own)
    many = render(blend, "--spp", 512)
    assert error(render(blend, "--spp", 32), many) < error(own, many) / 4
    assert error(render(blend, "--seed", 7), own) > 0


def test_ranges_add_up(blend: Path) -> None:
    parts = [
        render(blend, "--spp", 128, "--samples-from", first, "--samples-to", first + 64)
        for first in (0, 64)
    ]
    whole = render(blend, "--spp", 128)
    np.testing.assert_allclose((parts[0] + parts[1]) / 2, whole, rtol=1e-5, atol=1e-6)


@pytest.mark.skipif(
    importlib.util.find_spec("pyoidn") is None,
    reason="pyoidn is not installed: pip install basicrt[denoise]",
)
def test_it_denoises(blend: Path) -> None:
    many = render(blend, "--spp", 512)
    assert error(render(blend, "--denoise"), many) < error(render(blend), many) / 2
