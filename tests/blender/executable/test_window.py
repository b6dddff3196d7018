# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Blender window: scripted edits in a rendered viewport, and what screenshots show of them.

BASICRT_DISPLAY names the X display, which may be a virtual one; without it these tests skip.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from support.extension import ROOT, RealBlender

SCRIPT = Path(__file__).with_name("edits_in_a_window.py")
TIMEOUT = 180
# In software, Blender's own redraws take seconds of the processor: a callback of ours that shares it is given time.
LONGEST_CALLBACK = float(os.environ.get("BASICRT_LONGEST_CALLBACK", "0.3"))


@dataclass
class Shots:
    """What was on the screen after each edit."""

    pictures: dict[str, np.ndarray] = field(
        default_factory=dict
    )  # (height, width, 3), row 0 at the top
    seconds: dict[str, float] = field(default_factory=dict)  # the longest of each callback

    def color(self, name: str, x: float = 0.5, y: float = 0.5) -> list[int]:
        """The middle of the colours near a place of the viewport, in parts of its size."""
        picture = self.pictures[name]
        row, column = int(y * picture.shape[0]), int(x * picture.shape[1])
        near = picture[row - 4 : row + 5, column - 4 : column + 5].reshape(-1, 3)
        return [int(value) for value in np.median(near, axis=0)]


def grab(display: str, region: list[int], path: Path) -> np.ndarray:
    """That part of the screen: x and y of its lower left corner, width and height."""
    environment = {**os.environ, "DISPLAY": display}
    command = ["import", "-window", "root", "-depth", "8", str(path)]
    subprocess.run(command, env=environment, capture_output=True, check=True)
    magic, size, most, values = path.read_bytes().split(b"\n", 3)
    assert (magic, most) == (b"P6", b"255")
    width, height = (int(number) for number in size.split())
    screen = np.frombuffer(values, np.uint8).reshape(height, width, 3)
    x, y, width, height = region
    return screen[::-1][y : y + height, x : x + width][::-1]


@pytest.fixture(scope="module")
def shots(blender: RealBlender, tmp_path_factory: pytest.TempPathFactory) -> Shots:
    """Of one run of the script."""
    display = os.environ.get("BASICRT_DISPLAY", "")
    if not display:
        pytest.skip("no display: name one in BASICRT_DISPLAY")
    if shutil.which("import") is None:
        pytest.skip("no ImageMagick, which takes the screenshots")
    folder = tmp_path_factory.mktemp("shots")
    environment = {**os.environ, "DISPLAY": display, "BLENDER_USER_RESOURCES": str(blender.profile)}
    options = [
        "--window-geometry",
        "0",
        "0",
        "800",
        "600",
        *shlex.split(os.environ.get("BASICRT_WINDOW", "")),
    ]
    command = [*blender.command, *options, "-P", str(SCRIPT), "--", str(folder)]
    taken = Shots()
    with (folder / "output").open("w") as output:
        process = subprocess.Popen(
            command, cwd=ROOT, env=environment, stdout=output, stderr=subprocess.STDOUT
        )
        end = time.monotonic() + TIMEOUT
        while not (folder / "done").exists() and process.poll() is None:
            if time.monotonic() > end:
                process.kill()
            for wanted in folder.glob("*.want"):
                asked = json.loads(wanted.read_text())
                taken.pictures[wanted.stem] = grab(
                    display, asked["region"], folder / f"{wanted.stem}.ppm"
                )
                taken.seconds = asked["seconds"]
                wanted.unlink()
            time.sleep(0.1)
        process.wait(timeout=30)
    assert (folder / "done").exists(), (folder / "output").read_text()
    return taken


def test_viewport_shows_the_scene(shots: Shots) -> None:
    assert shots.color("red") == [255, 0, 0]
    assert max(shots.color("red", x=0.95)) <= 2  # the world


def test_viewport_follows_a_material(shots: Shots) -> None:
    assert shots.color("green") == [0, 255, 0]


def test_viewport_follows_an_object_and_another_material(shots: Shots) -> None:
    assert max(shots.color("moved_away")) <= 2
    assert shots.color("blue") == [0, 0, 255]


def test_viewport_shows_a_pass(shots: Shots) -> None:
    assert shots.color("normal") == [0, 0, 255]  # the square faces up
    assert max(shots.color("normal", x=0.95)) <= 2


def test_viewport_renders_its_border_alone(shots: Shots) -> None:
    assert shots.color("border", x=0.52) == [255, 255, 0]
    assert shots.color("border", x=0.48) != [255, 255, 0]


def test_viewport_forgets_what_is_deleted(shots: Shots) -> None:
    assert max(shots.color("deleted")) <= 2


def test_callbacks_do_not_hold_blender_up(shots: Shots) -> None:
    assert max(shots.seconds.values()) < LONGEST_CALLBACK, shots.seconds
