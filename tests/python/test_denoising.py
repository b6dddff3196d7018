# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising by Open Image Denoise: less error, the same alpha, and clear words where it can't be done."""

import functools
import importlib.util
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import basicrt
from basicrt.compare import relmse
from basicrt.denoising import DENOISING_PASSES
from support.scenes import still_life

needs_denoiser = pytest.mark.skipif(
    importlib.util.find_spec("pyoidn") is None,
    reason="pyoidn is not installed: pip install basicrt[denoise]",
)
SIZE = (120, 90)


def matte_scene(samples: int) -> basicrt.Scene:
    """Soft shadows on a checkered floor and balls: noise that a reference of few samples has not."""
    scene = still_life(SIZE, samples)
    scene.instances[1] = basicrt.Instance(shape=1, transform=np.eye(4), materials=[2])
    scene.lights[0] = basicrt.PointLight((2, -2, 4), (30, 30, 30), radius=1.5)
    return scene


@functools.cache
def pictures_of(samples: int) -> dict[str, Any]:
    scene = matte_scene(samples)
    scene.settings.passes = ["Combined", *DENOISING_PASSES]
    scene.settings.film_transparent = True
    return basicrt.render(scene)


def error_of(picture: Any) -> float:
    return relmse(picture[..., :3], pictures_of(512)["Combined"][..., :3])


@needs_denoiser
def test_it_takes_most_of_the_error_away() -> None:
    noisy = pictures_of(4)
    before = error_of(noisy["Combined"])
    by_color = error_of(basicrt.denoise({"Combined": noisy["Combined"]}))
    by_passes = error_of(basicrt.denoise(noisy))
    print(f"relMSE {before:.5f}, by colour {by_color:.5f}, with albedo and normal {by_passes:.5f}")
    assert by_color < before / 2
    assert by_passes < by_color


@needs_denoiser
@pytest.mark.parametrize("prefilter", ["accurate", "fast", "none"])
@pytest.mark.parametrize("quality", ["high", "balanced", "fast"])
def test_every_choice_denoises(prefilter: str, quality: str) -> None:
    noisy = pictures_of(4)
    picture = basicrt.denoise(noisy, prefilter=prefilter, quality=quality)
    assert error_of(picture) < error_of(noisy["Combined"]) / 2


@needs_denoiser
def test_prefilters_differ() -> None:
    made = {
        basicrt.denoise(pictures_of(4), prefilter=prefilter).tobytes()
        for prefilter in ("accurate", "fast", "none")
    }
    assert len(made) == 3


@needs_denoiser
def test_alpha_and_the_input_stay() -> None:
    noisy = {name: picture.copy() for name, picture in pictures_of(4).items()}
    picture = basicrt.denoise(noisy)
    assert picture.shape == (SIZE[1], SIZE[0], 4)
    assert picture.dtype == np.float32
    np.testing.assert_array_equal(picture[..., 3], noisy["Combined"][..., 3])
    for name, values in noisy.items():
        np.testing.assert_array_equal(values, pictures_of(4)[name])


@needs_denoiser
def test_the_picture_does_not_depend_on_threads() -> None:
    assert len({basicrt.denoise(pictures_of(4), threads=n).tobytes() for n in (0, 1, 2, 3)}) == 1


@needs_denoiser
def test_bright_light_keeps_its_energy() -> None:
    """High dynamic range: nothing is clipped at white."""
    bright = {name: picture.copy() for name, picture in pictures_of(64).items()}
    bright["Combined"][..., :3] *= 1000
    np.testing.assert_allclose(
        basicrt.denoise(bright)[..., :3].mean(), bright["Combined"][..., :3].mean(), rtol=0.02
    )


@needs_denoiser
def test_what_is_not_a_number_does_not_spread() -> None:
    noisy = {name: picture.copy() for name, picture in pictures_of(4).items()}
    noisy["Combined"][40, 60, 1] = np.nan
    picture = basicrt.denoise(noisy)
    assert np.isfinite(picture).all()
    assert error_of(picture) < error_of(pictures_of(4)["Combined"])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"prefilter": "often"}, 'prefilter: must be one of accurate, fast, none, is "often"'),
        ({"quality": ""}, 'quality: must be one of high, balanced, fast, is ""'),
        ({"threads": -1}, "threads: must be at least 0, is -1"),
    ],
)
def test_bad_options_are_named(change: dict[str, Any], message: str) -> None:
    with pytest.raises(basicrt.SceneError, match=f"^{message}$"):
        basicrt.denoise({"Combined": np.ones((4, 4, 4), np.float32)}, **change)


