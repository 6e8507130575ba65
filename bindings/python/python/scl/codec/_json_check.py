"""Refuses what Google's parser of canonical JSON accepts silently and other languages refuse: unknown names of enum
values while unknown fields are skipped, other values that are not enum values or messages, and bytes that are not
base64."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from google.protobuf.descriptor import Descriptor, EnumDescriptor, FieldDescriptor

_BASE64 = re.compile(r"[A-Za-z0-9+/_-]*={0,2}")


def check(descriptor: Descriptor, value: object, path: str = "") -> None:
    """Raises `ValueError` with the field and what it contains."""
    if not isinstance(value, dict) or descriptor.full_name.startswith("google.protobuf."):
        return
    for key, item in value.items():
        field = _field(descriptor, key)
        if field is None:
            continue
        inner = field.message_type
        if inner is not None and inner.GetOptions().map_entry:
            if isinstance(item, dict):
                for name, entry in item.items():
                    _check_value(inner.fields_by_name["value"], entry, f"{path}{field.name}.{name}")
            continue
        items = item if isinstance(item, list) and _is_repeated(field) else [item]
        for one in items:
            _check_value(field, one, path + field.name)


def _field(descriptor: Descriptor, key: str) -> FieldDescriptor | None:
    found: FieldDescriptor | None = descriptor.fields_by_name.get(key)
    if found is None:
        found = next((field for field in descriptor.fields if field.json_name == key), None)
    return found


def _is_repeated(field: FieldDescriptor) -> bool:
    # `is_repeated` exists since protobuf 6.31; before that, the label tells.
    either: Any = field
    found = getattr(field, "is_repeated", None)
    return bool(either.label == either.LABEL_REPEATED if found is None else found)


def _is_value(enum: EnumDescriptor, text: str) -> bool:
    # Not `values_by_number`, which ignores all but the lower 32 bits of a number.
    is_number = re.fullmatch("-?[0-9]{1,10}", text) is not None
    return text in enum.values_by_name or (is_number and any(value.number == int(text) for value in enum.values))


def _check_value(field: FieldDescriptor, value: object, path: str) -> None:
    inner = field.message_type
    if inner is not None:
        if not isinstance(value, dict | None) and not inner.full_name.startswith("google.protobuf."):
            raise ValueError(f"the field `{path}` is not an object")
        check(inner, value, f"{path}.")
    elif field.enum_type is not None and (isinstance(value, bool) or (isinstance(value, float) and value % 1 != 0)):
        raise ValueError(f"the field `{path}` is not a value of the enum `{field.enum_type.full_name}`")
    elif isinstance(value, str):
        enum = field.enum_type
        if enum is not None and not _is_value(enum, value):
            raise ValueError(f"`{value}` of the field `{path}` is not a value of the enum `{enum.full_name}`")
        if field.type == field.TYPE_BYTES and _BASE64.fullmatch(value) is None:
            raise ValueError(f"the field `{path}` is not base64")
