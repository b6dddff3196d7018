# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line as a user runs it: what it writes, what it says, and its exit status."""

import importlib.util
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import basicrt
from support.scenes import endless, still_life


def run(*arguments: object, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "basicrt", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=cwd)


def thread_count(process: int) -> int:
    status = Path(f"/proc/{process}/status").read_text()
    return int(re.search(r"Threads:\s*(\d+)", status)[1])  # type: ignore[index]


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


@pytest.fixture
def scene_path(tmp_path: Path) -> Path:
    path = tmp_path / "scene.json"
    still_life().save(path)
    return path


def test_render_writes_what_python_renders(scene_path: Path) -> None:
    out = scene_path.parent / "out.exr"
    done = run("render", scene_path, "-o", out)
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
    assert re.search(r"out.exr: rendered in [\d.]+ s", done.stderr)
    pictures = basicrt.render(still_life())
    written = basicrt.read_exr(out)
    assert written.keys() == pictures.keys()
    for name, picture in pictures.items():
        assert written[name].tobytes() == picture.tobytes(), name
    assert names(out.parent) == ["out.exr", "scene.json"]


def test_render_takes_options_and_is_quiet(scene_path: Path) -> None:
    out = scene_path.parent / "out.exr"
    override = json.dumps({"settings": {"width": 12, "height": 10}})
    options = ["--spp", 3, "--seed", 5, "--threads", 1, "--override", override, "-q"]
    done = run("render", scene_path, "-o", out, *options)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    scene = basicrt.load_scene(scene_path, override=override)
    scene.settings.samples, scene.settings.seed = 3, 5
    combined = basicrt.render(scene)["Combined"]
    assert combined.shape == (10, 12, 4)
    assert np.array_equal(basicrt.read_exr(out)["Combined"], combined)


def test_the_default_output_has_the_name_of_the_scene(scene_path: Path) -> None:
    folder = scene_path.parent / "elsewhere"
    folder.mkdir()
    assert run("render", scene_path, "--spp", 1, cwd=folder).returncode == 0
    assert names(folder) == ["scene.exr"]


def test_render_writes_png(scene_path: Path) -> None:
    out = scene_path.parent / "out.png"
    assert run("render", scene_path, "-o", out, "--spp", 1).returncode == 0
    assert out.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["scene.json", "-o", "out.jpg"], r"out.jpg: the name must end in .exr or .png"),
        (["scene.json", "-o", "no/out.exr"], "no/.*out"),
        (["no.json", "-o", "out.exr"], "no.json"),
        (["broken.json", "-o", "out.exr"], "broken.json:2:1: "),
        (["scene.json", "-o", "out.exr", "--spp", "0"], "--spp: must be at least 1, is 0"),
        (["scene.json", "-o", "out.exr", "--threads", "-1"], "--threads: must be at least 0"),
        (["scene.json", "-o", "out.exr", "--override", "{"], "override:1:2: "),
        (["scene.json", "-o", "out.exr", "--override", '{"flim": 1}'], 'flim: .*"film"'),
        (["scene.json", "-o", "out.exr", "-f", "3"], "-f: only a .blend has frames"),
        (["no.blend", "-o", "out.exr"], "no.blend: no such file"),
        (["scene.json", "-o", "."], "must end in"),
    ],
)
def test_what_can_not_be_rendered_is_one_line_and_status_1(
    scene_path: Path, arguments: list[str], message: str
) -> None:
    folder = scene_path.parent
    (folder / "broken.json").write_text("{\n]")
    done = run("render", *arguments, cwd=folder)
    assert done.returncode == 1
    assert done.stdout == ""
    assert re.fullmatch(r"basicrt: .*\n", done.stderr), done.stderr
    assert re.search(message, done.stderr), done.stderr
    assert names(folder) == ["broken.json", "scene.json"]


def test_a_blend_needs_bpy(scene_path: Path) -> None:
    if importlib.util.find_spec("bpy"):
        pytest.skip("bpy is installed here")
    blend = scene_path.parent / "scene.blend"
    blend.touch()
    done = run("render", blend, "-o", scene_path.parent / "out.exr")
    assert done.returncode == 1
    assert "pip install basicrt[blender]" in done.stderr
    assert not (scene_path.parent / "out.exr").exists()


@pytest.mark.parametrize(
    "arguments", [[], ["rendr"], ["render"], ["render", "a.json", "--spp", "x"]]
)
def test_wrong_usage_is_status_2(arguments: list[str]) -> None:
    done = run(*arguments)
    assert done.returncode == 2
    assert "usage: basicrt" in done.stderr


def wait_for_threads(process: subprocess.Popen[str], count: int, seconds: float = 60) -> None:
    """Until the process has this many threads; fails where it ends before, or never has."""
    deadline = time.monotonic() + seconds
    while thread_count(process.pid) < count:
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline, f"{thread_count(process.pid)} threads, never {count}"
        time.sleep(0.05)