@pytest.mark.parametrize(
    ("shapes", "message"),
    [
        ({}, "denoise: there is no picture Combined"),
        ({"Combined": (4, 3)}, r"Combined: must have the shape \(4, 3, 4\), is \(4, 3\)"),
        ({"Combined": (4, 3, 3)}, r"Combined: must have the shape \(4, 3, 4\), is \(4, 3, 3\)"),
        (
            {"Combined": (4, 3, 4), "Denoising Albedo": (3, 4, 3)},
            r"Denoising Albedo: must have the shape \(4, 3, 3\), is \(3, 4, 3\)",
        ),
        (
            {"Combined": (4, 3, 4), "Denoising Albedo": (4, 3, 3), "Denoising Normal": (4, 3, 4)},
            r"Denoising Normal: must have the shape \(4, 3, 3\), is \(4, 3, 4\)",
        ),
    ],
)
def test_bad_pictures_are_named(shapes: dict[str, tuple[int, ...]], message: str) -> None:
    pictures = {name: np.ones(shape, np.float32) for name, shape in shapes.items()}
    with pytest.raises(basicrt.SceneError, match=f"^{message}$"):
        basicrt.denoise(pictures)


def test_an_absent_denoiser_is_named_with_what_to_do(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyoidn", None)
    with pytest.raises(basicrt.DenoiserError, match="install it with `pip install pyoidn`"):
        basicrt.denoise({"Combined": np.ones((4, 4, 4), np.float32)})
    with pytest.raises(basicrt.DenoiserError, match="install it with `apt install it`"):
        basicrt.check_denoiser("`apt install it`")


# ---- basicrt render --denoise --------------------------------------------------------------------


def run(*arguments: object, without: str = "") -> subprocess.CompletedProcess[str]:
    code = f"import sys; sys.modules['{without}'] = None\n" if without else "import sys\n"
    code += "import basicrt.cli; sys.exit(basicrt.cli.main(sys.argv[1:]))"
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.fixture
def scene_path(tmp_path: Path) -> Path:
    scene = still_life()
    scene.settings.border_x, scene.settings.border_width, scene.settings.border_height = 8, 32, 20
    path = tmp_path / "scene.json"
    scene.save(path)
    return path


@needs_denoiser
def test_the_command_line_keeps_the_noisy_picture(scene_path: Path) -> None:
    out, noisy_out = scene_path.with_name("out.exr"), scene_path.with_name("noisy.exr")
    done = run("render", scene_path, "-o", out, "--denoise")
    assert done.returncode == 0, done.stderr
    assert run("render", scene_path, "-o", noisy_out).returncode == 0
    pictures, noisy = basicrt.read_exr(out), basicrt.read_exr(noisy_out)
    assert pictures.keys() == {*noisy, "Noisy Image"}
    for name, picture in noisy.items():
        same = "Noisy Image" if name == "Combined" else name
        np.testing.assert_array_equal(pictures[same], picture, err_msg=name)
    difference = pictures["Combined"] - noisy["Combined"]
    assert np.abs(difference[:20, 8:40]).max() > 0
    assert not difference[20:].any(), "outside of the border"
    assert not difference[:, :8].any()
    assert not difference[:, 40:].any()


@needs_denoiser
def test_the_command_line_denoises_a_png(scene_path: Path) -> None:
    assert run("render", scene_path, "-o", scene_path.with_name("a.png")).returncode == 0
    done = run("render", scene_path, "-o", scene_path.with_name("b.png"), "--denoise")
    assert done.returncode == 0, done.stderr
    a, b = (scene_path.with_name(name).read_bytes() for name in ("a.png", "b.png"))
    assert b.startswith(b"\x89PNG")
    assert a != b


def test_the_command_line_fails_before_it_renders_without_a_denoiser(scene_path: Path) -> None:
    out = scene_path.with_name("out.exr")
    done = run("render", scene_path, "-o", out, "--denoise", without="pyoidn")
    assert done.returncode == 1
    assert done.stderr.startswith("basicrt: denoising needs Intel Open Image Denoise: install it")
    assert done.stderr.count("\n") == 1
    assert not out.exists()


@needs_denoiser
def test_a_range_of_the_samples_is_not_denoised(scene_path: Path) -> None:
    out = scene_path.with_name("out.exr")
    done = run("render", scene_path, "-o", out, "--denoise", "--spp", 128, "--samples-to", 64)
    assert done.returncode == 1
    assert "--denoise: not of a range of the samples" in done.stderr
