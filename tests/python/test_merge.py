# SPDX-License-Identifier: GPL-3.0-or-later
"""Ranges of a picture's samples, rendered apart and merged: the bytes of one render."""

import os
import subprocess
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import pytest

import basicrt
from support.scenes import still_life

BUILD = Path(os.environ.get("BASICRT_BUILD_DIR", Path(__file__).parents[2] / "build"))


def run(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "basicrt", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.fixture
def scene_path(tmp_path: Path) -> Path:
    scene = still_life()
    scene.settings.samples = 200
    scene.settings.filter_type, scene.settings.filter_radius = "mitchell", 2.0  # has negative lobes
    scene.settings.passes = ["Combined", "Depth", "Normal", "Diffuse Direct", "Debug Sample Count"]
    path = tmp_path / "scene.json"
    scene.save(path)
    return path


def render_range(scene: Path, begin: int, end: int, *options: object) -> Path:
    out = scene.with_name(f"part_{begin}.exr")
    done = run(
        "render", scene, "-o", out, "-q", "--samples-from", begin, "--samples-to", end, *options
    )
    assert done.returncode == 0, done.stderr
    return out


@pytest.mark.parametrize("ends", [[0, 64, 200], [0, 128, 192, 200], [0, 64, 128, 200], [0, 200]])
def test_merged_ranges_are_the_whole_file(scene_path: Path, ends: Sequence[int]) -> None:
    whole, merged = scene_path.with_name("whole.exr"), scene_path.with_name("merged.exr")
    assert run("render", scene_path, "-o", whole, "-q").returncode == 0
    parts = [
        render_range(scene_path, begin, end, "--threads", 1 + index)
        for index, (begin, end) in enumerate(pairwise(ends))
    ]
    done = run("merge", *reversed(parts), "-o", merged)
    assert done.returncode == 0, done.stderr
    assert merged.read_bytes() == whole.read_bytes()


def test_some_ranges_are_a_range(scene_path: Path) -> None:
    parts = [
        render_range(scene_path, begin, end) for begin, end in ((0, 64), (64, 128), (128, 200))
    ]
    some, merged = scene_path.with_name("some.exr"), scene_path.with_name("merged.exr")
    basicrt.merge(parts[1:], some)
    basicrt.merge([some, parts[0]], merged)
    whole = basicrt.render(basicrt.load_scene(scene_path))
    for name, picture in basicrt.read_exr(merged).items():
        assert picture.tobytes() == whole[name].tobytes(), name


def test_the_border_is_all_that_is_merged(scene_path: Path) -> None:
    override = (
        '{"settings": {"border_x": 3, "border_y": 5, "border_width": 20, "border_height": 11}}'
    )
    whole, merged = scene_path.with_name("whole.exr"), scene_path.with_name("merged.exr")
    assert run("render", scene_path, "-o", whole, "-q", "--override", override).returncode == 0
    parts = [
        render_range(scene_path, begin, end, "--override", override)
        for begin, end in ((0, 128), (128, 200))
    ]
    assert run("merge", *parts, "-o", merged).returncode == 0
    assert merged.read_bytes() == whole.read_bytes()


@pytest.mark.skipif(not (BUILD / "renderer").exists(), reason="there is no renderer")
def test_the_renderers_files_merge(scene_path: Path) -> None:
    parts = []
    for begin, end in ((0, 64), (64, 200)):
        parts.append(scene_path.with_name(f"part_{begin}.exr"))
        options = ["--samples-from", str(begin), "--samples-to", str(end), "-q"]
        command = [str(BUILD / "renderer"), str(scene_path), "-o", str(parts[-1]), *options]
        subprocess.run(command, check=True)
    merged = scene_path.with_name("merged.exr")
    basicrt.merge(parts, merged)
    whole = basicrt.render(basicrt.load_scene(scene_path))
    for name, picture in basicrt.read_exr(merged).items():
        assert picture.tobytes() == whole[name].tobytes(), name


@pytest.mark.parametrize(
    ("second", "message"),
    [
        ((64, 200), "has samples 64 to 128, which"),
        ((192, 200), "samples 128 to 192 are in no file"),
        ((128, 200, "--seed", 5), "is of another scene or other settings than"),
        ((128, 180, "--spp", 180), "is of another scene or other settings than"),
    ],
)
def test_what_does_not_fit_is_refused(
    scene_path: Path, second: Sequence[int], message: str
) -> None:
    parts = [render_range(scene_path, 0, 128), render_range(scene_path, *second)]
    out = scene_path.with_name("merged.exr")
    done = run("merge", *parts, "-o", out)
    assert done.returncode == 1
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert not out.exists()


def test_a_whole_picture_is_no_range(scene_path: Path) -> None:
    out = scene_path.with_name("whole.exr")
    assert run("render", scene_path, "-o", out, "-q").returncode == 0
    with pytest.raises(basicrt.SceneError, match="has all samples of its picture"):
        basicrt.merge([out], scene_path.with_name("merged.exr"))


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"samples_from": 8}, "samples_from: must be a multiple of 64, is 8"),
        ({"samples_to": 40}, "samples_to: must be a multiple of 64, is 40, or all 200"),
        ({"samples_from": 128, "samples_to": 64}, "must be above samples_from"),
        ({"samples_to": 256}, "at most 200, is 256"),
        ({"samples_to": 64, "samples": 64}, "needs more than 64"),
        ({"samples_to": 64, "adaptive_threshold": 0.1}, "sampling can't be adaptive"),
        ({"samples_to": 64, "time_limit": 1.0}, "no time limit"),
        ({"samples_to": 64, "passes": ["Combined", "CryptoObject00"]}, "no Cryptomatte"),
    ],
)
def test_ranges_have_rules(scene_path: Path, values: dict[str, object], message: str) -> None:
    scene = basicrt.load_scene(scene_path)
    for name, value in values.items():
        setattr(scene.settings, name, value)
    with pytest.raises(basicrt.SceneError, match=message):
        scene.validate()
