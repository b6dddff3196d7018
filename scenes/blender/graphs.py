# SPDX-License-Identifier: GPL-3.0-or-later
"""More families of small scenes, of materials that are graphs of nodes: see families.py."""

from __future__ import annotations

import math
import random
from typing import Any

import bpy
import stage
import strands
from families import SCENES, ceiling_lamp, corner, family

assert SCENES
assert strands


class Graph:
    """A material in the making."""

    def __init__(self, name: str, tree: Any = None) -> None:
        self.material: Any = None
        if tree is None:
            self.material, tree, self.output = stage.empty_material(name)
        self.tree: Any = tree

    def node(self, bl_idname: str, settings: dict[str, Any] | None = None, **inputs: Any) -> Any:
        """A node; inputs by identifier, underscores for spaces, are values or other nodes' outputs."""
        node = self.tree.nodes.new("ShaderNode" + bl_idname)
        for name, value in (settings or {}).items():
            setattr(node, name, value)
        by_identifier = {socket.identifier.replace(" ", "_"): socket for socket in node.inputs}
        for name, value in inputs.items():
            socket = by_identifier[name]
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            else:
                socket.default_value = (*value, 1.0) if socket.type == "RGBA" else value
        return node

    def coordinates(self, kind: str) -> Any:
        """An output of Texture Coordinate."""
        return self.node("TexCoord").outputs[kind]

    def math(self, operation: str, *values: Any) -> Any:
        """A number of others."""
        names = ("Value", "Value_001", "Value_002")
        return self.node(
            "Math", {"operation": operation}, **dict(zip(names, values, strict=False))
        ).outputs[0]

    def ramp(self, factor: Any, *stops: tuple[float, stage.Color]) -> Any:
        """A colour by a number."""
        node = self.node("ValToRGB", Fac=factor)
        elements = node.color_ramp.elements
        while len(elements) < len(stops):
            elements.new(0.5)
        for element, (place, color) in zip(elements, stops, strict=True):
            element.position, element.color = place, (*color, 1.0)
        return node.outputs["Color"]

    def finish(self, shader: Any) -> bpy.types.Material:
        """The material with that surface."""
        self.tree.links.new(shader.outputs[0], self.output.inputs["Surface"])
        return self.material


def cover(name: str, material: bpy.types.Material) -> None:
    """The material in place of an object's own."""
    bpy.data.objects[name].data.materials[0] = material


@family
def noisy_paint(scene: bpy.types.Scene) -> None:
    """Noise in colours and in the roughness of a Principled BSDF."""
    graph = Graph("Paint")
    noise = graph.node("TexNoise", Vector=graph.coordinates("Object"), Scale=4.0, Detail=5.0)
    color = graph.ramp(
        noise.outputs[0], (0.3, (0.1, 0.05, 0.02)), (0.5, (0.8, 0.5, 0.1)), (0.7, (0.2, 0.3, 0.7))
    )
    rough = graph.node(
        "MapRange", Value=noise.outputs[0], From_Min=0.3, From_Max=0.7, To_Min=0.15, To_Max=0.7
    )
    corner(
        scene,
        graph.finish(
            graph.node("BsdfPrincipled", Base_Color=color, Roughness=rough.outputs["Result"])
        ),
    )
    ceiling_lamp()
    stage.set_world((0.2, 0.25, 0.3))


