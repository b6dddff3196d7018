# SPDX-License-Identifier: GPL-3.0-or-later
"""Each difference between Blender versions that compat.py knows is as it says."""

import re
import sys
import tomllib
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from addon import compat

import basicrt
from support.blender import add_node, empty_material, new_scene

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def scene() -> None:
    new_scene()


def test_addon_has_the_projects_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert compat.addon_version() == project["project"]["version"]


def test_native_module_of_the_same_version_is_accepted() -> None:
    assert compat.check_native() == basicrt.native_version()


def test_native_module_of_another_version_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(basicrt, "native_version", lambda: "9.8.7")
    with pytest.raises(compat.NativeModuleError, match=r"is version 9\.8\.7, but the add-on is"):
        compat.check_native()


def test_missing_native_module_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "basicrt", None)
    with pytest.raises(compat.NativeModuleError, match="cannot be imported in Python 3"):
        compat.check_native()


def test_something_else_of_that_name_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "basicrt", SimpleNamespace())
    with pytest.raises(compat.NativeModuleError, match="install the extension again"):
        compat.check_native()


@pytest.mark.skipif(bpy.app.version >= (5, 0, 0), reason="materials and worlds always have nodes")
@pytest.mark.parametrize("kind", ["materials", "worlds", "lights"])
def test_nodes_can_be_out_of_use_before_5(kind: str) -> None:
    arguments = ("Name", "POINT") if kind == "lights" else ("Name",)
    owner = getattr(bpy.data, kind).new(*arguments)
    owner.use_nodes = True
    assert compat.node_tree(owner) is not None
    owner.use_nodes = False
    assert compat.node_tree(owner) is None


@pytest.mark.skipif(bpy.app.version < (5, 0, 0), reason="nodes can be out of use before 5.0")
def test_materials_and_worlds_always_have_nodes_from_5() -> None:
    assert compat.node_tree(bpy.data.materials.new("Name")) is not None
    assert compat.node_tree(bpy.data.worlds.new("Name")) is not None


def test_new_lamp_has_no_nodes_or_harmless_ones() -> None:
    tree = compat.node_tree(bpy.data.lights.new("Name", "POINT"))
    assert (tree is not None) == (bpy.app.version >= (5, 1, 0))


def nested_material() -> Any:
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    inner, sink = add_node(group, "ShaderNodeEmission"), group.nodes.new("NodeGroupOutput")
    inner.name = "7_Lamp"
    group.links.new(inner.outputs[0], sink.inputs[0])
    material, tree, output = empty_material()
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


def test_groups_are_dissolved_from_5_on() -> None:
    with compat.inlined_nodes(nested_material()) as tree:
        kinds = {node.bl_idname for node in tree.nodes}
    assert ("ShaderNodeGroup" in kinds) == (bpy.app.version < (5, 0, 0))


def test_inlined_nodes_keep_the_names_that_the_user_knows() -> None:
    with compat.inlined_nodes(nested_material()) as tree:
        if bpy.app.version >= (5, 0, 0):
            names = [compat.node_name(n) for n in tree.nodes if n.type == "EMISSION"]
        else:
            group = next(node for node in tree.nodes if node.type == "GROUP")
            names = [compat.node_name(n) for n in group.node_tree.nodes if n.type == "EMISSION"]
    assert names == ["7_Lamp"]


def test_users_nodes_survive_inlining() -> None:
    material = nested_material()
    before = [node.name for node in material.node_tree.nodes]
    with compat.inlined_nodes(material):
        pass
    assert [node.name for node in material.node_tree.nodes] == before


def test_lamp_strength_takes_what_the_version_has() -> None:
    light = bpy.data.lights.new("Name", "POINT")
    light.energy, light.color = 3, (1, 0.5, 0.25)
    assert compat.light_strength(light) == pytest.approx((3, 1.5, 0.75))
    assert compat.is_light_normalized(light)
    has_exposure = bpy.app.version >= (4, 5, 0)
    assert hasattr(light, "exposure") == has_exposure
    if has_exposure:
        light.exposure, light.normalize = -1, False
        assert compat.light_strength(light) == pytest.approx((1.5, 0.75, 0.375))
        assert not compat.is_light_normalized(light)


