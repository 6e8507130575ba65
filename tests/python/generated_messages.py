"""What the type checkers' tests say of messages, at run time."""

import copy
import pydoc
import sys

import everything_scl
from everything_scl import Everything, Import, Job, Kind, Level, Old, Word, class_, every_Status, second_Status
from google.protobuf.duration_pb2 import Duration
from google.protobuf.timestamp_pb2 import Timestamp

import scl

message = Everything(a_double=1, an_int32=2, some_bytes=b"b", level=Level.LEVEL_HIGH, at=Timestamp(seconds=5))
again = Everything.FromString(message.SerializeToString())
assert again == message == copy.deepcopy(message)
assert type(again.at) is Timestamp
again.took.CopyFrom(Duration(seconds=1))
again.any_object["a"] = 1
assert Level.Name(again.level) == "LEVEL_HIGH" and Level.Value("LEVEL_LOW") == 0
assert Level.keys() == ["LEVEL_LOW", "LEVEL_HIGH"] and Level.DESCRIPTOR.full_name == "every.Level"
assert Everything.Inner.COLOR_RED == Everything.Inner.Color.COLOR_RED == 1
again.inner.outer.inner.color = Everything.Inner.COLOR_RED
again.numbers.append(1)
assert again.inners.add().text == ""
assert again.by_name["a"].text == ""
again.by_number[1] = True
assert again.WhichOneof("choice") is None and not again.HasField("maybe")
assert getattr(again, "from") == ""
assert second_Status.DESCRIPTOR.full_name == "second.Status" and every_Status is not second_Status
old = Old(number=1, Kind=[Kind(name="a")], part=Old.Part(list=True))
assert old.int == "seven" and old.word == Word.MINUS == -1 and old.inner_word.FALSE == Old.Word.FALSE == 0
assert class_(otherwise=True).WhichOneof("if") == "otherwise"

for wrong in [lambda: Everything(a_dubble=1), lambda: message.a_sring, lambda: everything_scl.Evrything]:
    try:
        wrong()
    except (ValueError, AttributeError) as error:
        print(error)
    else:
        sys.exit("nothing is wrong")

# Before all are used.
assert set(everything_scl.__all__) <= set(dir(everything_scl))
for name in everything_scl.__all__:
    getattr(everything_scl, name)
assert repr(Everything) == "<class 'everything_scl.Everything'>" and repr(Job(number=1)) == "number: 1\n"
page = pydoc.plain(pydoc.render_doc(everything_scl))
assert "class Everything(" in page and "class Import(" in page and "from_: `pub` publishes `every.Job` to" in page

component = Import()
for wrong in ["from__", "anything"]:
    try:
        setattr(component, wrong, 1)
    except AttributeError as error:
        assert f"component `import` has no attribute `{wrong}`" in str(error), error
    else:
        sys.exit("a misspelt gate is an attribute")
# The module declares what the component has, and each public name of components is the name of a gate here.
assert set(Import.__annotations__) == {it for it, gate in vars(component).items() if isinstance(gate, scl.Gate)}
assert {f"{it}_" for it in dir(scl.Component) if not it.startswith("_")} <= set(Import.__annotations__)
assert type(component.from_) is scl.Pub and component.from_.type is Job
assert component.my_gate.name == "import.my-gate" and component.close_.name == "import.close"
assert component.gate_private.name == "import._private"
component.close()
print("done")
