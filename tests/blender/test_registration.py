# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on registers, shows its panels for its engine alone, and leaves nothing behind."""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import addon
import bpy
import pytest
from addon.report import Report, show_warnings
from addon.ui import core_panels, panels

from support.blender import add_plane, new_scene


@pytest.fixture
def unregistered() -> Iterator[None]:
    """The add-on is away during a test."""
    addon.unregister()
    yield
    addon.register()


def all_panels() -> list[Any]:
    return [p for p in bpy.types.Panel.__subclasses__() if hasattr(p, "COMPAT_ENGINES")]


def test_engine_can_be_chosen() -> None:
    scene = new_scene()
    assert scene.render.engine == "BASICRT"


def test_settings_have_defaults_descriptions_and_survive_a_file(tmp_path: Any) -> None:
    scene = new_scene()
    properties = type(scene.basicrt).bl_rna.properties
    own = [p for p in properties if p.identifier not in {"rna_type", "name"}]
    assert len(own) == 40
    assert all(p.description for p in own)
    scene.basicrt.samples = 77
    path = str(tmp_path / "file.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    scene.basicrt.samples = 1
    bpy.ops.wm.open_mainfile(filepath=path)
    assert bpy.context.scene.basicrt.samples == 77


def test_core_panels_are_shown() -> None:
    names = {p.__name__ for p in all_panels() if "BASICRT" in p.COMPAT_ENGINES}
    assert {
        "RENDER_PT_color_management",
        "DATA_PT_lens",
        "DATA_PT_camera_dof",
        "DATA_PT_camera_dof_aperture",
        "EEVEE_MATERIAL_PT_surface",
        "EEVEE_WORLD_PT_surface",
        "DATA_PT_EEVEE_light",
        "BASICRT_RENDER_PT_sampling",
    } <= names
    assert "RENDER_PT_eevee_sampling" not in names


def test_own_panels_are_shown_for_no_other_engine() -> None:
    own = [p for p in all_panels() if p.__name__.startswith("BASICRT_")]
    assert len(own) == 27
    assert all({"BASICRT"} == p.COMPAT_ENGINES for p in own)


def test_panels_do_not_leak_after_unregister(unregistered: None) -> None:
    registered = [p for p in all_panels() if not p.__module__.startswith("addon.")]
    assert len(registered) > 100
    assert not [p.__name__ for p in registered if "BASICRT" in p.COMPAT_ENGINES]


def test_nothing_else_is_left_after_unregister(unregistered: None) -> None:
    assert not hasattr(bpy.types.Scene, "basicrt")
    assert not hasattr(bpy.types, "BASICRT_OT_export_scene")
    assert not hasattr(bpy.types, "BASICRT_OT_copy_cycles_settings")
    assert not hasattr(bpy.types, "BASICRT_RENDER_PT_sampling")
    with pytest.raises(TypeError):
        bpy.context.scene.render.engine = "BASICRT"
    menu = bpy.types.TOPBAR_MT_file_export
    assert not [f for f in menu._dyn_ui_initialize() if "addon." in f.__module__]


def test_registering_again_works(unregistered: None) -> None:
    addon.register()
    try:
        assert new_scene().basicrt.samples == 16
    finally:
        addon.unregister()


def test_core_panels_are_found_once() -> None:
    found = list(core_panels.core_panels())
    assert len(found) == len(set(found))


class DrawnNames:
    """A layout that notes what is drawn, and refuses what its owner doesn't have."""

    def __init__(self) -> None:
        self.names: list[str] = []

    def column(self) -> "DrawnNames":
        return self

    def prop(self, owner: Any, name: str, **_options: Any) -> None:
        assert name in owner.bl_rna.properties, name
        self.names.append(name)


class DrawnWarnings:
    """A layout that notes lines of text, and whether a button stands beside them."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.buttons: list[Any] = []

    def row(self) -> "DrawnWarnings":
        return self

    def column(self, **_options: Any) -> "DrawnWarnings":
        return self

    def prop(self, owner: Any, name: str) -> None:
        assert name in owner.bl_rna.properties

    def label(self, text: str, icon: str) -> None:
        self.lines.append(text)

    def operator(self, name: str, **_options: Any) -> Any:
        assert name == "basicrt.select_culprit"
        self.buttons.append(SimpleNamespace(warning=None))
        return self.buttons[-1]


def draw_warnings(*warnings: tuple[str, str]) -> DrawnWarnings:
    report = Report()
    for item, message in warnings:
        report.warn(item, message)
    show_warnings(report)
    layout = DrawnWarnings()
    context = SimpleNamespace(
        scene=bpy.context.scene,
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1)),
        region=SimpleNamespace(width=210),
    )
    bpy.types.BASICRT_RENDER_PT_warnings.draw(SimpleNamespace(layout=layout), context)
    show_warnings(Report())
    return layout


def test_warnings_are_whole_and_have_a_button_where_something_can_be_selected() -> None:
    new_scene()
    add_plane().name = "Tiles"
    shown = draw_warnings(("scene", "an odd thing of many words"), ('object "Tiles"', "is odd"))
    assert " ".join(shown.lines) == 'scene: an odd thing of many words object "Tiles": is odd'
    assert max(map(len, shown.lines)) <= 22
    assert [button.warning for button in shown.buttons] == ['object "Tiles": is odd']
    assert len(draw_warnings().lines) == 1


def test_panoramas_show_what_they_have() -> None:
    new_scene()
    b_camera: Any = bpy.data.cameras.new("Camera")
    context = type("Context", (), {"engine": "BASICRT", "camera": b_camera})
    panel = panels.BASICRT_CAMERA_PT_panorama
    assert not panel.poll(context)
    b_camera.type = "PANO"
    assert panel.poll(context)
    for item in type(b_camera).bl_rna.properties["panorama_type"].enum_items:
        b_camera.panorama_type = item.identifier
        drawn = type("Drawn", (), {"layout": DrawnNames(), "column": panel.column})()
        panel.draw(drawn, context)
        own = [name for name in drawn.layout.names if name != "panorama_type"]
        assert tuple(own) == panels.PANORAMA_PROPERTIES.get(item.identifier, ())
