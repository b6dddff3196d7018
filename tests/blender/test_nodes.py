# SPDX-License-Identifier: GPL-3.0-or-later
"""Each shader node becomes ours with its values; groups, reroutes and muted nodes are as if they were not there."""

from typing import Any

import bpy
import pytest
from addon.nodes import Textures, translate_surface
from addon.nodes.operations import OPERATIONS
from addon.report import Report

import basicrt
from support.blender import add_node, empty_material, new_material, new_scene

COLOR = (0.25, 0.5, 0.75)  # exact in float32


@pytest.fixture(autouse=True)
def scene() -> None:
    new_scene()


def translate(material: Any, *expected_warnings: str) -> Any:
    """The translated material; its warnings must be these."""
    report = Report()
    made = translate_surface(material, report, Textures(basicrt.Scene()))
    assert report.warnings == tuple(
        f'material "{material.name}": {text}' for text in expected_warnings
    )
    return made


def only_node(material: Any, *expected_warnings: str) -> Any:
    made = translate(material, *expected_warnings)
    assert len(made.nodes) == 1
    assert made.surface == 0
    return made.nodes[0]


def find_node(material: Any, bl_idname: str) -> Any:
    return next(node for node in material.node_tree.nodes if node.bl_idname == bl_idname)


# ---- each node ---------------------------------------------------------------------------------


def test_diffuse() -> None:
    node = only_node(new_material("ShaderNodeBsdfDiffuse", Color=COLOR))
    assert isinstance(node, basicrt.DiffuseShader)
    assert node.color == COLOR
    assert node.twosided


def test_glossy() -> None:
    node = only_node(new_material("ShaderNodeBsdfAnisotropic", Color=COLOR, Roughness=0.25))
    assert isinstance(node, basicrt.GlossyShader)
    assert (node.color, node.roughness) == (COLOR, 0.25)
    assert node.distribution == "multi_ggx"


def test_glass_tints_reflection_and_refraction() -> None:
    node = only_node(new_material("ShaderNodeBsdfGlass", Color=COLOR, Roughness=0.5, IOR=1.25))
    assert isinstance(node, basicrt.GlassShader)
    assert (node.R, node.T, node.eta, node.roughness) == (COLOR, COLOR, 1.25, 0.5)


def test_refraction() -> None:
    node = only_node(new_material("ShaderNodeBsdfRefraction", Color=COLOR, Roughness=0.0, IOR=1.25))
    assert isinstance(node, basicrt.RefractionShader)
    assert (node.color, node.eta, node.roughness) == (COLOR, 1.25, 0)
    assert node.distribution == "beckmann"
    assert not node.total_reflection


@pytest.mark.parametrize(
    ("distribution", "ours"),
    [
        ("MULTI_GGX", "multi_ggx"),
        ("GGX", "ggx"),
        ("BECKMANN", "beckmann"),
        ("ASHIKHMIN_SHIRLEY", "ashikhmin_shirley"),
    ],
)
def test_glossy_keeps_its_distribution(distribution: str, ours: str) -> None:
    material = new_material("ShaderNodeBsdfAnisotropic", Roughness=0.5)
    find_node(material, "ShaderNodeBsdfAnisotropic").distribution = distribution
    assert only_node(material).distribution == ours


def test_rough_diffuse() -> None:
    node = only_node(new_material("ShaderNodeBsdfDiffuse", Color=COLOR, Roughness=0.75))
    assert (node.color, node.roughness) == (COLOR, 0.75)


def test_translucent() -> None:
    node = only_node(new_material("ShaderNodeBsdfTranslucent", Color=COLOR))
    assert isinstance(node, basicrt.TranslucentShader)
    assert node.color == COLOR


@pytest.mark.parametrize("model", ["MICROFIBER", "ASHIKHMIN"])
def test_sheen(model: str) -> None:
    material = new_material("ShaderNodeBsdfSheen", Color=COLOR, Roughness=0.25)
    find_node(material, "ShaderNodeBsdfSheen").distribution = model
    node = only_node(material)
    assert isinstance(node, basicrt.SheenShader)
    assert (node.color, node.roughness, node.model) == (COLOR, 0.25, model.lower())


