"""Message classes, made from the descriptors that a plan carries: neither protoc nor generated `_pb2` files are needed."""

from __future__ import annotations

import base64
import functools
import importlib
import sys
import threading
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from scl._errors import UnsupportedCodecError
from scl._suggest import did_you_mean

if TYPE_CHECKING:
    from google.protobuf.descriptor_pb2 import FileDescriptorProto
    from google.protobuf.descriptor_pool import DescriptorPool
    from google.protobuf.message import Message

_WELL_KNOWN = "google/protobuf/"

# Two pools for the same messages would have different classes, so only one thread makes one.
_lock = threading.RLock()


class MessageClasses:
    """The messages and enums of a system's schemas."""

    def __init__(self, pool: DescriptorPool) -> None:
        self._pool = pool

    def message(self, name: str) -> type[Message]:
        """Returns the class of a message by its full name, for example `rover.Setpoint`.

        Raises `UnsupportedCodecError` if the schemas do not declare it.
        """
        found = self.find(name)
        if found is None:
            raise UnsupportedCodecError(f"the schemas do not declare the message `{name}`")
        return found

    def find(self, name: str) -> type[Message] | None:
        """Like `message`, but returns `None` if the schemas do not declare it."""
        from google.protobuf import message_factory

        try:
            descriptor = self._pool.FindMessageTypeByName(name)
        except KeyError:
            return None
        return message_factory.GetMessageClass(descriptor)

    def enum(self, name: str) -> Any:
        """Returns an enum by its full name, as in files that protoc generates: `Level.LEVEL_HIGH`, `Level.Name(1)`.

        Raises `UnsupportedCodecError` if the schemas do not declare it.
        """
        from google.protobuf.internal import enum_type_wrapper

        try:
            descriptor = self._pool.FindEnumTypeByName(name)
        except KeyError:
            raise UnsupportedCodecError(f"the schemas do not declare the enum `{name}`") from None
        return enum_type_wrapper.EnumTypeWrapper(descriptor)


def messages_of_plan(plan: str) -> MessageClasses:
    """Returns the messages of all components of a plan. Equal plans share their classes."""
    with _lock:
        return _messages_of_plan(plan)


def messages_of_descriptors(sets: Iterable[bytes]) -> MessageClasses:
    """Returns the messages that serialized `google.protobuf.FileDescriptorSet`s describe. Equal sets share their classes."""
    with _lock:
        return _messages_of_descriptors(tuple(sorted(set(sets))))


def lazy_messages(
    module: str, plan: str, messages: Mapping[str, str], enums: Mapping[str, str]
) -> Callable[[str], object]:
    """Returns the `__getattr__` of a generated module, which makes message classes on first use; sets `__dir__`.

    `messages` and `enums` give the full name of each name in the module.
    """

    def find(name: str) -> object:
        if name in messages:
            found: object = messages_of_plan(plan).message(messages[name])
            found.__module__ = module
        elif name in enums:
            found = messages_of_plan(plan).enum(enums[name])
        else:
            hint = did_you_mean(name, dir(sys.modules[module]))
            raise AttributeError(f"module `{module}` has no attribute `{name}`{hint}", name=name)
        setattr(sys.modules[module], name, found)
        return found

    def names() -> list[str]:
        return sorted({*vars(sys.modules[module]), *messages, *enums})

    # So that `dir` and `help` show messages that were not used yet.
    vars(sys.modules[module])["__dir__"] = names
    return find


@functools.cache
def _messages_of_plan(plan: str) -> MessageClasses:
    import json

    schemas = json.loads(plan)["schemas"]
    return messages_of_descriptors(base64.b64decode(schema) for schema in schemas.values())


@functools.cache
def _messages_of_descriptors(sets: tuple[bytes, ...]) -> MessageClasses:
    from google.protobuf import descriptor_pb2, descriptor_pool

    # The sets of a system overlap; files of the same name have the same content. Imports come first in each set.
    files = {file.name: file for one in sets for file in descriptor_pb2.FileDescriptorSet.FromString(one).file}
    if any(name.startswith(_WELL_KNOWN) for name in files):
        # `google.protobuf.timestamp_pb2.Timestamp` has to be the class that the messages use, and it is in the default
        # pool. That pool refuses another file of the same name or with the same messages, from another system.
        pool = descriptor_pool.Default()
        try:
            _add(pool, files.values(), is_default=True)
            return MessageClasses(pool)
        except TypeError:
            pass
    pool = descriptor_pool.DescriptorPool()
    _add(pool, files.values(), is_default=False)
    return MessageClasses(pool)


def _add(pool: DescriptorPool, files: Iterable[FileDescriptorProto], *, is_default: bool) -> None:
    for file in files:
        if is_default and _is_imported(file.name):
            continue
        pool.AddSerializedFile(file.SerializeToString())


def _is_imported(file: str) -> bool:
    """Imports the module of a well-known file; returns false if protobuf has none."""
    if not file.startswith(_WELL_KNOWN):
        return False
    try:
        importlib.import_module(file.removesuffix(".proto").replace("/", ".") + "_pb2")
    except ImportError:
        return False
    return True
