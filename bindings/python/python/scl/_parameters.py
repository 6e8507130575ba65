"""The values of a component's parameters, of generated modules."""

from __future__ import annotations

import dataclasses
import enum
import keyword
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any, ClassVar, Generic, Self, TypeVar, cast, dataclass_transform

from scl._generated import GeneratedComponent


class Choice(enum.StrEnum):
    """The values of a parameter that is one of several words. Generated enums derive from it; each member is a word."""


@dataclass_transform(frozen_default=True, kw_only_default=True)
class Parameters:
    """The values of all parameters of a component. Generated classes derive from it; they are frozen dataclasses."""

    _choices: ClassVar[Mapping[str, type[Choice]]] = MappingProxyType({})

    def __init_subclass__(cls, *, choices: Mapping[str, type[Choice]] | None = None) -> None:
        """Takes the enums of parameters that are one of several words, by field."""
        super().__init_subclass__()
        if choices is not None:
            cls._choices = choices
        dataclasses.dataclass(frozen=True, kw_only=True)(cls)

    @classmethod
    def _of(cls, values: Iterable[tuple[str, Any]]) -> Self:
        choices = cls._choices
        return cls(**{field: choices[field](value) if field in choices else value for field, value in values})


def _field_of(name: str) -> str:
    """Returns the field for a parameter's name in snake case, as the generator names it."""
    if keyword.iskeyword(name):
        return f"{name}_"
    return f"parameter{name}" if name.startswith("_") else name


P = TypeVar("P", bound=Parameters)


class ComponentWithParameters(GeneratedComponent, Generic[P]):
    """A component of a generated module that has parameters."""

    _parameters_class: ClassVar[type[Parameters]]

    def __init_subclass__(cls, *, parameters: type[Parameters] | None = None, **rest: Any) -> None:
        """Takes the class of the parameters. A program's own subclasses inherit it."""
        super().__init_subclass__(**rest)
        if parameters is not None:
            cls._parameters_class = parameters

    @classmethod
    def _values(cls, parameters: list[tuple[str, str, Any]]) -> Parameters:
        return cls._parameters_class._of((_field_of(name), value) for _, name, value in parameters)

    @property
    def parameters(self) -> P:
        """The values that the parameters had when the component was opened, or at the last `update_parameters`."""
        # A class variable cannot have the type of a type parameter.
        return cast("P", self._parameters)
