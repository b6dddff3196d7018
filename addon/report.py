# SPDX-License-Identifier: GPL-3.0-or-later
"""What went wrong, or was left out, told once: warnings of one export, and errors of callbacks."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager

log = logging.getLogger("basicrt")


class ExportError(Exception):
    """The scene can't be rendered; the message names the culprit."""


class Report:
    """The warnings of one export; each is logged the first time it is given."""

    def __init__(self) -> None:
        self._warnings: dict[str, None] = {}

    def warn(self, item: str, message: str) -> None:
        """`item` names the culprit (`material "Glass"`), `message` what is done about it."""
        self.add(f"{item}: {message}")

    def add(self, text: str) -> None:
        """A warning that names its item itself."""
        if text not in self._warnings:
            self._warnings[text] = None
            log.warning("%s", text)

    @property
    def warnings(self) -> tuple[str, ...]:
        """All of them, in the order they came."""
        return tuple(self._warnings)


class HeldReport(Report):
    """Warnings of an attempt: told only if it is taken."""

    def add(self, text: str) -> None:
        self._warnings[text] = None

    def tell(self, report: Report) -> None:
        """Give them all to a report."""
        for text in self.warnings:
            report.add(text)


class _LatestWarnings:
    """What the warnings panel shows: plain text, because Blender's objects don't outlive a render."""

    texts: tuple[str, ...] = ()


def show_warnings(report: Report) -> None:
    """Make these the warnings in the panel."""
    _LatestWarnings.texts = report.warnings


def shown_warnings() -> tuple[str, ...]:
    """The warnings in the panel."""
    return _LatestWarnings.texts


def refuse_warnings(report: Report) -> None:
    """For who wants all of a scene or none. Raises ExportError where there are warnings."""
    if report.warnings:
        raise ExportError(
            f"not all is as in Blender, which Fail on Warnings asks for: {summary(report)}"
        )


def summary(report: Report) -> str:
    """One line for the status bar."""
    first, *others = report.warnings
    return first if not others else f"{first} (and {len(others)} more, see Render > Warnings)"


def message_of(error: BaseException) -> str:
    """What the user reads of an exception."""
    if isinstance(error, MemoryError):
        return "BasicRT: out of memory"
    if isinstance(error, KeyboardInterrupt):
        return "BasicRT: interrupted"
    return f"BasicRT: {error or type(error).__name__}"


@contextmanager
def caught(on_error: Callable[[str], None]) -> Iterator[None]:
    """Around the body of each of Blender's callbacks: Blender swallows exceptions, so none may leave.

    The traceback is logged and `on_error(message)` called; neither an interrupt nor what is wrong with a
    scene is a fault to trace. (No decorator: Blender counts a callback's arguments and refuses `*args`.)
    """
    try:
        yield
    except KeyboardInterrupt as interrupt:
        on_error(message_of(interrupt))
    except ExportError as error:
        log.error("%s", error)
        log.debug("where that was found", exc_info=error)
        on_error(message_of(error))
    except Exception as error:
        log.error("%s", error, exc_info=error)
        on_error(message_of(error))
