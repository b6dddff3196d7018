# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo scenes: nothing in them is unsupported, and their settings survive in every Blender."""

import re
from pathlib import Path

import bpy
import pytest
from addon.report import Report

from support.blender import export

SCENES = Path(__file__).resolve().parents[2] / "scenes" / "blender"


@pytest.mark.parametrize("name", ["cornell_glass", "materials", "lights", "instances"])
def test_demo_scene_needs_no_warning(name: str) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(SCENES / f"{name}.blend"))
    assert bpy.context.scene.render.engine == "BASICRT"
    source = (SCENES / f"{name}.py").read_text(encoding="utf-8")
    samples = re.search(r"samples=(\d+)", source)
    assert samples is not None
    assert bpy.context.scene.basicrt.samples == int(samples[1]), "the file is not the script's"
    report = Report()
    exported = export(report)
    assert report.warnings == ()
    assert len(exported.instances) > 5


def test_instances_share_a_handful_of_meshes() -> None:
    bpy.ops.wm.open_mainfile(filepath=str(SCENES / "instances.blend"))
    exported = export()
    assert len(exported.instances) > 2500
    assert len(exported.shapes) == 5  # ground, two pebbles, trunk, crown