@pytest.mark.parametrize("component", ["DIFFUSE", "GLOSSY"])
def test_toon(component: str) -> None:
    material = new_material("ShaderNodeBsdfToon", Color=COLOR, Size=0.25, Smooth=0.125)
    find_node(material, "ShaderNodeBsdfToon").component = component
    node = only_node(material)
    assert isinstance(node, basicrt.ToonShader)
    assert (node.color, node.size, node.smooth) == (COLOR, 0.25, 0.125)
    assert node.component == component.lower()


def test_glossy_is_stretched_around_z() -> None:
    node = only_node(
        new_material("ShaderNodeBsdfAnisotropic", Anisotropy=-0.5, Rotation=0.25, Roughness=0.5)
    )
    assert (node.anisotropy, node.rotation, node.tangent) == (-0.5, 0.25, "radial_z")


@pytest.mark.parametrize(
    ("direction", "axis", "ours"), [("RADIAL", "X", "radial_x"), ("UV_MAP", "Z", "uv")]
)
def test_tangents(direction: str, axis: str, ours: str) -> None:
    material, tree, output = empty_material()
    node = add_node(tree, "ShaderNodeBsdfAnisotropic", Anisotropy=0.5)
    tangent = tree.nodes.new("ShaderNodeTangent")
    tangent.direction_type, tangent.axis = direction, axis
    tree.links.new(tangent.outputs[0], node.inputs["Tangent"])
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    assert only_node(material).tangent == ours


needs_metallic_node = pytest.mark.skipif(
    bpy.app.version < (4, 3, 0), reason="the Metallic BSDF came with 4.3"
)


@needs_metallic_node
def test_metallic() -> None:
    node = only_node(
        new_material(
            "ShaderNodeBsdfMetallic",
            Base_Color=COLOR,
            Edge_Tint=COLOR,
            Roughness=0.25,
            Anisotropy=0.5,
            Rotation=0.125,
        )
    )
    assert isinstance(node, basicrt.MetallicShader)
    assert (node.model, node.base_color, node.edge_tint) == ("f82", COLOR, COLOR)
    assert (node.roughness, node.anisotropy, node.rotation) == (0.25, 0.5, 0.125)


@needs_metallic_node
def test_measured_metal() -> None:
    material = new_material(
        "ShaderNodeBsdfMetallic", IOR=(0.25, 0.5, 1.5), Extinction=(3.0, 2.5, 2.0)
    )
    find_node(material, "ShaderNodeBsdfMetallic").fresnel_type = "PHYSICAL_CONDUCTOR"
    node = only_node(material)
    assert node.model == "physical_conductor"
    assert (node.ior, node.extinction) == ((0.25, 0.5, 1.5), (3, 2.5, 2))


def test_transparent() -> None:
    node = only_node(new_material("ShaderNodeBsdfTransparent", Color=COLOR))
    assert isinstance(node, basicrt.TransparentShader)
    assert node.color == COLOR


def test_emission_is_colour_times_strength_on_both_sides() -> None:
    node = only_node(new_material("ShaderNodeEmission", Color=COLOR, Strength=4.0))
    assert isinstance(node, basicrt.EmissionShader)
    assert node.radiance == (1, 2, 3)
    assert node.twosided


def test_principled() -> None:
    node = only_node(
        new_material(
            "ShaderNodeBsdfPrincipled",
            Base_Color=COLOR,
            Metallic=0.125,
            Roughness=0.25,
            IOR=1.75,
            Transmission_Weight=0.375,
            Specular_IOR_Level=0.625,
            Emission_Color=COLOR,
            Emission_Strength=2.0,
            Alpha=0.5,
        )
    )
    assert isinstance(node, basicrt.PrincipledShader)
    assert node.base_color == COLOR
    assert (node.metallic, node.roughness, node.ior) == (0.125, 0.25, 1.75)
    assert (node.transmission, node.specular_ior_level, node.alpha) == (0.375, 0.625, 0.5)
    assert node.emission == (0.5, 1, 1.5)