@family
def brick_wall(scene: bpy.types.Scene) -> None:
    """Bricks on the wall, checks on the floor, marble on the ball."""
    graph = Graph("Bricks")
    place = graph.node("NewGeometry").outputs["Position"]
    turned = graph.node(
        "Mapping", Vector=place, Rotation=(math.pi / 2, 0, 0), Scale=(0.4, 0.4, 0.4)
    )
    bricks = graph.node("TexBrick", Vector=turned.outputs[0], Color1=(0.5, 0.15, 0.1))
    marble = Graph("Marble")
    wave = marble.node(
        "TexWave", Vector=marble.coordinates("Object"), Scale=1.5, Distortion=6.0, Detail=3.0
    )
    veins = marble.ramp(wave.outputs["Fac"], (0.2, (0.05, 0.06, 0.08)), (0.8, (0.8, 0.8, 0.75)))
    corner(scene, marble.finish(marble.node("BsdfPrincipled", Base_Color=veins, Roughness=0.3)))
    cover("Wall", graph.finish(graph.node("BsdfDiffuse", Color=bricks.outputs["Color"])))
    tiles = Graph("Tiles")
    checks = tiles.node(
        "TexChecker",
        Vector=tiles.node("NewGeometry").outputs["Position"],
        Color1=(0.7, 0.7, 0.6),
        Color2=(0.1, 0.2, 0.2),
        Scale=1.7,
    )
    cover("Floor", tiles.finish(tiles.node("BsdfDiffuse", Color=checks.outputs["Color"])))
    ceiling_lamp()


@family
def bumpy_things(scene: bpy.types.Scene) -> None:
    """Bumps under diffuse and glossy light, near and grazing."""
    graph = Graph("Dented")
    dents = graph.node("TexVoronoi", Vector=graph.coordinates("Object"), Scale=4.0)
    bump = graph.node("Bump", Height=dents.outputs["Distance"], Strength=0.6, Distance=0.1)
    dented = graph.node(
        "BsdfPrincipled", Base_Color=(0.7, 0.3, 0.2), Roughness=0.5, Normal=bump.outputs[0]
    )
    corner(scene, graph.finish(dented))
    rough = Graph("Plaster")
    grain = rough.node("TexNoise", Vector=rough.coordinates("Object"), Scale=3.0, Detail=1.0)
    bump = rough.node("Bump", Height=grain.outputs[0], Strength=0.8, Distance=0.3)
    plaster = rough.node("BsdfDiffuse", Color=(0.7, 0.7, 0.65), Normal=bump.outputs[0])
    material = rough.finish(plaster)
    for name in ("Wall", "Floor", "Box"):
        cover(name, material)
    stage.lamp("SUN", "Sun", (0, 0, 3), (65, -20, 0), 2.0, angle=0.05)
    ceiling_lamp()


@family
def cracked_cells(scene: bpy.types.Scene) -> None:
    """Voronoi cells of several shaders, mixed."""
    graph = Graph("Cells")
    place = graph.coordinates("Object")
    edges = graph.node("TexVoronoi", {"feature": "DISTANCE_TO_EDGE"}, Vector=place, Scale=3.0)
    cells = graph.node("TexVoronoi", Vector=place, Scale=3.0)
    is_crack = graph.math("LESS_THAN", edges.outputs["Distance"], 0.04)
    stone = graph.node("BsdfDiffuse", Color=cells.outputs["Color"])
    gold = graph.node("BsdfAnisotropic", Color=(0.9, 0.6, 0.2), Roughness=0.25)
    mixed = graph.node(
        "MixShader", Fac=is_crack, Shader=stone.outputs[0], Shader_001=gold.outputs[0]
    )
    corner(scene, graph.finish(mixed))
    ceiling_lamp(size=2.0)
    stage.set_world((0.2, 0.2, 0.2))


@family
def cut_leaves(scene: bpy.types.Scene) -> None:
    """Alpha and coloured transparency by patterns, and their shadows."""
    corner(scene)
    graph = Graph("Leaf")
    spots = graph.node("TexVoronoi", Vector=graph.coordinates("Generated"), Scale=5.0)
    alpha = graph.math("GREATER_THAN", spots.outputs["Distance"], 0.35)
    leaf = graph.finish(
        graph.node("BsdfPrincipled", Base_Color=(0.1, 0.5, 0.1), Roughness=0.5, Alpha=alpha)
    )
    stained = Graph("Stained")
    color = stained.node("TexMagic", Vector=stained.coordinates("Generated"), Scale=3.0)
    window = stained.finish(stained.node("BsdfTransparent", Color=color.outputs["Color"]))
    stage.rectangle("Leaf", [(-2, -1.5, 1.6), (0, -1.5, 1.6), (0, 0.5, 1.9), (-2, 0.5, 1.9)], leaf)
    stage.rectangle(
        "Window", [(0.2, -1.4, 0), (1.6, -1.6, 0), (1.6, -1.6, 1.2), (0.2, -1.4, 1.2)], window
    )
    stage.lamp("SUN", "Sun", (0, 0, 3), (35, -20, 0), 3.0, angle=0.02)
    stage.set_world((0.1, 0.12, 0.15))