def test_shadow_terminator_offsets_are_where_the_version_has_them() -> None:
    made: Any = bpy.data.objects.new("Name", bpy.data.meshes.new("Name"))
    assert compat.shadow_terminator_offset(made) == pytest.approx(0.1)
    assert compat.shadow_terminator_shading_offset(made) == 0
    if bpy.app.version >= (4, 3, 0):
        made.shadow_terminator_geometry_offset, made.shadow_terminator_shading_offset = 0.2, 0.5
    else:
        made.cycles.shadow_terminator_geometry_offset = 0.2
        made.cycles.shadow_terminator_offset = 0.5
    assert compat.shadow_terminator_offset(made) == pytest.approx(0.2)
    assert compat.shadow_terminator_shading_offset(made) == 0.5


def test_view_layer_may_override_the_world() -> None:
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    scene.world = bpy.data.worlds.new("Scene's")
    assert compat.view_layer_world(scene, view_layer) == scene.world
    if hasattr(view_layer, "world_override"):
        view_layer.world_override = bpy.data.worlds.new("Layer's")
        assert compat.view_layer_world(scene, view_layer).name == "Layer's"
    else:
        assert bpy.app.version < (4, 3, 0)


def test_shared_panels_exist_in_some_version() -> None:
    # All but these, which came later, are in all versions.
    later = {"VIEWLAYER_PT_override", "OBJECT_PT_shading", "OBJECT_PT_shadow_terminator"}
    missing = {name for name in compat.SHARED_PANELS if not hasattr(bpy.types, name)}
    assert missing <= later


def test_peak_memory_is_that_of_this_process() -> None:
    status = Path("/proc/self/status")
    if not status.exists():
        pytest.skip("no /proc here")
    match = re.search(r"VmHWM:\s*(\d+) kB", status.read_text(encoding="utf-8"))
    assert match is not None
    assert compat.peak_memory_megabytes() == pytest.approx(int(match[1]) / 1024, rel=0.05)


def test_panoramas_are_properties_of_the_camera_itself() -> None:
    camera = bpy.data.cameras.new("Name")
    kinds = {k.identifier for k in type(camera).bl_rna.properties["panorama_type"].enum_items}
    assert {"EQUIRECTANGULAR", "MIRRORBALL", "FISHEYE_EQUISOLID"} <= kinds
    assert ("CENTRAL_CYLINDRICAL" in kinds) == hasattr(camera, "central_cylindrical_radius")
    assert hasattr(camera, "fisheye_polynomial_k4")


def test_cells_of_voronoi_textures_lie_elsewhere_from_5_on() -> None:
    assert compat.cell_hash() == ("pcg" if bpy.app.version >= (5, 0, 0) else "lookup3")


def test_spectra_are_white_where_the_matrix_has_its_white() -> None:
    white = (0.3127 / 0.3290, 1.0, (1 - 0.3127 - 0.3290) / 0.3290)  # D65, by CIE's chromaticity
    for row in compat.rec709_from_xyz():
        assert sum(a * b for a, b in zip(row, white, strict=True)) == pytest.approx(1, abs=1e-3)


def test_luminance_is_that_of_the_matrix() -> None:
    luminance = np.linalg.inv(compat.rec709_from_xyz())[1]
    assert compat.luminance_weights() == pytest.approx(luminance, abs=1e-6)


def test_bumps_have_a_filter_width_from_4_3_on() -> None:
    node = empty_material()[1].nodes.new("ShaderNodeBump")
    width = node.inputs.get("Filter Width")
    assert (width is not None) == (bpy.app.version >= (4, 3, 0))
    expected = 1.0 if width is None else width.default_value
    assert compat.bump_filter_width() == pytest.approx(expected)


def test_bumps_are_corrected_unless_a_material_says_otherwise() -> None:
    material, _tree, _output = empty_material()
    assert compat.corrects_bumps(material)
    material.cycles.use_bump_map_correction = False
    assert not compat.corrects_bumps(material)


def test_green_is_down_only_where_a_node_says_so() -> None:
    node = empty_material()[1].nodes.new("ShaderNodeNormalMap")
    assert not compat.is_green_down(node)
    if bpy.app.version >= (5, 2, 0):
        node.convention = "DIRECTX"
        assert compat.is_green_down(node)
