"""Plain values: what codecs for types outside of `schemas:` send, even if their libraries could encode more."""

from __future__ import annotations

import math
from collections.abc import Iterator

from scl import _native
from scl._errors import EncodeError
from scl.codec._codec import kind_of

_LEAST, _GREATEST = -(2**63), 2**64 - 1


def check(gate: str, name: str, format: str, value: object, refused: tuple[type, ...] = ()) -> None:
    """Raises `TypeError` or `EncodeError` if a value is not plain, with the path to the part that is not.

    `refused` are classes to refuse although their base class is plain.
    """
    if _native.is_plain(value, format == "JSON"):
        return
    raise_refusal(gate, name, format, value, refused)


def raise_refusal(gate: str, name: str, format: str, value: object, refused: tuple[type, ...] = ()) -> None:
    """Raises the error for the first part that is not plain. Does nothing if there is no such part."""
    prefix = f"gate `{gate}` cannot send this value as the {format} of `{name}`"
    try:
        for part, path in _parts(value, ""):
            place = f" at `message{path}`" if path else ""
            if isinstance(part, refused) or not _is_of_plain_class(part):
                raise TypeError(f"{prefix}: {kind_of(part)}{place} is neither a plain value nor a dataclass")
            if isinstance(part, int) and not _LEAST <= part <= _GREATEST:
                raise EncodeError(f"{prefix}: the integer{place} is not between -2**63 and 2**64 - 1")
            if format == "JSON" and isinstance(part, float) and not math.isfinite(part):
                raise EncodeError(f"{prefix}: `{part}`{place} is not a JSON number")
            if format == "JSON" and isinstance(part, dict):
                for key in part:
                    if not isinstance(key, str | int):
                        raise TypeError(f"{prefix}: a key{place} is {kind_of(key)}; JSON keys must be `str` or `int`")
    except RecursionError as error:
        raise EncodeError(f"{prefix}: it contains itself, or is nested too deeply") from error


def _parts(value: object, path: str) -> Iterator[tuple[object, str]]:
    """Yields a value and all values inside it, with the expressions that reach them."""
    yield value, path
    if isinstance(value, dict):
        for key, one in value.items():
            yield from _parts(key, f"{path}.keys()")
            yield from _parts(one, f"{path}[{key!r}]")
    elif isinstance(value, list | tuple):
        for index, one in enumerate(value):
            yield from _parts(one, f"{path}[{index}]")
    elif _is_dataclass(value):
        # Imported here, because the import is slow.
        from dataclasses import fields

        for field in fields(value):  # type: ignore[arg-type]
            yield from _parts(getattr(value, field.name), f"{path}.{field.name}")


def _is_of_plain_class(value: object) -> bool:
    if isinstance(value, dict | list | tuple | str | int | float | bytes | bytearray):
        return True
    return value is None or _is_dataclass(value)


def _is_dataclass(value: object) -> bool:
    return hasattr(type(value), "__dataclass_fields__")