@family
def cloth(scene: bpy.types.Scene) -> None:
    """Sheen, a translucent curtain, weights by the angle of view."""
    graph = Graph("Cloth")
    weight = graph.node("LayerWeight", Blend=0.3).outputs["Facing"]
    color = graph.node("MixRGB", Fac=weight, Color1=(0.4, 0.05, 0.1), Color2=(0.9, 0.6, 0.6))
    sheen = graph.node(
        "BsdfPrincipled",
        Base_Color=color.outputs[0],
        Roughness=graph.math("MULTIPLY_ADD", weight, -0.4, 0.9),
        Sheen_Weight=weight,
    )
    corner(scene, graph.finish(sheen))
    curtain = Graph("Curtain")
    folds = curtain.node("TexWave", Vector=curtain.coordinates("Generated"), Scale=2.0)
    halves = curtain.node(
        "MixShader",
        Fac=0.6,
        Shader=curtain.node("BsdfDiffuse", Color=(0.7, 0.6, 0.5)).outputs[0],
        Shader_001=curtain.node("BsdfTranslucent", Color=folds.outputs["Color"]).outputs[0],
    )
    corners = [(-2.5, -0.8, 0), (-1.2, -0.2, 0), (-1.2, -0.2, 2.2), (-2.5, -0.8, 2.2)]
    stage.rectangle("Curtain", corners, curtain.finish(halves))
    ceiling_lamp()
    stage.lamp("POINT", "Bulb", (-2.2, 0.6, 1), (0, 0, 0), 40.0, shadow_soft_size=0.1)


@family
def wax_and_skin(scene: bpy.types.Scene) -> None:
    """Subsurface scattering: a bumpy ball, a box under a coat, a thin leaf with light behind it."""
    graph = Graph("Skin")
    grain = graph.node("TexNoise", Vector=graph.coordinates("Object"), Scale=6.0, Detail=2.0)
    bump = graph.node("Bump", Height=grain.outputs[0], Strength=0.4, Distance=0.1)
    color = graph.ramp(grain.outputs[0], (0.3, (0.9, 0.5, 0.35)), (0.7, (0.6, 0.15, 0.1)))
    skin = graph.node(
        "BsdfPrincipled",
        Base_Color=color,
        Roughness=0.5,
        Subsurface_Weight=0.8,
        Subsurface_Scale=0.2,
        Normal=bump.outputs[0],
    )
    corner(scene, graph.finish(skin))
    wax = Graph("Wax")
    cover(
        "Box",
        wax.finish(
            wax.node(
                "BsdfPrincipled",
                {"subsurface_method": "RANDOM_WALK_SKIN"},
                Base_Color=(0.8, 0.7, 0.3),
                Subsurface_Weight=1.0,
                Subsurface_Radius=(1.0, 0.7, 0.4),
                Subsurface_Scale=0.3,
                Coat_Weight=0.5,
            )
        ),
    )
    leaf = Graph("Leaf")
    stage.box(
        "Leaf",
        (1.2, 0.05, 1.4),
        (-0.3, -1.3, 0),
        -10,
        leaf.finish(
            leaf.node(
                "SubsurfaceScattering",
                {"falloff": "RANDOM_WALK"},
                Color=(0.3, 0.7, 0.2),
                Radius=(0.4, 1.0, 0.3),
                Anisotropy=0.4,
                Scale=0.5,
            )
        ),
    )
    ceiling_lamp()
    stage.lamp("POINT", "Bulb", (-0.4, -0.7, 1.2), (0, 0, 0), 15.0, shadow_soft_size=0.1)