def test_an_interrupt_leaves_no_file(tmp_path: Path) -> None:
    scene = tmp_path / "scene.json"
    endless().save(scene)
    # With this many threads it is rendering: numpy starts none, and each has a tile (there are 16), so they stay.
    threads = 12
    arguments = [scene, "-o", tmp_path / "o.exr", "--threads", threads]
    command = [sys.executable, "-m", "basicrt", "render", *map(str, arguments)]
    process = subprocess.Popen(
        command,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
        # A shell starts what runs in its background with interrupts ignored, and children inherit that.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    try:
        wait_for_threads(process, threads)
        process.send_signal(signal.SIGINT)
        _, message = process.communicate(timeout=60)
    finally:
        process.kill()
        process.wait()
    assert process.returncode == 130
    assert message == "basicrt: interrupted\n"
    assert names(tmp_path) == ["scene.json"]


def test_warnings_are_one_line_each(scene_path: Path) -> None:
    scene = still_life(samples=1)
    scene.instances.append(basicrt.Instance(scene.shapes.append(basicrt.Mesh([], []))))
    scene.save(scene_path)
    done = run("render", scene_path, "-o", scene_path.parent / "out.exr", "-q")
    assert done.returncode == 0
    assert re.fullmatch(r"(basicrt: warning: .*\n)+", done.stderr), done.stderr
    assert "[3]" in done.stderr


def test_strict_turns_warnings_into_failures(scene_path: Path) -> None:
    scene = still_life(samples=1)
    scene.instances.append(basicrt.Instance(scene.shapes.append(basicrt.Mesh([], []))))
    scene.save(scene_path)
    done = run("render", scene_path, "-o", scene_path.parent / "out.exr", "-q", "--strict")
    assert done.returncode == 1
    assert re.fullmatch(r"basicrt: .*\[3\].*\n", done.stderr), done.stderr
    assert not (scene_path.parent / "out.exr").exists()


def test_compare_prints_all_metrics(tmp_path: Path) -> None:
    picture = np.random.default_rng(1).random((16, 16, 4)).astype(np.float32)
    basicrt.write_exr(tmp_path / "a.exr", {"Combined": picture})
    basicrt.write_exr(tmp_path / "b.exr", {"Combined": picture + np.float32(0.1)})
    done = run("compare", tmp_path / "a.exr", tmp_path / "b.exr")
    assert done.returncode == 0, done.stderr
    numbers = dict(line.split(maxsplit=1) for line in done.stdout.splitlines())
    assert list(numbers) == ["MSE", "relMSE", "FLIP"]
    assert float(numbers["MSE"]) == pytest.approx(0.01, rel=1e-4)


@pytest.mark.parametrize("metric", ["mse", "relmse", "flip"])
def test_compare_fails_over_the_threshold_only(tmp_path: Path, metric: str) -> None:
    if metric == "flip":
        pytest.importorskip("flip_evaluator")
    picture = np.random.default_rng(1).random((16, 16, 4)).astype(np.float32)
    a, b, c = (tmp_path / f"{name}.exr" for name in "abc")
    basicrt.write_exr(a, {"Combined": picture})
    basicrt.write_exr(b, {"Combined": picture + np.float32(0.1)})
    picture[0, 0] = np.nan
    basicrt.write_exr(c, {"Combined": picture})
    assert run("compare", a, a, "--metric", metric, "--threshold", 0).returncode == 0
    assert run("compare", a, b, "--metric", metric, "--threshold", 1).returncode == 0
    over = run("compare", a, b, "--metric", metric, "--threshold", 1e-4)
    assert over.returncode == 1
    assert re.search(rf"{metric} .* is over the threshold 0.0001", over.stderr)
    assert run("compare", c, a, "--metric", metric, "--threshold", 1e30).returncode == 1


def test_compare_refuses_what_it_can_not_compare(tmp_path: Path) -> None:
    basicrt.write_exr(tmp_path / "a.exr", {"Combined": np.zeros((2, 2, 4))})
    basicrt.write_exr(tmp_path / "b.exr", {"Combined": np.zeros((2, 3, 4))})
    basicrt.write_exr(tmp_path / "d.exr", {"Depth": np.zeros((2, 2, 1))})
    for other, message in (
        ("b", "unlike sizes"),
        ("no", "no.exr"),
        ("d", "no channels R, G and B"),
    ):
        done = run("compare", tmp_path / "a.exr", tmp_path / f"{other}.exr")
        assert done.returncode == 1
        assert re.fullmatch(rf"basicrt: .*{message}.*\n", done.stderr), done.stderr


def test_info_describes_the_installation(scene_path: Path) -> None:
    done = run("info")
    assert done.returncode == 0
    assert f"basicrt {basicrt.__version__}" in done.stdout
    assert "Depth (Z)" in done.stdout
    assert "OpenEXR: found" in done.stdout


def test_info_describes_a_scene(scene_path: Path) -> None:
    done = run("info", scene_path)
    assert done.returncode == 0, done.stderr
    facts = dict(line.split(maxsplit=1) for line in done.stdout.splitlines())
    assert facts["picture"] == "48 x 32, 8 samples per pixel"
    assert facts["shapes"] == "3 (2 triangles)"
    assert facts["camera"] == "PerspectiveCamera"


def test_version() -> None:
    done = run("--version")
    assert (done.returncode, done.stdout) == (0, f"{basicrt.__version__}\n")
