"""An arbiter and a made-up autopilot, for tests of the arbiter's logic: no gates, no clock."""

from arbiter_events import Action, Answered, Ask, Event, FlightSeen, LimitsSeen, PowerSeen, Reply, Requested, Say, Tick
from arbiter_logic import Arbiter
from arcade_scl import Action as Order
from arcade_scl import Authority, Command, CommandResult, Flight, Mode, Power, PowerLevel, Vector
from defaults import arbiter_parameters, limits

MISSION, GROUND, SAFETY = Authority.AUTHORITY_MISSION, Authority.AUTHORITY_GROUND, Authority.AUTHORITY_SAFETY
ACCEPTED = CommandResult(accepted=True)


def command(order: Order, command_id: int, *target: float, yaw: float = 0, speed: float = 0) -> Command:
    vector = Vector(x=target[0], y=target[1], z=target[2]) if target else None
    return Command(id=command_id, action=order, target=vector, yaw=yaw, speed=speed)


class World:
    """Time passes only as a test says: 1 s of the program is 1 s of the vehicle."""

    def __init__(self, *, heard: bool = True) -> None:
        self.now = 100.0
        self.arbiter = Arbiter(self.now, arbiter_parameters())
        self.flight = Flight(mode=Mode.MODE_GROUNDED, position_valid=True)
        self.said: list[str] = []
        self.asked: list[Command] = []
        self.replies: dict[int, CommandResult] = {}
        self.numbers = 0
        self.feed(LimitsSeen(limits()))
        if heard:
            self.power(1.0)
            self.fly()

    def feed(self, event: Event) -> list[Action]:
        actions = self.arbiter.step(self.now, event)
        for action in actions:
            match action:
                case Say(text):
                    self.said.append(text)
                case Ask(asked, _):
                    self.asked.append(asked)
                case Reply(number, result):
                    assert number not in self.replies
                    self.replies[number] = result
        return actions

    def fly(self, after: float = 0.0, **changes: object) -> list[Action]:
        """The autopilot reports: `mode`, `command_id`, `position` and so on change, the rest is as before."""
        self.now += after
        position = changes.pop("position", None)
        if isinstance(position, tuple):
            self.flight.position.CopyFrom(Vector(x=position[0], y=position[1], z=position[2]))
        for name, value in changes.items():
            setattr(self.flight, name, value)
        self.flight.time_us = round(self.now * 1e6)
        seen = Flight()
        seen.CopyFrom(self.flight)
        return self.feed(FlightSeen(seen))

    def power(self, charge: float, level: PowerLevel = PowerLevel.POWER_LEVEL_OK) -> None:
        self.feed(PowerSeen(Power(charge_left=charge, level=level)))

    def pass_time(self, seconds: float) -> None:
        """Ticks, while power management goes on and the autopilot is as it is."""
        for _ in range(round(seconds * 10)):
            self.now += 0.1
            self.feed(Tick())

    def request(self, source: Authority, wanted: Command) -> int:
        self.numbers += 1
        self.feed(Requested(source, self.numbers, wanted))
        return self.numbers

    def answer(self, result: CommandResult | None = ACCEPTED, problem: str = "") -> None:
        self.feed(Answered(result, problem))

    def obey(self, mode: Mode) -> None:
        """The autopilot accepts the last command, and reports it when it has taken effect."""
        self.answer()
        self.fly(0.2, mode=mode, command_id=self.asked[-1].id)

    def airborne(self, *position: float) -> "World":
        """Takes off for the mission, and flies somewhere."""
        self.request(MISSION, command(Order.ACTION_TAKE_OFF, 100, 0, 0, 5))
        self.obey(Mode.MODE_TAKING_OFF)
        self.said.clear()
        self.asked.clear()
        self.fly(2.0, mode=Mode.MODE_FLYING, position=position or (0.0, 0.0, 5.0))
        return self

    @property
    def state(self) -> tuple[Authority, str]:
        arbitration = self.arbiter.arbitration
        return arbitration.authority, arbitration.reason