@family
def frosted_glass(scene: bpy.types.Scene) -> None:
    """Glass with a roughness and an index that vary."""
    graph = Graph("Glass")
    bands = graph.node("TexGradient", Vector=graph.coordinates("Generated")).outputs["Fac"]
    stripes = graph.math("PINGPONG", graph.math("MULTIPLY", bands, 3.0), 0.5)
    glass = graph.node(
        "BsdfGlass",
        Color=(0.9, 1.0, 0.95),
        Roughness=graph.math("MULTIPLY_ADD", stripes, 0.5, 0.25),
        IOR=graph.math("MULTIPLY_ADD", bands, 0.4, 1.2),
    )
    corner(scene, graph.finish(glass))
    ceiling_lamp(size=2.5)
    stage.set_world((0.3, 0.3, 0.3))


@family
def many_of_a_kind(scene: bpy.types.Scene) -> None:
    """Copies that differ by Object Info."""
    corner(scene)
    graph = Graph("Own Colour")
    info = graph.node("ObjectInfo")
    hue = graph.math("FRACT", graph.math("MULTIPLY", info.outputs["Object Index"], 0.37))
    color = graph.node(
        "CombineColor", {"mode": "HSV"}, Red=hue, Green=0.7, Blue=info.outputs["Color"]
    )
    material = graph.finish(graph.node("BsdfDiffuse", Color=color.outputs[0]))
    first = stage.box("Brick 0", (0.3, 0.3, 0.3), (-1.5, -1.5, 0), 0, material)
    for index in range(1, 8):
        copy = stage.place(
            first.data, f"Brick {index}", (-1.5 + 0.45 * index, -1.5 + 0.1 * (index % 3), 0)
        )
        copy.pass_index = index
        copy.color = (0.2 + 0.1 * index, 0.5, 0.5, 1)
    ceiling_lamp()


@family
def paths_told_apart(scene: bpy.types.Scene) -> None:
    """Light Path: what the camera sees is not what lights the room."""
    graph = Graph("Told Apart")
    is_camera = graph.node("LightPath").outputs["Is Camera Ray"]
    color = graph.node("MixRGB", Fac=is_camera, Color1=(0.9, 0.1, 0.1), Color2=(0.1, 0.2, 0.9))
    corner(scene, graph.finish(graph.node("BsdfDiffuse", Color=color.outputs[0])))
    pane = Graph("No Shadow")
    clear = pane.node(
        "MixShader",
        Fac=pane.node("LightPath").outputs["Is Shadow Ray"],
        Shader=pane.node("BsdfDiffuse", Color=(0.3, 0.6, 0.3)).outputs[0],
        Shader_001=pane.node("BsdfTransparent").outputs[0],
    )
    cover("Box", pane.finish(clear))
    ceiling_lamp()


