# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's page in Blender's preferences: what holds on this machine, whatever the file."""

from __future__ import annotations

import importlib
import logging
import os
import sys
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty

from . import compat

_ADDON = __package__ or "basicrt"
_AUTOMATIC = "AUTO"
# Of what there may be; those that the machine has are basicrt.kernels(), by the same names in small letters.
ISAS = (
    (_AUTOMATIC, "Automatic", "The best that this machine has"),
    ("AVX512", "AVX-512", "16 numbers at once"),
    ("AVX2", "AVX2", "8 numbers at once"),
    ("SSE42", "SSE4.2", "4 numbers at once"),
    ("SCALAR", "Scalar", "One number after the other: the slowest, on every machine"),
)
LOG_LEVELS = (
    ("ERROR", "Errors", "Only why there is no picture"),
    ("WARNING", "Warnings", "What is not as in Blender, too"),
    ("INFO", "Info", "What each render took, too: time, memory, threads, instructions"),
    ("DEBUG", "Debug", "What viewports took, too"),
)

# Of the width of a property in Blender's two-column style.
_LABEL_PART = 0.4

log = logging.getLogger("basicrt")


@dataclass(frozen=True)
class Preferences:
    """Their values; the defaults are those of an add-on that Blender keeps no preferences for."""

    threads: int = 0
    isa: str = _AUTOMATIC
    log_level: str = "WARNING"
    memory_limit: float = 0.0  # GB of 2^30 bytes


def preferences() -> Preferences:
    """Those that hold now: Blender has none for what was registered as a plain module."""
    b_preferences: Any = bpy.context.preferences
    b_addon = b_preferences.addons.get(_ADDON)
    made: Any = b_addon.preferences if b_addon is not None else None
    # What Blender keeps of an add-on that is not registered (any more) is empty.
    if not isinstance(made, BasicRTPreferences):
        return Preferences()
    return Preferences(made.threads, made.isa, made.log_level, made.memory_limit)


def _on_isa(_self: Any, _context: bpy.types.Context) -> None:
    """Blender's callback: the choice counts at once, in what is being rendered too."""
    try:
        compat.check_native()
    except compat.NativeModuleError:  # the page and each render tell of it
        return
    use_isa()


def _on_log_level(_self: Any, _context: bpy.types.Context) -> None:
    """Blender's callback."""
    log.setLevel(preferences().log_level)


class BasicRTPreferences(bpy.types.AddonPreferences):
    """How this machine renders, and whether it can."""

    bl_idname = _ADDON

    threads: IntProperty(  # type: ignore[valid-type]
        name="Threads",
        description="Threads of scenes whose own Threads Mode is Auto-Detect. 0 is one for each processor. A scene's "
        "fixed number, Blender's option -t and --basicrt-threads count before it",
        min=0,
        max=1024,
        default=0,
    )
    isa: EnumProperty(  # type: ignore[valid-type]
        name="Instructions",
        description="Which of the processor's instructions trace rays. Takes effect at once; pictures do not depend "
        "on it. The environment variable BASICRT_ISA counts before it",
        items=ISAS,
        default=_AUTOMATIC,
        update=_on_isa,
    )
    log_level: EnumProperty(  # type: ignore[valid-type]
        name="Console",
        description="What is printed to the console that Blender was started from. Render > Warnings shows warnings "
        "in any case",
        items=LOG_LEVELS,
        default="WARNING",
        update=_on_log_level,
    )
    memory_limit: FloatProperty(  # type: ignore[valid-type]
        name="Memory Limit",
        description="In GB: what needs more is not rendered, and the error says how much it needs. 0 is no limit. "
        "Counted are shapes, instances, images, trees and the picture: before trees are built with the least that "
        "they could take, and afterwards with what they took. What builders of trees need for a moment is not "
        "counted, nor what Blender itself holds",
        min=0,
        soft_max=256,
        precision=2,
        default=0,
    )

    def draw(self, context: bpy.types.Context) -> None:
        """Blender's callback."""
        layout: Any = self.layout
        try:
            version = compat.check_native()
        except compat.NativeModuleError as error:
            layout.label(text=str(error), icon="ERROR")
            return
        layout.label(text=f"Native module {version}", icon="CHECKMARK")
        column = layout.column()
        column.use_property_split, column.use_property_decorate = True, False
        column.prop(self, "threads")
        self._draw_isa(column)
        column.prop(self, "log_level")
        column.prop(self, "memory_limit", text="Memory Limit (GB)")
        layout.operator("basicrt.self_test")
        for text, icon in shown_self_test():
            layout.label(text=text, icon=icon)

    def _draw_isa(self, column: Any) -> None:
        """Buttons for what the machine has."""
        available = importlib.import_module("basicrt").kernels()
        # Blender would take the first button of a property's row for its label.
        split = column.split(factor=_LABEL_PART)
        split.use_property_split = False
        label = split.row()
        label.alignment = "RIGHT"
        label.label(text="Instructions")
        row = split.row(align=True)
        row.enabled = not _environment_isa()
        for identifier, _name, _description in ISAS:
            if identifier == _AUTOMATIC or identifier.lower() in available:
                row.prop_enum(self, "isa", identifier)
        if _environment_isa():
            column.label(text=f"BASICRT_ISA in the environment is {_environment_isa()}")
        elif self.isa != _AUTOMATIC and self.isa.lower() not in available:
            column.label(text=_missing_isa(self.isa), icon="ERROR")


