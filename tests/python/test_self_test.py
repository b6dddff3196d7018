# SPDX-License-Identifier: GPL-3.0-or-later
"""The self-test passes here, finds what is wrong, and leaves the instruction set as it was; choosing that one."""

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import basicrt
from basicrt import self_testing
from support.scenes import bumpy, still_life


@pytest.fixture
def chosen() -> Iterator[str]:
    """What rays are traced with, before and after a test."""
    basicrt.choose_kernel()
    yield basicrt.chosen_kernel()
    basicrt.choose_kernel()


def run(*arguments: str, isa: str = "") -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "basicrt", *arguments]
    environment = {**os.environ, "BASICRT_ISA": isa}
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)


def test_all_is_well_here(chosen: str) -> None:
    result = basicrt.self_test()
    assert result.is_ok, result.verdict
    assert result.verdict == "OK"
    assert result.version == basicrt.__version__
    assert (result.kernel, result.kernels) == (chosen, tuple(basicrt.kernels()))
    assert result.threads == basicrt.processor_count()
    assert result.samples_per_second > 1000
    assert len(result.checks) == 3 + len(result.kernels)
    assert f"{result.kernel} (of " in result.machine
    assert basicrt.chosen_kernel() == chosen


def failures(monkeypatch: pytest.MonkeyPatch, spoil: Any) -> list[str]:
    """What fails where `spoil(picture, scene)` comes between."""

    def render(scene: basicrt.Scene, **options: Any) -> Any:
        pictures = basicrt.render(scene, **options)
        spoil(pictures["Combined"], scene)
        return pictures

    monkeypatch.setattr(self_testing, "render", render)
    result = basicrt.self_test(2)
    assert result.verdict.startswith("FAILED: ")
    return [check.name for check in result.checks if not check.is_ok]


def test_half_a_percent_too_bright_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def spoil(picture: Any, _scene: basicrt.Scene) -> None:
        picture *= 1.005

    assert failures(monkeypatch, spoil) == ["light of an area lamp", "light in a closed sphere"]


def test_what_is_no_number_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def spoil(picture: Any, _scene: basicrt.Scene) -> None:
        picture[3, 4, 1] = np.nan

    assert len(failures(monkeypatch, spoil)) == 3 + len(basicrt.kernels())


def test_an_instruction_set_that_differs_in_one_bit_is_found(
    monkeypatch: pytest.MonkeyPatch, chosen: str
) -> None:
    if chosen == "scalar":
        pytest.skip("there is nothing else here")

    def spoil(picture: Any, _scene: basicrt.Scene) -> None:
        if basicrt.chosen_kernel() == "scalar":
            picture.view(np.uint32)[5, 5, 2] ^= 1

    assert failures(monkeypatch, spoil) == ["the same with scalar"]
    assert basicrt.chosen_kernel() == chosen


def test_what_raises_has_failed_and_the_rest_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    def spoil(_picture: Any, scene: basicrt.Scene) -> None:
        if scene.settings.max_bounces == 12 and len(scene.shapes) == 1 and not len(scene.lights):
            raise MemoryError

    assert failures(monkeypatch, spoil) == ["light in a closed sphere"]


def test_threads_below_0_are_refused() -> None:
    with pytest.raises(basicrt.SceneError, match="threads: must be at least 0, is -1"):
        basicrt.self_test(-1)


def test_the_command_line_tells_it() -> None:
    done = run("self-test", "--threads", "2", isa="scalar")
    assert done.returncode == 0, done.stdout + done.stderr
    machine, *checks, verdict = done.stdout.splitlines()
    assert re.fullmatch(
        r"BasicRT [\d.]+, scalar \(of .*scalar\), threads: 2, [\d.]+ M samples/s", machine
    )
    assert len(checks) == 3 + len(basicrt.kernels())
    assert all(line.startswith("ok     ") for line in checks)
    assert verdict == "OK"
    assert run("self-test", "--threads", "-1").returncode == 1


def test_a_variable_that_names_nothing_is_told_in_one_line() -> None:
    done = run("self-test", isa="avx1024")
    assert (done.returncode, done.stdout) == (1, "")
    assert re.fullmatch(
        r"basicrt: BASICRT_ISA: 'avx1024' is not available here; .* scalar\n", done.stderr
    )


def test_info_says_what_rays_are_traced_with() -> None:
    assert "\ninstructions: scalar (of " in run("info", isa="scalar").stdout


def test_instruction_sets_are_chosen_by_name(chosen: str) -> None:
    assert basicrt.kernels()[-1] == "scalar"
    pictures = []
    for name in basicrt.kernels():
        basicrt.choose_kernel(name)
        assert basicrt.chosen_kernel() == name
        pictures.append(basicrt.render(still_life(samples=2))["Combined"].tobytes())
    assert len(set(pictures)) == 1
    with pytest.raises(basicrt.SceneError, match="choose_kernel: 'avx1024' is not available here"):
        basicrt.choose_kernel("avx1024")
    assert basicrt.chosen_kernel() == "scalar"
    basicrt.choose_kernel()
    assert basicrt.chosen_kernel() == chosen


def test_memory_is_known_before_and_after_trees_are_built() -> None:
    scene = still_life()
    scene.shapes.append(bumpy(100))
    expected = scene.memory()
    with basicrt.Session(scene) as session:
        used = session.memory
    assert used.trees == session.tree_bytes
    assert 40 * 20_000 <= expected.trees <= used.trees
    assert expected.shapes == used.shapes >= 2 * 20_000 * 12
    assert expected.picture == 48 * 32 * 4 * (4 + 1 + 3)
    assert expected.total == sum(
        (expected.shapes, expected.instances, expected.images, expected.trees, expected.picture)
    )
    assert f"{expected.total} bytes" in repr(expected)


def test_views_know_their_memory() -> None:
    scene = still_life()
    view = basicrt.ViewSession(1)
    assert view.memory is None
    view.set_scene(scene)
    while view.status.is_preparing:
        pass
    assert view.memory is not None
    assert view.memory.trees >= scene.memory().trees
    view.close()