def test_principled_layers() -> None:
    node = only_node(
        new_material(
            "ShaderNodeBsdfPrincipled",
            Specular_Tint=COLOR,
            Anisotropic=0.5,
            Anisotropic_Rotation=0.25,
            Sheen_Weight=0.125,
            Sheen_Roughness=0.25,
            Sheen_Tint=COLOR,
            Coat_Weight=0.375,
            Coat_Roughness=0.5,
            Coat_IOR=1.25,
            Coat_Tint=COLOR,
            Thin_Film_Thickness=300.0,
            Thin_Film_IOR=1.75,
        )
    )
    assert (node.specular_tint, node.sheen_tint, node.coat_tint) == (COLOR, COLOR, COLOR)
    assert (node.anisotropic, node.anisotropic_rotation, node.tangent) == (0.5, 0.25, "radial_z")
    assert (node.sheen_weight, node.sheen_roughness) == (0.125, 0.25)
    assert (node.coat_weight, node.coat_roughness, node.coat_ior) == (0.375, 0.5, 1.25)
    assert (node.thin_film_thickness, node.thin_film_ior) == (300, 1.75)


def test_factory_principled_needs_no_warning() -> None:
    node = only_node(new_material("ShaderNodeBsdfPrincipled"))
    assert node.emission == (0, 0, 0)


@pytest.mark.parametrize(
    ("bl_idname", "ours"),
    [("ShaderNodeMixShader", basicrt.MixShader), ("ShaderNodeAddShader", basicrt.AddShader)],
)
def test_mix_and_add_refer_to_both_inputs(bl_idname: str, ours: type) -> None:
    material, tree, output = empty_material()
    both = tree.nodes.new(bl_idname)
    sockets = [socket for socket in both.inputs if socket.type == "SHADER"]
    first = add_node(tree, "ShaderNodeBsdfDiffuse", Color=COLOR)
    second = add_node(tree, "ShaderNodeEmission", Color=COLOR)
    tree.links.new(first.outputs[0], sockets[0])
    tree.links.new(second.outputs[0], sockets[1])
    tree.links.new(both.outputs[0], output.inputs["Surface"])
    if ours is basicrt.MixShader:
        both.inputs[0].default_value = 0.25
    made = translate(material)
    top = made.nodes[made.surface]
    assert isinstance(top, ours)
    assert isinstance(made.nodes[top.first], basicrt.DiffuseShader)
    assert isinstance(made.nodes[top.second], basicrt.EmissionShader)
    if ours is basicrt.MixShader:
        assert top.factor == 0.25


def test_empty_input_of_mix_stays_empty() -> None:
    material, tree, output = empty_material()
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    node = only_node(material)
    assert (node.first, node.second) == (None, None)


def test_shader_used_twice_is_translated_once() -> None:
    material, tree, output = empty_material()
    both = tree.nodes.new("ShaderNodeAddShader")
    shared = add_node(tree, "ShaderNodeEmission", Strength=1.0)
    tree.links.new(shared.outputs[0], both.inputs[0])
    tree.links.new(shared.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], output.inputs["Surface"])
    made = translate(material)
    assert len(made.nodes) == 2
    assert (made.nodes[1].first, made.nodes[1].second) == (0, 0)


def test_nothing_linked_is_black() -> None:
    made = translate(empty_material()[0])
    assert made.surface is None


def test_colour_linked_to_the_surface_shines() -> None:
    material, tree, output = empty_material()
    color = tree.nodes.new("ShaderNodeRGB")
    color.outputs[0].default_value = (*COLOR, 1)
    tree.links.new(color.outputs[0], output.inputs["Surface"])
    node = only_node(material)
    assert isinstance(node, basicrt.EmissionShader)
    assert node.radiance == COLOR


@pytest.mark.skipif(bpy.app.version >= (5, 0, 0), reason="a material always has nodes from 5.0 on")
def test_without_nodes_the_viewport_colour_counts() -> None:
    material = bpy.data.materials.new("Plain")
    material.use_nodes = False
    material.diffuse_color = (*COLOR, 1)
    assert only_node(material).color == COLOR


