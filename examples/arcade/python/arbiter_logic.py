"""Who commands the autopilot: a state machine without clocks, gates or waiting. Times are seconds of any steady clock."""

import math
from dataclasses import dataclass, replace

import command_ids
import request_checks
import safety
from arbiter_events import (
    Action,
    Answered,
    Ask,
    Event,
    FlightSeen,
    LimitsSeen,
    PowerSeen,
    Reply,
    Requested,
    Say,
    Tick,
)
from arcade_scl import Action as Order
from arcade_scl import (
    Arbitration,
    Authority,
    Command,
    CommandResult,
    Flight,
    Limits,
    MissionArbiterParameters,
    Mode,
    Power,
)
from course import Course, resumed, return_height

LEAD_US = 150_000  # of a command before it takes effect: longer than it takes to reach the autopilot
SETTLING_US = 300_000  # after that time the autopilot reports the command; otherwise it was lost
ASK_TIMEOUT = 0.3  # s: a command of safety waits no longer than this for the answer to another one
RETRY_AFTER = 0.1  # s
REQUEST_LIMIT = 1.0  # s in which a request is answered
SILENT_AFTER = 1.0  # s without a message of the autopilot


@dataclass
class Waiting:
    """A request without a reply."""

    request: Requested
    deadline: float
    not_before: float = 0.0
    problem: str = "nothing was received from the autopilot"
    tried: bool = False


@dataclass(frozen=True)
class Asked:
    """A command that the autopilot has not answered."""

    command: Command
    course: Course | None  # what is under way once it is accepted
    waiting: Waiting | None  # the request that wants it; None: the course in effect does


