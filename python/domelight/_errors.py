"""Exceptions. Every error of the library has the library's own words; a field that was wrong is a keyword here."""

from __future__ import annotations

import errno
import os
import re
from typing import NoReturn

from .conventions import CONVENTIONS

#: What errors call a file that is in memory.
IN_MEMORY = "the bytes"


class Error(ValueError):
    """What went wrong, where, and what to do about it.

    Attributes
    ----------
    message : str
        One sentence: ``"9000 is not from 1 to 4096"``.
    field : str
        The keyword that was wrong, or ``""``.
    where : str
        The keyword, the file, or another place; ``""`` where there is none.
    hint : str
        What to do; ``""`` where nothing helps.
    """

    def __init__(self, message: str, where: str = "", hint: str = "", field: str = "") -> None:
        text = f"{where}: {message}" if where else message
        if hint:
            text += f"\n{hint}"
        super().__init__(text)
        self.message = message
        self.where = where
        self.hint = hint
        self.field = field

    def __reduce__(self) -> tuple[type, tuple[str, str, str, str]]:
        return type(self), (self.message, self.where, self.hint, self.field)


class WrongType(Error, TypeError):
    """An argument of a type that its keyword does not take."""


class FileError(Error, OSError):
    """A file that cannot be read or written, or whose contents are wrong. ``filename`` is its name."""

    def __init__(self, message: str, where: str = "", hint: str = "", field: str = "") -> None:
        Error.__init__(self, message, where, hint, field)
        self.filename = where
        self.errno = errno.EIO if where == IN_MEMORY or os.path.exists(where) else errno.ENOENT
        self.strerror = message

    def __str__(self) -> str:
        return str(self.args[0])


class Cancelled(Error):
    """Work that stopped because its progress callback returned False."""


def _with_keywords(text: str) -> str:
    """Texts of the library name fields between backticks."""
    return re.sub(r"`([a-z_]+)`", r"\1", text)


def from_library(what: str, where: str, hint: str) -> Error:
    """The exception for an error of the library."""
    if what == "cancelled":
        return Cancelled("cancelled by the progress callback")
    message, place, advice = _with_keywords(what), _with_keywords(where), _with_keywords(hint)
    if message.startswith("unknown projection"):
        advice = f"{advice.rstrip('.')}; or the convention of a project: {', '.join(CONVENTIONS)}."
    field = place if re.fullmatch(r"`[a-z_]+`", where) else ""
    if where and not field:
        return FileError(message, place, advice)
    return Error(message, place, advice, field)


def a_or_an(noun: str) -> str:
    """The noun with its article."""
    return f"{'an' if noun[:1].lower() in 'aeiou' else 'a'} {noun}"


def wrong_type(keyword: str, value: object, expected: str) -> NoReturn:
    """Raises WrongType."""
    text = repr(value)
    shown = text if len(text) <= 40 else text[:37] + "..."
    raise WrongType(f"{shown} is {a_or_an(type(value).__name__)}, expected {expected}", keyword, "", keyword)