def test_only_the_active_output_counts() -> None:
    material, tree, output = empty_material()
    first = add_node(tree, "ShaderNodeBsdfDiffuse", Color=(0, 0, 0))
    tree.links.new(first.outputs[0], output.inputs["Surface"])
    other = tree.nodes.new("ShaderNodeOutputMaterial")
    second = add_node(tree, "ShaderNodeBsdfDiffuse", Color=COLOR)
    tree.links.new(second.outputs[0], other.inputs["Surface"])
    output.is_active_output = False
    other.is_active_output = True
    assert only_node(material).color == COLOR


# ---- values ------------------------------------------------------------------------------------


def diffuse_with(link: Any) -> Any:
    """A diffuse material; `link(tree, color_input)` feeds its colour."""
    material, tree, output = empty_material()
    diffuse = add_node(tree, "ShaderNodeBsdfDiffuse", Color=(1, 1, 1))
    tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    link(tree, diffuse.inputs["Color"])
    return material


def rgb(tree: Any) -> Any:
    node = tree.nodes.new("ShaderNodeRGB")
    node.outputs[0].default_value = (*COLOR, 1)
    return node.outputs[0]


def test_rgb_node_gives_its_colour() -> None:
    assert (
        only_node(diffuse_with(lambda tree, socket: tree.links.new(rgb(tree), socket))).color
        == COLOR
    )


def test_value_node_gives_grey_and_numbers() -> None:
    def link(tree: Any, socket: Any) -> None:
        value = tree.nodes.new("ShaderNodeValue")
        value.outputs[0].default_value = 0.375
        tree.links.new(value.outputs[0], socket)

    assert only_node(diffuse_with(link)).color == (0.375, 0.375, 0.375)


def test_colour_becomes_a_number_by_luminance() -> None:
    material, tree, output = empty_material()
    glossy = add_node(tree, "ShaderNodeBsdfAnisotropic")
    tree.links.new(rgb(tree), glossy.inputs["Roughness"])
    tree.links.new(glossy.outputs[0], output.inputs["Surface"])
    expected = 0.2126 * COLOR[0] + 0.7152 * COLOR[1] + 0.0722 * COLOR[2]
    assert only_node(material).roughness == pytest.approx(expected, rel=1e-4)


def test_unsupported_texture_leaves_the_sockets_own_value() -> None:
    def link(tree: Any, socket: Any) -> None:
        socket.default_value = (*COLOR, 1)
        tree.links.new(tree.nodes.new("ShaderNodeVolumeInfo").outputs[0], socket)

    warning = 'node "Diffuse BSDF": Color is linked to "Volume Info", which is not supported: its own value is used'
    assert only_node(diffuse_with(link), warning).color == COLOR


def test_a_setting_of_a_newer_blender_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    def unknown(_of: Any, _output: str) -> None:
        basicrt.VectorMathOperation(operation="entangle")

    def link(tree: Any, socket: Any) -> None:
        socket.default_value = (*COLOR, 1)
        node = tree.nodes.new("ShaderNodeVectorMath")
        position = tree.nodes.new("ShaderNodeNewGeometry").outputs["Position"]
        tree.links.new(position, node.inputs[0])
        tree.links.new(node.outputs[0], socket)

    monkeypatch.setitem(OPERATIONS, "ShaderNodeVectorMath", unknown)
    warning = 'node "Diffuse BSDF": Color is linked to "Vector Math", which is not supported: its own value is used'
    assert only_node(diffuse_with(link), warning).color == COLOR


def test_colours_that_reflect_too_much_are_limited() -> None:
    material = new_material("ShaderNodeBsdfDiffuse", Color=(2, 0.5, -1))
    warning = 'node "Diffuse BSDF": Color reflects more light than it receives: limited to 1'
    assert only_node(material, warning).color == (1, 0.5, 0)


# ---- what stands between nodes -----------------------------------------------------------------


