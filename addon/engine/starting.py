# SPDX-License-Identifier: GPL-3.0-or-later
"""How a session begins in Blender: the user may cancel it, and hears what the core says in words of the scene."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..report import ExportError, Report, show_warnings

if TYPE_CHECKING:
    import basicrt

    from ..sync.scene_sync import Export


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
    exported: Export, report: Report, start: Callable[[], basicrt.Session]
) -> basicrt.Session:
    """Start it; what the core says against it is told with the names of things. Raises ExportError."""
    import basicrt

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", basicrt.SceneWarning)
        try:
            session = start()
        except basicrt.SceneError as error:
            raise ExportError(exported.in_users_words(str(error))) from error
    for warning in caught:
        report.add(exported.in_users_words(str(warning.message)))
    show_warnings(report)
    return session
