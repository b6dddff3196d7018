# SPDX-License-Identifier: GPL-3.0-or-later
"""The button in the preferences that says whether BasicRT renders as it should on this machine."""

from __future__ import annotations

from typing import Any

import bpy

from .. import compat
from ..preferences import preferences, show_self_test, use_isa
from ..report import caught


class BASICRT_OT_self_test(bpy.types.Operator):
    """Whether BasicRT renders as it should on this machine."""

    bl_description = (
        "Render small scenes whose light is known, and the same scene with each instruction set "
        "that this machine has. Takes a second or two, and touches nothing of yours"
    )
    bl_idname = "basicrt.self_test"
    bl_label = "Self-Test"

    def execute(self, context: Any) -> Any:
        """Blender's callback."""
        self.is_ok = False
        show_self_test(())
        with caught(self._fail):
            self._test()
        return {"FINISHED"} if self.is_ok else {"CANCELLED"}

    def _test(self) -> None:
        compat.check_native()
        import basicrt

        use_isa()
        result = basicrt.self_test(preferences().threads)
        lines = [(result.machine, "INFO")]
        for check in result.checks:
            icon = "CHECKMARK" if check.is_ok else "ERROR"
            lines.append((f"{check.name}: {check.detail}", icon))
        show_self_test(tuple(lines))
        self.is_ok = result.is_ok
        level: Any = {"INFO"} if result.is_ok else {"ERROR"}
        self.report(level, f"{result.machine}: {result.verdict}")

    def _fail(self, message: str) -> None:
        show_self_test(((message, "ERROR"),))
        self.report({"ERROR"}, message)


def register() -> None:
    """Add the operator."""
    bpy.utils.register_class(BASICRT_OT_self_test)


def unregister() -> None:
    """Take it away."""
    bpy.utils.unregister_class(BASICRT_OT_self_test)