def new_group(color_default: tuple[float, float, float]) -> Any:
    """A node group: Color in, a diffuse shader behind a reroute out."""
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    socket = group.interface.new_socket("Color", in_out="INPUT", socket_type="NodeSocketColor")
    socket.default_value = (*color_default, 1)
    group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    source, sink = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    diffuse, reroute = group.nodes.new("ShaderNodeBsdfDiffuse"), group.nodes.new("NodeReroute")
    group.links.new(source.outputs[0], reroute.inputs[0])
    group.links.new(reroute.outputs[0], diffuse.inputs["Color"])
    group.links.new(diffuse.outputs[0], sink.inputs[0])
    return group


def group_material(group: Any) -> tuple[Any, Any, Any]:
    material, tree, output = empty_material()
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material, tree, node


def test_group_takes_the_value_of_its_own_socket() -> None:
    material, _tree, node = group_material(new_group((1, 1, 1)))
    node.inputs[0].default_value = (*COLOR, 1)
    assert only_node(material).color == COLOR


def test_group_takes_what_is_linked_to_it() -> None:
    material, tree, node = group_material(new_group((1, 1, 1)))
    tree.links.new(rgb(tree), node.inputs[0])
    assert only_node(material).color == COLOR


def test_group_within_a_group() -> None:
    outer = bpy.data.node_groups.new("Outer", "ShaderNodeTree")
    outer.interface.new_socket("Color", in_out="INPUT", socket_type="NodeSocketColor")
    outer.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    source, sink = outer.nodes.new("NodeGroupInput"), outer.nodes.new("NodeGroupOutput")
    inner = outer.nodes.new("ShaderNodeGroup")
    inner.node_tree = new_group((1, 1, 1))
    outer.links.new(source.outputs[0], inner.inputs[0])
    outer.links.new(inner.outputs[0], sink.inputs[0])
    material, tree, node = group_material(outer)
    tree.links.new(rgb(tree), node.inputs[0])
    assert only_node(material).color == COLOR


def test_the_same_group_twice_gives_two_shaders() -> None:
    group = new_group((1, 1, 1))
    material, tree, output = empty_material()
    both = tree.nodes.new("ShaderNodeAddShader")
    for index, color in enumerate((COLOR, (0, 0.5, 0))):
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        node.inputs[0].default_value = (*color, 1)
        tree.links.new(node.outputs[0], both.inputs[index])
    tree.links.new(both.outputs[0], output.inputs["Surface"])
    made = translate(material)
    top = made.nodes[made.surface]
    assert made.nodes[top.first].color == COLOR
    assert made.nodes[top.second].color == (0, 0.5, 0)


def test_muted_node_hands_its_input_on() -> None:
    def link(tree: Any, socket: Any) -> None:
        invert = tree.nodes.new("ShaderNodeInvert")
        invert.mute = True
        tree.links.new(rgb(tree), invert.inputs["Color"])
        tree.links.new(invert.outputs[0], socket)

    assert only_node(diffuse_with(link)).color == COLOR


def test_muted_mix_shader_hands_a_shader_on() -> None:
    material, tree, output = empty_material()
    mix = tree.nodes.new("ShaderNodeMixShader")
    mix.mute = True
    diffuse = add_node(tree, "ShaderNodeBsdfDiffuse", Color=COLOR)
    tree.links.new(diffuse.outputs[0], mix.inputs[1])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    assert only_node(material).color == COLOR


def test_chain_of_reroutes() -> None:
    def link(tree: Any, socket: Any) -> None:
        output = rgb(tree)
        for _ in range(3):
            reroute = tree.nodes.new("NodeReroute")
            tree.links.new(output, reroute.inputs[0])
            output = reroute.outputs[0]
        tree.links.new(output, socket)

    assert only_node(diffuse_with(link)).color == COLOR


# ---- subsurface scattering ---------------------------------------------------------------------

WALK = "van_de_hulst" if bpy.app.version >= (5, 2) else "chiang"


