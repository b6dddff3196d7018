# SPDX-License-Identifier: GPL-3.0-or-later
"""A render that can't be made says why in one message, raises, and leaves no file."""

import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy
import pytest
from addon.engine import BasicRTRenderEngine
from addon.report import shown_warnings

import basicrt
from support.blender import (
    add_camera,
    add_lamp,
    add_mesh,
    add_node,
    add_plane,
    empty_material,
    new_material,
    new_scene,
    render,
    set_exr,
    set_world,
)


@pytest.fixture
def picture(tmp_path: Path) -> Iterator[Path]:
    """Where a render would be written; nothing may be there afterwards."""
    scene = new_scene(8, 8)
    set_exr(scene)
    path = tmp_path / "picture.exr"
    scene.render.filepath = str(path)
    yield path
    assert not path.exists()


def fail_to_render() -> str:
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.render.render(write_still=True)
    return str(caught.value)


def test_no_camera(picture: Path) -> None:
    add_plane()
    assert "no camera" in fail_to_render().lower()


def test_vertex_that_is_not_a_number(picture: Path) -> None:
    add_camera()
    made = add_mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], name="Broken")
    made.data.attributes["position"].data[1].vector = (0, float("nan"), 0)
    assert 'object "Broken": positions[1, 1]: must be a finite number' in fail_to_render()


def test_material_of_more_shaders_than_can_be_rendered(picture: Path) -> None:
    add_camera()
    material, tree, output = empty_material("Crowd")
    sum_ = add_node(tree, "ShaderNodeBsdfDiffuse")
    for _ in range(16):
        added = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(sum_.outputs[0], added.inputs[0])
        tree.links.new(add_node(tree, "ShaderNodeBsdfDiffuse").outputs[0], added.inputs[1])
        sum_ = added
    tree.links.new(sum_.outputs[0], output.inputs["Surface"])
    add_plane(material=material)
    assert 'material "Crowd": combines more shaders than can be rendered' in fail_to_render()