@family
def glowing_pictures(scene: bpy.types.Scene) -> None:
    """Nothing shines but surfaces that do so here and there: a screen, a ball with cracks, a sign."""
    corner(scene, _embers())
    screen = Graph("Screen")
    image = bpy.data.images.new("Windows", 16, 8, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    pixels = [0.0] * (16 * 8 * 4)
    numbers = random.Random(11)
    for index in range(16 * 8):
        lit = numbers.random() < 0.2
        color = [numbers.uniform(2.0, 9.0) if lit else 0.02 for _ in range(3)]
        pixels[4 * index : 4 * index + 4] = [*color, 1.0]
    image.pixels.foreach_set(pixels)
    image.pack()
    texture = screen.node("TexImage", {"image": image, "interpolation": "Closest"})
    stage.rectangle(
        "Screen",
        [(-2.5, -1.5, 0.2), (-1.5, 0.5, 0.2), (-1.5, 0.5, 1.8), (-2.5, -1.5, 1.8)],
        screen.finish(screen.node("Emission", Color=texture.outputs["Color"])),
    )
    sign = Graph("Sign")
    stripes = sign.node("TexWave", Vector=sign.coordinates("Object"), Scale=2.0)
    stage.rectangle(
        "Sign",
        [(0.5, 1.5, 2.2), (2.5, 1.5, 2.2), (2.5, 1.5, 3.0), (0.5, 1.5, 3.0)],
        sign.finish(
            sign.node(
                "BsdfPrincipled",
                Emission_Color=stripes.outputs["Color"],
                Emission_Strength=3.0,
            )
        ),
    )


def _embers() -> bpy.types.Material:
    graph = Graph("Embers")
    cells = graph.node(
        "TexVoronoi", {"feature": "DISTANCE_TO_EDGE"}, Vector=graph.coordinates("Object"), Scale=3.0
    )
    glow = graph.ramp(cells.outputs["Distance"], (0.02, (1.0, 0.3, 0.05)), (0.08, (0.0, 0.0, 0.0)))
    return graph.finish(
        graph.node(
            "BsdfPrincipled",
            Base_Color=(0.05, 0.05, 0.05),
            Emission_Color=glow,
            Emission_Strength=8.0,
        )
    )


@family
def nested_groups(scene: bpy.types.Scene) -> None:
    """Two hundred nodes, most of them in groups within groups."""
    group = _layer_group()
    graph = Graph("Layers")
    place = graph.coordinates("Object")
    color: Any = (0.5, 0.4, 0.3)
    for index in range(12):
        layer = graph.node("Group")
        layer.node_tree = group
        layer.inputs["Seed"].default_value = 1.7 * index
        graph.tree.links.new(place, layer.inputs["Place"])
        if index == 0:
            layer.inputs["Color"].default_value = (*color, 1.0)
        else:
            graph.tree.links.new(color, layer.inputs["Color"])
        color = layer.outputs["Color"]
    corner(scene, graph.finish(graph.node("BsdfPrincipled", Base_Color=color, Roughness=0.4)))
    ceiling_lamp()
    stage.set_world((0.2, 0.2, 0.2))


def _layer_group() -> Any:
    """Spots over a colour; the spots' shape is a group of its own, of some fifteen nodes."""
    inner: Any = bpy.data.node_groups.new("Spots", "ShaderNodeTree")
    for name, kind in (("Place", "NodeSocketVector"), ("Seed", "NodeSocketFloat")):
        inner.interface.new_socket(name, in_out="INPUT", socket_type=kind)
    inner.interface.new_socket("Share", in_out="OUTPUT", socket_type="NodeSocketFloat")
    graph = Graph("Spots", inner)
    source = inner.nodes.new("NodeGroupInput")
    noise = graph.node(
        "TexNoise",
        {"noise_dimensions": "4D"},
        Vector=source.outputs["Place"],
        W=source.outputs["Seed"],
        Scale=3.0,
        Detail=1.0,
    )
    value = noise.outputs[0]
    numbers = random.Random(5)
    for operation in ("MULTIPLY_ADD", "PINGPONG", "SINE", "ABSOLUTE", "POWER", "MINIMUM") * 2:
        value = graph.math(operation, value, numbers.uniform(0.6, 1.4), 0.1)
    share = graph.node("Clamp", Value=value).outputs[0]
    inner.links.new(share, inner.nodes.new("NodeGroupOutput").inputs["Share"])

    outer: Any = bpy.data.node_groups.new("Layer", "ShaderNodeTree")
    for name, kind in (
        ("Place", "NodeSocketVector"),
        ("Seed", "NodeSocketFloat"),
        ("Color", "NodeSocketColor"),
    ):
        outer.interface.new_socket(name, in_out="INPUT", socket_type=kind)
    outer.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
    graph = Graph("Layer", outer)
    source = outer.nodes.new("NodeGroupInput")
    spots = graph.node("Group")
    spots.node_tree = inner
    for name in ("Place", "Seed"):
        outer.links.new(source.outputs[name], spots.inputs[name])
    hue = graph.math("FRACT", graph.math("MULTIPLY", source.outputs["Seed"], 0.21))
    spot_color = graph.node("CombineColor", {"mode": "HSV"}, Red=hue, Green=0.6, Blue=0.6)
    mixed = graph.node(
        "MixRGB",
        Fac=graph.math("MULTIPLY", spots.outputs["Share"], 0.4),
        Color1=source.outputs["Color"],
        Color2=spot_color.outputs[0],
    )
    outer.links.new(mixed.outputs[0], outer.nodes.new("NodeGroupOutput").inputs["Color"])
    return outer


# ---- lamps ---------------------------------------------------------------------------------------


# Of type C, the same all round: a narrow beam with a ring about it.
LUMINAIRE = """IESNA:LM-63-2002
TILT=NONE
1 -1 900 7 1 1 2 0 0 0
1 1 1
0 15 30 40 50 70 90
0
1 0.9 0.1 0.4 0.5 0.1 0
"""


def lamp_graph(lamp: bpy.types.Object) -> tuple[Graph, Any]:
    """A lamp's nodes in the making, and the shader input of its output."""
    light: Any = lamp.data
    if bpy.app.version < (5, 1, 0):
        light.use_nodes = True
    light.node_tree.nodes.clear()
    output = light.node_tree.nodes.new("ShaderNodeOutputLight")
    return Graph("", light.node_tree), output.inputs["Surface"]


def shine(lamp: bpy.types.Object, graph: Graph, surface: Any, color: Any, strength: Any) -> None:
    """The lamp with that colour and strength."""
    emission = graph.node("Emission", Color=color, Strength=strength)
    graph.tree.links.new(emission.outputs[0], surface)


@family
def projecting_spots(scene: bpy.types.Scene) -> None:
    """A checker and rings that spots throw, one of them with a size, whose light doesn't fade."""
    corner(scene)
    cone = {"spot_size": math.radians(60), "spot_blend": 0.2}
    sharp = stage.lamp(
        "SPOT", "Sharp", (-1.2, -2, 3), (40, -10, 0), 250.0, shadow_soft_size=0.0, **cone
    )
    graph, surface = lamp_graph(sharp)
    checker = graph.node(
        "TexChecker",
        Vector=graph.coordinates("UV"),
        Color1=(1.0, 0.8, 0.3),
        Color2=(0.05, 0.1, 0.4),
        Scale=6.0,
    )
    shine(sharp, graph, surface, checker.outputs["Color"], 1.0)
    soft = stage.lamp(
        "SPOT", "Soft", (1.5, -2, 2.5), (45, 20, 0), 40.0, shadow_soft_size=0.2, **cone
    )
    graph, surface = lamp_graph(soft)
    direction = graph.coordinates("Normal")
    rings = graph.node("TexWave", {"wave_type": "RINGS"}, Vector=direction, Scale=2.0)
    falloff = graph.node("LightFalloff", Strength=0.5, Smooth=0.3)
    shine(soft, graph, surface, rings.outputs["Color"], falloff.outputs["Linear"])


@family
def luminaires(scene: bpy.types.Scene) -> None:
    """A measured lamp, a panel with noise on it, and a sun with a pattern in its disc."""
    corner(scene)
    text: Any = bpy.data.texts.new("Luminaire.ies")
    text.write(LUMINAIRE)
    bulb = stage.lamp("POINT", "Bulb", (-1, -0.5, 2.6), (20, 0, 0), 6.0, shadow_soft_size=0.05)
    graph, surface = lamp_graph(bulb)
    photometry = graph.node("TexIES", {"mode": "INTERNAL", "ies": text})
    body = graph.node("Blackbody", Temperature=3200.0)
    shine(bulb, graph, surface, body.outputs[0], photometry.outputs[0])
    panel = ceiling_lamp()
    graph, surface = lamp_graph(panel)
    noise = graph.node("TexNoise", Vector=graph.coordinates("UV"), Scale=3.0)
    color = graph.ramp(noise.outputs[0], (0.45, (0.0, 0.0, 0.0)), (0.55, (0.6, 1.0, 0.8)))
    shine(panel, graph, surface, color, 0.6)
    sun = stage.lamp("SUN", "Sun", (0, 0, 4), (50, 0, 35), 1.2, angle=math.radians(20))
    graph, surface = lamp_graph(sun)
    steps = graph.node("TexChecker", Vector=graph.coordinates("UV"), Scale=2.0)
    shine(sun, graph, surface, steps.outputs["Color"], 1.0)
