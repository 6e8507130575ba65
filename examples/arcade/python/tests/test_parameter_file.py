"""The file of parameters: each mistake is found, and a write that fails changes nothing."""

from pathlib import Path

import pytest

import parameter_file
import parameters
from configuration import Store

MISTAKES = """\
fence.radius: 5000
fence.hight: 20
power.low: half
power.low: 0.4
power.low: 0.5
limit.tilt: [1, 2]
limit.speed: .nan
"""


def mistakes_in(file: Path, text: str | bytes) -> list[str]:
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(parameter_file.FileMistakes) as found:
        parameter_file.read(file)
    return str(found.value).replace(str(file), "p.yaml").splitlines()


def test_every_mistake_is_reported_with_its_line(tmp_path: Path) -> None:
    assert mistakes_in(tmp_path / "p.yaml", MISTAKES) == [
        "p.yaml:1: `fence.radius: 5000` is out of range; it is 5 to 1000 m",
        "p.yaml:2: unknown parameter `fence.hight`; did you mean `fence.height`?",
        "p.yaml:3: `power.low` is not a number; it is 0.05 to 0.9",
        "p.yaml:5: `power.low` is set twice",
        "p.yaml:6: `limit.tilt` is not a number; it is 5 to 45 degrees",
        "p.yaml:7: `limit.speed` is not a number; it is 0.2 to 15 m/s",
    ]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("fence.radius: [", "p.yaml:1: not valid YAML"),
        ("a: *b", "p.yaml:1: not valid YAML"),
        ("- fence.radius", "p.yaml:1: not a list of parameters"),
        (b"\xff\xfe", "p.yaml: not a text file: byte 0"),
        (b"a: \x00", "p.yaml: not valid YAML"),
        ("[" * 5000, "p.yaml: not valid YAML"),
    ],
)
def test_a_corrupt_file_is_named(tmp_path: Path, text: str | bytes, words: str) -> None:
    [mistake] = mistakes_in(tmp_path / "p.yaml", text)
    assert mistake.startswith(words)


def test_a_folder_is_not_a_file(tmp_path: Path) -> None:
    with pytest.raises(parameter_file.FileMistakes, match="cannot be read: Is a directory"):
        parameter_file.read(tmp_path)


def test_changes_are_kept(tmp_path: Path) -> None:
    file = tmp_path / "p.yaml"
    store = Store(file)
    assert store.change("fence.radius", 80.5) is None
    assert store.change("home.latitude", 0.1 + 0.2) is None
    assert Store(file).values == {**parameters.DEFAULTS, "fence.radius": 80.5, "home.latitude": 0.1 + 0.2}
    assert store.change("fence.radius", parameters.DEFAULTS["fence.radius"]) is None
    assert parameter_file.read(file) == {"home.latitude": 0.1 + 0.2}
    assert list(tmp_path.iterdir()) == [file]


def test_a_refused_value_changes_nothing(tmp_path: Path) -> None:
    file = tmp_path / "p.yaml"
    store = Store(file)
    assert store.change("fence.radius", 5000) is not None
    assert store.values == parameters.DEFAULTS
    assert not file.exists()


def test_a_file_that_cannot_be_written_changes_nothing(tmp_path: Path) -> None:
    folder = tmp_path / "gone"
    folder.mkdir()
    store = Store(folder / "p.yaml")
    folder.rmdir()
    words = f"cannot write {folder}/p.yaml: No such file or directory; `fence.radius` is still 100"
    assert store.change("fence.radius", 50) == words
    assert store.values == parameters.DEFAULTS


def test_a_full_disk_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "p.yaml"
    store = Store(file)
    assert store.change("fence.radius", 50) is None
    before = file.read_text()

    def full(_number: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    assert "No space left on device" in (store.change("fence.radius", 60) or "")
    assert store.values["fence.radius"] == 50
    assert file.read_text() == before
    assert list(tmp_path.iterdir()) == [file]