def test_native_module_missing(picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    add_camera()
    monkeypatch.setitem(sys.modules, "basicrt", None)
    assert "the native module `basicrt` cannot be imported" in fail_to_render()


def test_native_module_of_another_version(picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    add_camera()
    monkeypatch.setattr(basicrt, "native_version", lambda: "0.0.1")
    assert "`basicrt` is version 0.0.1, but the add-on is" in fail_to_render()


def raise_from(error: BaseException) -> Any:
    def fail(*_arguments: Any, **_keywords: Any) -> None:
        raise error

    return fail


def test_out_of_memory(picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    add_camera()
    monkeypatch.setattr(basicrt, "Session", raise_from(MemoryError()))
    assert "BasicRT: out of memory" in fail_to_render()


def test_interrupt(picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    add_camera()
    monkeypatch.setattr(basicrt, "Session", raise_from(KeyboardInterrupt()))
    assert "BasicRT: interrupted" in fail_to_render()


INTERRUPTED_RENDER = """
import signal, sys
import basicrt
from basicrt.cli import main

basicrt.Session = lambda *_, **__: signal.raise_signal(signal.SIGINT)
sys.exit(main(sys.argv[1:]))
"""


def test_an_interrupt_of_the_command_line_is_told_from_a_failure(tmp_path: Path) -> None:
    blend = Path(__file__).resolve().parents[2] / "scenes/blender/cornell_glass.blend"
    command = [sys.executable, "-c", INTERRUPTED_RENDER, "render", blend, "-o", tmp_path / "o.exr"]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
        # A shell starts what runs in its background with interrupts ignored, and children inherit that.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    assert done.returncode == 130, done.stderr
    assert "basicrt: interrupted\n" in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())


def test_our_own_mistakes(picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    add_camera()
    monkeypatch.setattr(basicrt, "Session", raise_from(AssertionError("never")))
    assert "BasicRT: never" in fail_to_render()


def test_failure_is_forgotten_by_the_next_render(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    new_scene(8, 8)
    add_camera()
    set_world((1, 1, 1))
    with monkeypatch.context() as patch:
        patch.setattr(basicrt, "native_version", lambda: "0.0.1")
        fail_to_render()
    assert render(tmp_path).min() == 1


def test_cancelling_stops_early(picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 512
    scene.basicrt.samples = 1 << 20  # hours
    add_plane(material=new_material("ShaderNodeBsdfDiffuse"))
    add_lamp("POINT", energy=1)
    add_camera()
    polls = iter(range(10**9))
    monkeypatch.setattr(BasicRTRenderEngine, "_is_cancelled", lambda _self: next(polls) >= 3)
    bpy.ops.render.render()
    assert next(polls) <= 5, "went on after it was cancelled"


def test_cancelling_while_trees_are_built(picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    add_plane()
    add_camera()

    def build_slowly(*_args: Any, preparing: Callable[[float], None], **_options: Any) -> None:
        preparing(0.5)
        pytest.fail("went on after it was cancelled")

    monkeypatch.setattr(basicrt, "Session", build_slowly)
    monkeypatch.setattr(BasicRTRenderEngine, "_is_cancelled", lambda _self: True)
    bpy.ops.render.render()


def test_what_is_not_supported_is_shown_after_the_render(tmp_path: Path) -> None:
    new_scene(8, 8)
    add_camera()
    add_plane(material=new_material("ShaderNodeBsdfRayPortal", "Wax"))
    render(tmp_path)
    assert shown_warnings() == (
        'material "Wax": node "Ray Portal BSDF": not supported: drawn as a Transparent BSDF',
    )
    bpy.data.materials.remove(bpy.data.materials["Wax"])
    render(tmp_path)
    assert shown_warnings() == ()


def test_faces_without_area_are_left_out_with_a_warning(tmp_path: Path) -> None:
    new_scene(8, 8)
    add_camera(ortho_scale=0.5)
    corners = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (2, 2, 0), (2, 2, 0), (2, 2, 0)]
    shines = new_material("ShaderNodeEmission", Color=(1, 1, 1), Strength=1.0)
    add_mesh(corners, [(0, 1, 2, 3), (4, 5, 6)], shines)
    assert render(tmp_path)[4, 4, 0] == 1
    assert shown_warnings() == ('object "Mesh": 1 of 3 triangles have no area and are left out',)


def test_empty_scene_is_a_picture_of_the_world(tmp_path: Path) -> None:
    new_scene(8, 8)
    add_camera()
    assert (render(tmp_path)[..., :3] == 0).all()


def add_wax() -> None:
    add_camera()
    add_plane(material=new_material("ShaderNodeBsdfRayPortal", "Wax"))


def add_sliver() -> None:
    """What only the core finds, once trees are built."""
    add_camera()
    add_mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 0, 0)], [(0, 1, 2), (0, 1, 3)])


@pytest.mark.parametrize(
    ("fill", "expected"), [(add_wax, 'node "Ray Portal BSDF"'), (add_sliver, "have no area")]
)
def test_fail_on_warnings_makes_no_picture(
    picture: Path, fill: Callable[[], None], expected: str
) -> None:
    fill()
    bpy.context.scene.basicrt.fail_on_warnings = True
    message = fail_to_render()
    assert "Fail on Warnings" in message
    assert expected in message
    assert len(shown_warnings()) == 1


def test_fail_on_warnings_by_the_command_line(
    picture: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    add_wax()
    monkeypatch.setattr(sys, "argv", ["blender", "--", "--basicrt-strict"])
    assert 'node "Ray Portal BSDF"' in fail_to_render()


def test_fail_on_warnings_lets_others_pass(tmp_path: Path) -> None:
    new_scene(8, 8)
    add_camera()
    set_world((0.5, 0.5, 0.5))
    bpy.context.scene.basicrt.fail_on_warnings = True
    assert (render(tmp_path)[..., 0] == 0.5).all()
