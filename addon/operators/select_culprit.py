# SPDX-License-Identifier: GPL-3.0-or-later
"""The button beside a warning: selects the object that it is about, and the node."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import bpy
from bpy.props import StringProperty

from ..culprit import Culprit, find_culprit, names_in, tree_of


def _select_node(tree: Any, name: str) -> None:
    """Alone, and the groups that it is in."""
    for node in tree.nodes:
        group = getattr(node, "node_tree", None)
        is_inside = group is not None and name in names_in(group)
        node.select = is_inside or node.name == name
        if node.select:
            tree.nodes.active = node
        if is_inside:
            _select_node(group, name)


def _objects_of(culprit: Culprit, objects: Sequence[Any]) -> list[Any]:
    """Those of a view layer that it is, or that have it."""
    if culprit.kind == "material":
        return [o for o in objects if culprit.name in (slot.name for slot in o.material_slots)]
    if culprit.kind == "light":
        lights = [o for o in objects if o.type == "LIGHT"]
        named = [o for o in lights if o.name == culprit.name]
        return named or [o for o in lights if o.data.name == culprit.name]
    return [o for o in objects if o.name == culprit.name]


class BASICRT_OT_select_culprit(bpy.types.Operator):
    """Select what the warning is about: the object, or all with the material or light, and the node"""

    bl_idname = "basicrt.select_culprit"
    bl_label = "Select"
    bl_options = {"REGISTER", "UNDO"}

    if TYPE_CHECKING:
        warning: str
    else:
        warning: StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    def execute(self, context: Any) -> Any:
        """Blender's callback."""
        culprit = find_culprit(self.warning)
        if culprit is None:
            self.report({"WARNING"}, "It is not in this file any more")
            return {"CANCELLED"}
        tree = tree_of(culprit.kind, culprit.name)
        if culprit.node is not None:
            _select_node(tree, culprit.node)
        if culprit.kind == "world":
            return {"FINISHED"}
        found = _objects_of(culprit, context.view_layer.objects)
        if not found:
            self.report(
                {"WARNING"}, f'No object of this view layer has {culprit.kind} "{culprit.name}"'
            )
            return {"CANCELLED"}
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for b_object in context.view_layer.objects:
            b_object.select_set(b_object in found)
        context.view_layer.objects.active = found[0]
        if culprit.kind == "material":
            for b_object in found:
                names = [slot.name for slot in b_object.material_slots]
                b_object.active_material_index = names.index(culprit.name)
        return {"FINISHED"}


def register() -> None:
    """Add the operator."""
    bpy.utils.register_class(BASICRT_OT_select_culprit)


def unregister() -> None:
    """Take it away."""
    bpy.utils.unregister_class(BASICRT_OT_select_culprit)