class _State:
    """Of this process."""

    isa = _AUTOMATIC  # what the native module was told last
    console: logging.Handler | None = None
    self_test: tuple[tuple[str, str], ...] = ()


def _environment_isa() -> str:
    return os.environ.get("BASICRT_ISA", "")


def _missing_isa(isa: str) -> str:
    return f"Preferences > Add-ons > BasicRT > Instructions: this machine has no {isa}, the best is used"


def use_isa() -> None:
    """Have rays traced as the preferences say; the native module must be there.

    Until one has chosen there, the native module's own choice stays.
    """
    native: ModuleType = importlib.import_module("basicrt")
    wanted = _AUTOMATIC if _environment_isa() else preferences().isa
    if wanted == _State.isa:
        return
    _State.isa = wanted
    is_there = wanted.lower() in native.kernels()
    if wanted != _AUTOMATIC and not is_there:
        log.warning("%s", _missing_isa(wanted))
    native.choose_kernel(wanted.lower() if is_there else "")


def show_self_test(lines: tuple[tuple[str, str], ...]) -> None:
    """Make these (text, icon) the lines beneath the button."""
    _State.self_test = lines


def shown_self_test() -> tuple[tuple[str, str], ...]:
    """The lines beneath the button."""
    return _State.self_test


class _Console(logging.Handler):
    """Prints where nothing else does: Python's own last resort leaves out what is no warning."""

    def __init__(self) -> None:
        super().__init__()
        self.setFormatter(logging.Formatter("BasicRT: %(message)s"))

    def emit(self, record: logging.LogRecord) -> None:
        """Called by logging."""
        if logging.getLogger().handlers or sys.stderr is None:
            return
        try:
            sys.stderr.write(f"{self.format(record)}\n")
        except Exception:
            self.handleError(record)


def register() -> None:
    """Register the preferences, and print what they say."""
    bpy.utils.register_class(BasicRTPreferences)
    _State.console = _Console()
    log.addHandler(_State.console)
    log.setLevel(preferences().log_level)


def unregister() -> None:
    """Undo register(), and what the preferences have changed."""
    log.setLevel(logging.NOTSET)
    if _State.console is not None:
        log.removeHandler(_State.console)
    if _State.isa != _AUTOMATIC:
        importlib.import_module("basicrt").choose_kernel("")
    _State.isa, _State.console, _State.self_test = _AUTOMATIC, None, ()
    bpy.utils.unregister_class(BasicRTPreferences)