@pytest.mark.parametrize(
    ("method", "model", "warning"),
    [
        ("RANDOM_WALK", WALK, None),
        ("RANDOM_WALK_SKIN", "skin", None),
        ("BURLEY", "chiang", "Christensen-Burley is drawn as Random Walk"),
    ],
)
def test_subsurface_scattering(method: str, model: str, warning: str | None) -> None:
    material = new_material(
        "ShaderNodeSubsurfaceScattering",
        Color=COLOR,
        Radius=(0.5, 0.2, 0.1),
        Scale=0.3,
        IOR=1.3,
        Roughness=0.4,
        Anisotropy=0.2,
    )
    bsdf: Any = next(n for n in material.node_tree.nodes if "Subsurface" in n.bl_idname)
    bsdf.falloff = method
    node = only_node(material, *([f'node "{bsdf.name}": {warning}'] if warning else []))
    assert isinstance(node, basicrt.SubsurfaceShader)
    assert (node.color, node.model) == (pytest.approx(COLOR), model)
    assert node.radius == pytest.approx((0.5, 0.2, 0.1))
    assert (node.scale, node.ior, node.alpha, node.anisotropy) == pytest.approx(
        (0.3, 1.3, 0.4, 0.2)
    )


def test_principled_subsurface_scattering() -> None:
    material = new_material(
        "ShaderNodeBsdfPrincipled",
        Base_Color=COLOR,
        Subsurface_Weight=0.5,
        Subsurface_Radius=(0.5, 0.2, 0.1),
        Subsurface_Scale=0.3,
        Subsurface_Anisotropy=0.2,
    )
    bsdf: Any = next(n for n in material.node_tree.nodes if "Principled" in n.bl_idname)
    bsdf.subsurface_method = "RANDOM_WALK_SKIN"
    bsdf.inputs["Subsurface IOR"].default_value = 1.6
    node = only_node(material)
    assert node.subsurface_model == "skin"
    assert node.subsurface_radius == pytest.approx((0.5, 0.2, 0.1))
    assert (
        node.subsurface_weight,
        node.subsurface_scale,
        node.subsurface_ior,
        node.subsurface_anisotropy,
    ) == pytest.approx((0.5, 0.3, 1.6, 0.2))


# ---- what is not supported ---------------------------------------------------------------------


@pytest.mark.parametrize(
    ("bl_idname", "ours"),
    [
        ("ShaderNodeBsdfRayPortal", basicrt.TransparentShader),
    ],
)
def test_similar_shaders_stand_in(bl_idname: str, ours: type) -> None:
    material = new_material(bl_idname, Color=COLOR)
    report = Report()
    made = translate_surface(material, report, Textures(basicrt.Scene()))
    assert isinstance(made.nodes[made.surface], ours)
    assert made.nodes[made.surface].color == COLOR
    assert len(report.warnings) == 1
    assert "not supported: drawn as a" in report.warnings[0]


def test_hair_is_translated() -> None:
    material = new_material("ShaderNodeBsdfHairPrincipled", Melanin=0.4, Offset=0.1)
    node = find_node(material, "ShaderNodeBsdfHairPrincipled")
    node.model, node.parametrization = "CHIANG", "MELANIN"
    made = only_node(material)
    assert isinstance(made, basicrt.PrincipledHairShader)
    assert (made.parametrization, made.melanin) == ("melanin", pytest.approx(0.4))
    node.model = "HUANG"
    only_node(material, 'node "Principled Hair BSDF": the model Huang is drawn as Chiang')
    material = new_material("ShaderNodeBsdfHair", Color=COLOR)
    made = only_node(material)
    assert isinstance(made, basicrt.HairShader)
    assert made.component == "reflection"


def test_unknown_shader_is_grey() -> None:
    material = new_material("ShaderNodeEeveeSpecular")
    node = only_node(material, 'node "Specular BSDF" is not supported: drawn as diffuse grey')
    assert node.color == pytest.approx((0.8, 0.8, 0.8))


def test_warnings_come_once_for_each_item() -> None:
    report = Report()
    for _ in range(2):
        material = new_material("ShaderNodeBsdfRayPortal", name="Wax")
        translate_surface(material, report, Textures(basicrt.Scene()))
        translate_surface(material, report, Textures(basicrt.Scene()))
    assert len(report.warnings) == 2, "one for each of the two materials"