class Arbiter:
    """Safety over the ground station over the mission."""

    def __init__(self, now: float, parameters: MissionArbiterParameters) -> None:
        self.parameters = parameters
        self._limits: Limits | None = None
        self.authority = Authority.AUTHORITY_NOBODY
        self.course: Course | None = None
        self._reason = ""
        self._flight: Flight | None = None
        self._flight_at = now
        self._silent = False
        self._power: Power | None = None
        self._power_at = now
        self._waiting: list[Waiting] = []
        self._asked: Asked | None = None
        self._settled_us = 0  # when the last accepted command is in effect at the latest
        self._retry_at = now  # for the commands of the course
        self._problem = ""  # the last one that was said

    @property
    def arbitration(self) -> Arbitration:
        """The message to be published."""
        reason = f"the autopilot is silent ({self._reason})" if self._silent else self._reason
        return Arbitration(time_us=self._flight.time_us if self._flight else 0, authority=self.authority, reason=reason)

    def step(self, now: float, event: Event) -> list[Action]:
        """Takes an event and returns what is to be done."""
        actions: list[Action] = []
        match event:
            case FlightSeen(flight):
                actions += self._fly(now, flight)
            case PowerSeen(power):
                self._power, self._power_at = power, now
            case LimitsSeen(limits):
                self._limits = limits
            case Requested():
                self._waiting.append(Waiting(event, now + REQUEST_LIMIT))
                # The ground station comes first; requests of one source keep their order.
                self._waiting.sort(key=lambda it: it.request.source != Authority.AUTHORITY_GROUND)
            case Answered():
                actions += self._take_answer(now, event)
            case Tick():
                actions += self._listen(now)
        actions += self._judge(now)
        actions += self._follow_course(now)
        actions += self._serve(now)
        return actions

    def _fly(self, now: float, flight: Flight) -> list[Action]:
        """Takes the state of the vehicle."""
        last, silence = self._flight, now - self._flight_at
        self._flight, self._flight_at = flight, now
        actions: list[Action] = []
        if self._silent:
            self._silent = False
            actions.append(Say(f"the autopilot sends again after {silence:.1f} s"))
        if last is None:
            actions += self._resume(flight)
        elif flight.time_us < last.time_us:
            # The simulator was started again, and its clock with it.
            self._settled_us = 0
        landed = flight.mode == Mode.MODE_GROUNDED and flight.time_us > self._settled_us
        if landed and self.authority != Authority.AUTHORITY_NOBODY:
            self._hand_over(Authority.AUTHORITY_NOBODY, None, "on the ground")
            actions.append(Say("landed"))
        return actions

    def _resume(self, flight: Flight) -> list[Action]:
        """Finds out after a restart who commands the vehicle."""
        authority, _, _ = command_ids.split(flight.command_id)
        if flight.mode == Mode.MODE_GROUNDED or authority == Authority.AUTHORITY_NOBODY:
            return []
        course = resumed(flight)
        self._hand_over(authority, course, course.reason if course else "as before a restart of the arbiter")
        who = request_checks.SOURCES[authority]
        return [Say(f"the vehicle is in the air, commanded by {who} (command {flight.command_id}); continuing")]

    def _listen(self, now: float) -> list[Action]:
        """Notices that the autopilot is silent."""
        if self._silent or now - self._flight_at < SILENT_AFTER:
            return []
        self._silent = True
        return [Say(f"no word from the autopilot for {SILENT_AFTER:g} s")]

    def _judge(self, now: float) -> list[Action]:
        """Applies the safety rules. A landing here outranks a return, and both outrank everybody else."""
        if self._flight is None:
            return []
        found = safety.danger(
            self._flight, self._power, now - self._power_at, self._limits, self.parameters.fence_margin
        )
        decided = self.course is not None and self.authority == Authority.AUTHORITY_SAFETY
        landing = self.course is not None and self.course.phase != command_ids.HOME
        if found is None or (decided and (landing or not found.land_here)):
            return []
        number = command_ids.next_of_safety(self.course.id if self.course else self._flight.command_id)
        height = self._return_height(self._flight)
        phase = 0 if found.land_here else command_ids.HOME
        course = Course(Authority.AUTHORITY_SAFETY, number, phase, height, found.reason)
        self._hand_over(Authority.AUTHORITY_SAFETY, course, found.reason)
        return [Say(f"safety decides: {found.reason}")]

    def _follow_course(self, now: float) -> list[Action]:
        """Sends the command of the course until it is in effect."""
        flight = self._flight
        if self.course is None or flight is None:
            return []
        actions: list[Action] = []
        course = self.course.next(flight)
        if course != self.course:
            self.course, self._settled_us = course, 0
            actions.append(
                Say("near home: landing" if flight.position_valid else "the position is unknown: landing here")
            )
        command = course.command(flight)
        unsettled = flight.time_us < self._settled_us or now < self._retry_at or self._asked
        if flight.command_id == command.id or flight.mode == Mode.MODE_GROUNDED or unsettled:
            return actions
        return [*actions, self._ask(flight, ASK_TIMEOUT, Asked(command, course, None))]

    def _serve(self, now: float) -> list[Action]:
        """Refuses, answers or passes on the requests that wait."""
        actions: list[Action] = []
        for waiting in list(self._waiting):
            if self._asked and self._asked.waiting is waiting:
                continue
            command, flight = waiting.request.command, self._flight
            if flight and waiting.tried and flight.command_id == command.id:
                # The autopilot had accepted it, but its reply was lost.
                actions += self._accept(waiting, Asked(command, None, waiting))
            elif refusal := self._refusal(now, waiting.request):
                actions += self._refuse(waiting, refusal)
            elif now >= waiting.deadline:
                actions += self._refuse(waiting, self._missing() or waiting.problem)
            elif flight and command.action == Order.ACTION_LAND and flight.mode == Mode.MODE_GROUNDED:
                actions += self._reply(waiting, CommandResult(accepted=True))
            elif flight and self._limits and self._asked is None and now >= waiting.not_before:
                waiting.tried = True
                actions.append(self._pass_on(flight, waiting, min(ASK_TIMEOUT, waiting.deadline - now)))
        return actions

    def _refusal(self, now: float, request: Requested) -> str | None:
        """Returns the reason if the request cannot be passed on."""
        if self._flight is None or self._limits is None:
            return None
        if overruled := self._overruled():
            return overruled
        if self.authority == Authority.AUTHORITY_GROUND and request.source != Authority.AUTHORITY_GROUND:
            return f"the ground station commands the vehicle: {self._reason}"
        power = self._power if now - self._power_at <= safety.POWER_SILENCE else None
        return request_checks.refusal(request.source, request.command, self._flight, power, self._limits)

    def _missing(self) -> str | None:
        """Returns what has to be known before a request can be passed on."""
        return "nothing was received from configuration" if self._flight and self._limits is None else None

    def _return_height(self, flight: Flight) -> float:
        highest = self._limits.fence_height if self._limits else math.inf
        return return_height(flight, self.parameters.return_height, highest)

    def _pass_on(self, flight: Flight, waiting: Waiting, timeout: float) -> Ask:
        request, course = waiting.request, None
        command = request.command
        if command.action == Order.ACTION_RETURN:
            height = self._return_height(flight)
            reason = request_checks.describe(command)
            course = Course(request.source, command.id, command_ids.HOME, height, reason).next(flight)
            command = course.command(flight)
        return self._ask(flight, timeout, Asked(command, course, waiting))

    def _ask(self, flight: Flight, timeout: float, asked: Asked) -> Ask:
        command = Command()
        command.CopyFrom(asked.command)
        command.effective_us = flight.time_us + LEAD_US
        self._asked = replace(asked, command=command)
        return Ask(command, timeout)

    def _take_answer(self, now: float, answer: Answered) -> list[Action]:
        asked, self._asked = self._asked, None
        if asked is None:
            return []
        if asked.waiting is None:
            return self._take_answer_to_course(now, asked, answer)
        if answer.result is None:
            asked.waiting.not_before = now + RETRY_AFTER
            asked.waiting.problem = f"the autopilot does not answer: {answer.problem}"
            return []
        if not answer.result.accepted:
            return self._refuse(asked.waiting, answer.result.reason or "the autopilot refuses")
        # Safety may have decided while the autopilot was answering; its own command follows.
        if overruled := self._overruled():
            return self._refuse(asked.waiting, overruled)
        return self._accept(asked.waiting, asked)

    def _overruled(self) -> str | None:
        """Returns the reason if safety commands the vehicle."""
        if self.authority != Authority.AUTHORITY_SAFETY:
            return None
        return f"safety commands the vehicle: {self._reason}"

    def _take_answer_to_course(self, now: float, asked: Asked, answer: Answered) -> list[Action]:
        if asked.course != self.course:
            return []
        if answer.result and answer.result.accepted:
            self._settled_us = asked.command.effective_us + SETTLING_US
            self._problem = ""
            return []
        self._retry_at = now + RETRY_AFTER
        refused, order = answer.result, request_checks.describe(asked.command)
        problem = f"the autopilot refuses to {order}: {refused.reason}" if refused else "the autopilot does not answer"
        if problem == self._problem:
            return []
        self._problem = problem
        return [Say(f"{problem}; trying again")]

    def _accept(self, waiting: Waiting, asked: Asked) -> list[Action]:
        command, source = waiting.request.command, waiting.request.source
        order = request_checks.describe(command)
        self._hand_over(source, asked.course, order)
        self._settled_us = asked.command.effective_us + SETTLING_US
        return [Say(f"{request_checks.SOURCES[source]}: {order}"), *self._reply(waiting, CommandResult(accepted=True))]

    def _refuse(self, waiting: Waiting, reason: str) -> list[Action]:
        request = waiting.request
        reply = self._reply(waiting, CommandResult(accepted=False, reason=reason))
        text = f"refused to {request_checks.describe(request.command)} for {request_checks.SOURCES[request.source]}: {reason}"
        # A requester that tries again is not worth a line each time.
        if text == self._problem:
            return reply
        self._problem = text
        return [Say(text), *reply]

    def _reply(self, waiting: Waiting, result: CommandResult) -> list[Action]:
        self._waiting.remove(waiting)
        return [Reply(waiting.request.number, result)]

    def _hand_over(self, authority: Authority, course: Course | None, reason: str) -> None:
        self.authority, self.course, self._reason = authority, course, reason
        # What was accepted before no longer matters: the next command is sent at once.
        self._settled_us, self._retry_at, self._problem = 0, 0.0, ""
