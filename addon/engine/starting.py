# SPDX-License-Identifier: GPL-3.0-or-later
"""How a session begins in Blender: the user may cancel it, and hears what the core says in words of the scene."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..preferences import use_isa
from ..report import ExportError, Report, log, show_warnings
from .machine import check_memory, gigabytes, parts_of

if TYPE_CHECKING:
    import basicrt

    from ..sync.scene_sync import Export
    from .command_line import Overrides


class CancelledError(Exception):
    """The user cancelled while trees were built."""


def building_watch(engine: Any, is_cancelled: Callable[[], bool]) -> Callable[[float], None]:
    """What a session calls while trees are built. Raises CancelledError."""

    def watch(fraction: float) -> None:
        engine.update_stats("", f"Building trees | {fraction:.0%}")
        if is_cancelled():
            raise CancelledError

    return watch


def start_session(
    exported: Export,
    report: Report,
    overrides: Overrides,
    start: Callable[[], basicrt.Session],
) -> basicrt.Session:
    """Start it; what the core says against it is told with the names of things. Raises ExportError."""
    import basicrt

    use_isa()
    check_memory(exported.scene.memory(), overrides, is_built=False)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", basicrt.SceneWarning)
        try:
            session = start()
        except basicrt.SceneError as error:
            raise ExportError(exported.in_users_words(str(error))) from error
    for warning in caught:
        report.add(exported.in_users_words(str(warning.message)))
    show_warnings(report)
    tell_memory(session.memory)
    try:
        check_memory(session.memory, overrides, is_built=True)
    except ExportError:
        session.stop()
        raise
    return session


def tell_memory(memory: basicrt.SceneMemory, level: int = logging.INFO) -> None:
    """To the log: what a scene takes."""
    log.log(level, "memory: %s (%s)", gigabytes(memory.total), parts_of(memory))
