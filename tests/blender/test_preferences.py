# SPDX-License-Identifier: GPL-3.0-or-later
"""Preferences: what holds without them, what counts before what, and the self-test."""

import logging
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import addon
import bpy
import pytest
from addon import preferences
from addon.engine.command_line import Overrides
from addon.engine.machine import thread_count
from addon.preferences import Preferences

import basicrt
from support.blender import render
from support.scenes import still_life


@pytest.fixture
def given(scene: Any, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """The preferences that Blender keeps of an add-on that was enabled in them."""
    monkeypatch.delenv("BASICRT_ISA", raising=False)
    addons: Any = bpy.context.preferences.addons
    made = addons.new()
    made.module = "addon"
    yield made.preferences
    made.preferences.isa, made.preferences.log_level = "AUTO", "WARNING"
    addons.remove(made)


def gb(size: int) -> float:
    return float(size / 2**30)


def test_defaults_hold_for_a_plain_module(scene: Any) -> None:
    assert "addon" not in bpy.context.preferences.addons
    assert preferences.preferences() == Preferences()


def test_defaults_are_those_of_the_properties(given: Any) -> None:
    assert preferences.preferences() == Preferences()
    given.threads, given.memory_limit = 3, 2.5
    assert preferences.preferences() == Preferences(threads=3, memory_limit=2.5)


def test_every_instruction_set_can_be_chosen() -> None:
    known = {identifier.lower() for identifier, _name, _description in preferences.ISAS}
    assert set(basicrt.kernels()) <= known


def test_threads_are_for_scenes_that_have_no_number(given: Any) -> None:
    scene = bpy.context.scene
    scene.render.threads_mode = "AUTO"
    assert thread_count(scene, Overrides()) == scene.render.threads
    given.threads = 3
    assert thread_count(scene, Overrides()) == 3
    assert thread_count(scene, Overrides(threads=0)) == 0
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    assert thread_count(scene, Overrides()) == 2
    assert thread_count(scene, Overrides(threads=5)) == 5


def test_the_instruction_set_changes_at_once_and_back(given: Any) -> None:
    before = basicrt.chosen_kernel()
    given.isa = "SCALAR"
    assert basicrt.chosen_kernel() == "scalar"
    given.isa = "AUTO"
    assert basicrt.chosen_kernel() == before


def test_the_environment_counts_before_the_preferences(
    given: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    best = basicrt.kernels()[0]
    monkeypatch.setenv("BASICRT_ISA", best)
    given.isa = "SCALAR"
    assert basicrt.chosen_kernel() == best


def test_what_the_machine_does_not_have_is_told(
    given: Any, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    best = basicrt.kernels()[0]
    monkeypatch.setattr(basicrt, "kernels", lambda: ["scalar"])
    given.isa = "AVX2"
    assert "this machine has no AVX2" in caplog.text
    assert basicrt.chosen_kernel() == best


def test_a_script_s_own_choice_stays(scene: Any, tmp_path: Path) -> None:
    basicrt.choose_kernel("scalar")
    try:
        render(tmp_path)
        assert basicrt.chosen_kernel() == "scalar"
    finally:
        basicrt.choose_kernel()


def test_renders_tell_the_log_what_they_took(
    given: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    monkeypatch.setattr(logging.getLogger(), "handlers", [])
    render(tmp_path)
    assert "BasicRT: memory:" not in capsys.readouterr().err
    given.log_level = "INFO"
    render(tmp_path)
    told = capsys.readouterr().err
    assert "BasicRT: memory: " in told
    assert "threads: 2" in told
    assert basicrt.chosen_kernel() in told


def test_levels_below_are_not_printed(given: Any, caplog: pytest.LogCaptureFixture) -> None:
    given.log_level = "ERROR"
    log = logging.getLogger("basicrt")
    log.warning("a warning")
    log.error("an error")
    assert [record.getMessage() for record in caplog.records] == ["an error"]


def test_a_scene_above_the_limit_is_not_rendered(
    given: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    monkeypatch.setattr(logging.getLogger(), "handlers", [])
    given.memory_limit = 1e-7
    with pytest.raises(
        RuntimeError,
        match=r"BasicRT: the scene needs at least \S+ GB of memory \(.*picture .*\), and Edit > "
        r"Preferences > Add-ons > BasicRT > Memory Limit allows 1e-07 GB: raise that \(0 is no limit\)",
    ):
        render(tmp_path)
    assert "Traceback" not in capsys.readouterr().err
    given.memory_limit = 1
    assert render(tmp_path).shape == (8, 8, 4)


def test_trees_are_measured_when_they_are_built(
    given: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import bmesh

    mesh = bmesh.new()
    bmesh.ops.create_grid(mesh, x_segments=60, y_segments=60, size=1)
    mesh.to_mesh(bpy.context.scene.objects["Plane"].data)
    mesh.free()
    sizes = []

    class Watched(basicrt.Session):
        def __init__(self, scene: basicrt.Scene, **options: Any) -> None:
            super().__init__(scene, **options)
            sizes.extend([scene.memory().total, self.memory.total])

    monkeypatch.setattr(basicrt, "Session", Watched)
    render(tmp_path)
    expected, used = sizes
    assert expected < used
    given.memory_limit = gb((expected + used) // 2)
    with pytest.raises(RuntimeError, match=r"BasicRT: the scene needs \S+ GB of memory"):
        render(tmp_path)


def test_the_command_line_counts_before_the_limit(
    given: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given.memory_limit = 1e-7
    monkeypatch.setattr(sys, "argv", ["blender", "--", "--basicrt-memory-limit", "0"])
    assert render(tmp_path).shape == (8, 8, 4)
    monkeypatch.setattr(sys, "argv", ["blender", "--", "--basicrt-memory-limit", "1e-8"])
    with pytest.raises(RuntimeError, match="and --basicrt-memory-limit allows 1e-08 GB"):
        render(tmp_path)
    monkeypatch.setattr(sys, "argv", ["blender", "--", "--basicrt-memory-limit", "-1"])
    with pytest.raises(RuntimeError, match="--basicrt-memory-limit: must be a number of GB"):
        render(tmp_path)


def test_viewports_tell_that_a_scene_is_above_the_limit(given: Any) -> None:
    from addon.engine.viewport import Viewport

    told: list[str] = []

    class Engine:
        def update_stats(self, _title: str, text: str) -> None:
            told.append(text)

    engine: Any = Engine()
    scene = still_life()
    session = basicrt.ViewSession(1)
    viewport = Viewport(engine)
    viewport._session = session
    session.set_scene(scene)
    while session.status.is_preparing:
        pass
    viewport._show_status()
    assert "memory" not in told[-1]
    viewport._is_measured = False
    given.memory_limit = gb(scene.memory().total) / 2
    viewport._show_status()
    assert told[-1].startswith("BasicRT: the scene needs ")
    assert viewport._session is None
    viewport._show_status()
    assert told[-1].startswith("BasicRT: the scene needs ")


class Drawn:
    """A layout that notes what is drawn, and refuses what the preferences don't have."""

    def __init__(self) -> None:
        self.labels: list[str] = []
        self.properties: list[str] = []
        self.choices: list[str] = []
        self.operators: list[str] = []

    def column(self) -> "Drawn":
        return self

    def row(self, **_options: Any) -> "Drawn":
        return self

    def split(self, factor: float) -> "Drawn":
        return self

    def label(self, text: str, icon: str = "") -> None:
        self.labels.append(text)

    def prop(self, owner: Any, name: str, text: str = "") -> None:
        assert name in owner.bl_rna.properties
        self.properties.append(name)

    def prop_enum(self, owner: Any, name: str, value: str) -> None:
        assert value in owner.bl_rna.properties[name].enum_items
        self.choices.append(value)

    def operator(self, name: str) -> None:
        self.operators.append(name)


def draw(given: Any) -> Drawn:
    layout = Drawn()
    page = preferences.BasicRTPreferences
    drawn = SimpleNamespace(
        layout=layout,
        bl_rna=given.bl_rna,
        isa=given.isa,
        _draw_isa=lambda column: page._draw_isa(drawn, column),  # type: ignore[arg-type]
    )
    page.draw(drawn, bpy.context)  # type: ignore[arg-type]
    return layout


def test_the_page_shows_what_the_machine_has(given: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    layout = draw(given)
    assert layout.labels[0] == f"Native module {basicrt.__version__}"
    assert layout.properties == ["threads", "log_level", "memory_limit"]
    assert layout.choices == ["AUTO", *(name.upper() for name in basicrt.kernels())]
    assert layout.operators == ["basicrt.self_test"]
    monkeypatch.setenv("BASICRT_ISA", "scalar")
    assert "BASICRT_ISA in the environment is scalar" in draw(given).labels


def test_the_self_test_is_shown(given: Any) -> None:
    assert bpy.ops.basicrt.self_test() == {"FINISHED"}
    labels = draw(given).labels
    assert any("M samples/s" in text for text in labels)
    assert sum("no byte differs" in text for text in labels) == len(basicrt.kernels())


def test_a_self_test_that_fails_is_an_error(given: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    check = basicrt.SelfTestCheck("light", False, "2, exact 1")
    failed = basicrt.SelfTestResult("0.1", "scalar", ("scalar",), 1, 1e6, (check,))
    monkeypatch.setattr(basicrt, "self_test", lambda threads: failed)
    with pytest.raises(RuntimeError, match=r"FAILED: light \(2, exact 1\)"):
        bpy.ops.basicrt.self_test()
    assert "light: 2, exact 1" in draw(given).labels


def test_nothing_is_left_after_unregister(given: Any) -> None:
    before = basicrt.chosen_kernel()
    given.isa, given.log_level = "SCALAR", "DEBUG"
    addon.unregister()
    try:
        log = logging.getLogger("basicrt")
        assert (log.level, log.handlers) == (logging.NOTSET, [])
        assert basicrt.chosen_kernel() == before
        assert not hasattr(bpy.types, "BASICRT_OT_self_test")
        assert preferences.preferences() == Preferences()
    finally:
        addon.register()
    assert logging.getLogger("basicrt").level == logging.DEBUG
