"""The YAML file that keeps changed parameters: read with every mistake in its place, and replaced as a whole."""

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

import yaml

import parameters

HEADER = "# Parameters that differ from their defaults. `configuration` rewrites this file at each change.\n"


class FileMistakes(Exception):
    """The file cannot be used. One line for each mistake."""


def read(file: Path) -> dict[str, float]:
    """Returns the values in the file, or an empty mapping without a file. Raises `FileMistakes`."""
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise FileMistakes(f"{file}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise FileMistakes(f"{file}: not a text file: byte {error.start} is not UTF-8") from None
    try:
        root = yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.MarkedYAMLError as error:
        line = f"{error.problem_mark.line + 1}: " if error.problem_mark else " "
        raise FileMistakes(f"{file}:{line}not valid YAML: {error.problem}") from None
    except (yaml.YAMLError, RecursionError) as error:
        raise FileMistakes(f"{file}: not valid YAML: {' '.join(str(error).split())}") from None
    if root is None:
        return {}
    if not isinstance(root, yaml.MappingNode):
        raise FileMistakes(f"{file}:1: not a list of parameters; write one on each line, such as `fence.radius: 80`")
    return _values(file, root)


def _values(file: Path, root: yaml.MappingNode) -> dict[str, float]:
    values: dict[str, float] = {}
    mistakes = []
    for key, node in root.value:
        name = str(key.value) if isinstance(key, yaml.ScalarNode) else ""
        value = _number(node)
        if name in values:
            problem = f"`{name}` is set twice"
        elif name not in parameters.BY_NAME or value is not None:
            problem = parameters.mistake(name, value or 0.0) or ""
        else:
            problem = f"`{name}` is not a number; it is {parameters.range_of(parameters.BY_NAME[name])}"
        if problem:
            mistakes.append(f"{file}:{key.start_mark.line + 1}: {problem}")
        elif value is not None:
            values[name] = value
    if mistakes:
        raise FileMistakes("\n".join(mistakes))
    return values


def _number(node: yaml.Node) -> float | None:
    # YAML 1.1 reads `010` as 8 and `1:30` as 90, so the text is taken as it is written.
    try:
        return float(node.value) if isinstance(node, yaml.ScalarNode) else None
    except ValueError:
        return None


def write(file: Path, values: Mapping[str, float]) -> None:
    """Replaces the file by one with the values that differ from their defaults. Raises `OSError`, and the old file stays."""
    lines = [HEADER]
    for spec in parameters.TABLE:
        if (value := values[spec.name]) != spec.default:
            lines.append(f"{spec.name}: {value!r}  # {parameters.range_of(spec)}: {spec.description}\n")
    # In the same folder, because a file is replaced as a whole only within one file system.
    number, name = tempfile.mkstemp(dir=file.parent, prefix=f".{file.name}.")
    try:
        with open(number, "w", encoding="utf-8") as temporary:
            temporary.writelines(lines)
            temporary.flush()
            # Otherwise the name could reach the disk before the content.
            os.fsync(temporary.fileno())
        os.replace(name, file)
    except BaseException:
        os.unlink(name)
        raise
