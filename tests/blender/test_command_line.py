# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings behind `--` in Blender's command line: what counts, what stays, and what is refused."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.engine.command_line import Overrides, parse
from addon.report import ExportError

import basicrt
from support.blender import (
    add_lamp,
    export_in_render,
    render,
)

BLENDER = ["blender", "-b", "scene.blend", "-E", "BASICRT", "-f", "1"]


def give(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> None:
    monkeypatch.setattr(sys, "argv", [*BLENDER, *arguments])


def test_every_flag_is_read() -> None:
    given = [
        *BLENDER,
        "--",
        "--basicrt-samples",
        "64",
        "--basicrt-threads=2",
        "--basicrt-seed",
        "7",
    ]
    assert parse(given) == Overrides(samples=64, threads=2, seed=7)
    assert parse(["--", "--basicrt-strict"]) == Overrides(fails_on_warnings=True)
    given = ["--", "--basicrt-samples-from", "64", "--basicrt-samples-to", "128"]
    assert parse(given) == Overrides(samples_from=64, samples_to=128)


@pytest.mark.parametrize(
    "arguments",
    [
        BLENDER,
        [*BLENDER, "--"],
        [*BLENDER, "--basicrt-samples", "64"],  # before `--` arguments are Blender's
        [*BLENDER, "--", "--cycles-device", "CPU", "file.txt", "-x"],
    ],
)
def test_what_is_not_ours_is_left_alone(arguments: Sequence[str]) -> None:
    assert parse(arguments) == Overrides()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ["--basicrt-sample", "64"],
            r"--basicrt-sample: unknown option; did you mean --basicrt-samples\?",
        ),
        (["--basicrt-xyz=3"], "--basicrt-xyz: unknown option; there are --basicrt-samples, "),
        (
            ["--basicrt-samples", "0"],
            '--basicrt-samples: must be a whole number from 1 to 16777216, is "0"',
        ),
        (
            ["--basicrt-seed", "x"],
            '--basicrt-seed: must be a whole number from 0 to 2147483647, is "x"',
        ),
        (["--basicrt-threads", "-1"], "--basicrt-threads: "),
        (["--basicrt-samples"], "--basicrt-samples: expected one argument"),
    ],
)
def test_what_there_can_not_be_is_named(
    scene: Any, monkeypatch: pytest.MonkeyPatch, arguments: Sequence[str], message: str
) -> None:
    with pytest.raises(ExportError, match=f"^{message}"):
        parse(["--", *arguments])
    give(monkeypatch, "--", *arguments)
    with pytest.raises(RuntimeError, match=f"BasicRT: {message}"):
        bpy.ops.render.render()


def test_flags_count_before_the_scene_and_its_view_layers(
    scene: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    bpy.context.view_layer.samples = 5
    give(monkeypatch, "--", "--basicrt-samples", "128", "--basicrt-seed", "7")
    settings = export_in_render(monkeypatch).settings
    assert (settings.samples, settings.seed) == (128, 7)
    assert (scene.basicrt.samples, scene.basicrt.seed) == (4, 0), "the file is not altered"


def test_an_animated_seed_stays_animated(scene: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    scene.basicrt.use_animated_seed = True
    give(monkeypatch, "--", "--basicrt-seed", "7")
    seeds = []
    for frame in (1, 2):
        scene.frame_set(frame)
        seeds.append(export_in_render(monkeypatch).settings.seed)
    assert seeds[0] != seeds[1]
    assert all(seed & 0xFFFFFFFF == 7 for seed in seeds)


def test_threads_are_those_of_the_session(
    scene: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    threads = []

    class Watched(basicrt.Session):
        def __init__(self, *arguments: Any, **options: Any) -> None:
            threads.append(options["threads"])
            super().__init__(*arguments, **options)

    monkeypatch.setattr(basicrt, "Session", Watched)
    scene.render.threads = 2
    render(tmp_path)
    give(monkeypatch, "--", "--basicrt-threads", "3")
    render(tmp_path)
    assert threads == [2, 3]


def test_ranges_of_the_samples_add_up_to_the_picture(
    scene: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    scene.basicrt.samples = 128
    add_lamp("AREA", size=2)
    whole = render(tmp_path)
    parts = []
    for first in (0, 64):
        to = str(first + 64)
        give(monkeypatch, "--", "--basicrt-samples-from", str(first), "--basicrt-samples-to", to)
        parts.append(render(tmp_path))
    assert np.abs(parts[0] - parts[1]).max() > 0
    np.testing.assert_allclose((parts[0] + parts[1]) / 2, whole, rtol=1e-5, atol=1e-6)


def test_a_range_that_there_can_not_be_is_named(
    scene: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene.basicrt.samples = 128
    give(monkeypatch, "--", "--basicrt-samples-from", "100")
    with pytest.raises(RuntimeError, match="samples_from: must be a multiple of 64"):
        bpy.ops.render.render()
