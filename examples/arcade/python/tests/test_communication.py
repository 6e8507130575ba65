"""The radio link beside the other ends of its gates."""

import asyncio
import os
import socket

import pytest

from arcade_scl import Action, CommandResult, Communication, Fix, FixQuality, Flight, ParameterResult, Power, Vector
from communication import Datagrams, Link, read_terminal


def test_commands_reach_the_arbiter_and_the_configuration() -> None:
    async def talk() -> None:
        component, peer = Communication.test()
        link = Link(component)
        with component, peer:
            answer = asyncio.create_task(link.carry_out("land"))
            request = await peer.arbiter.recv_async()
            assert (request.message.id, request.message.action) == (10_000, Action.ACTION_LAND)
            request.reply(CommandResult(accepted=True))
            assert await answer == "accepted"

            answer = asyncio.create_task(link.carry_out("return"))
            request = await peer.arbiter.recv_async()
            assert (request.message.id, request.message.action) == (10_001, Action.ACTION_RETURN)
            request.reply(CommandResult(reason="the vehicle is on the ground"))
            assert await answer == "refused: the vehicle is on the ground"

            answer = asyncio.create_task(link.carry_out("set speed 2.5"))
            change = await peer.configuration.recv_async()
            assert (change.message.name, change.message.value) == ("speed", 2.5)
            change.reply(ParameterResult(accepted=True))
            assert await answer == "speed is 2.5"

    asyncio.run(talk())


def test_the_id_of_a_command_follows_the_one_in_effect() -> None:
    async def talk() -> None:
        component, peer = Communication.test()
        with component, peer:
            peer.flight.send(Flight(command_id=10_041))
            component.wait(component.flight)
            answer = asyncio.create_task(Link(component).carry_out("land"))
            request = await peer.arbiter.recv_async()
            assert request.message.id == 10_042
            request.reply(CommandResult(accepted=True))
            await answer

    asyncio.run(talk())


def test_an_arbiter_that_is_away_is_reported() -> None:
    async def talk() -> str:
        component, peer = Communication.test()
        with component:
            peer.close()
            return await Link(component).carry_out("land")

    assert asyncio.run(talk()).startswith("error: no answer: gate `communication.arbiter` ")


def test_mistakes_are_answered_without_asking_anybody() -> None:
    async def talk() -> str:
        component, peer = Communication.test()
        with component, peer:
            return await Link(component).carry_out("lnad")

    assert asyncio.run(talk()) == "error: unknown command `lnad`; did you mean `land`?"


def test_datagrams_are_answered(capsys: pytest.CaptureFixture[str]) -> None:
    async def talk() -> None:
        component, peer = Communication.test()
        with component, peer, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as station:
            link, loop = Link(component), asyncio.get_running_loop()
            transport, _ = await loop.create_datagram_endpoint(lambda: Datagrams(link), local_addr=("127.0.0.1", 0))
            station.setblocking(False)
            await loop.sock_connect(station, transport.get_extra_info("sockname"))
            obeying = asyncio.create_task(link.obey())
            for datagram in [b"land\n", b"\xff\x00", b"\n", 60_000 * b"x", b"land"]:
                await loop.sock_sendall(station, datagram)
            request = await peer.arbiter.recv_async()
            request.reply(CommandResult(accepted=True))
            assert await loop.sock_recv(station, 1000) == b"accepted\n"
            assert (await loop.sock_recv(station, 1000)).startswith(b"error: unknown command `\xef\xbf\xbd\\x00`")
            assert (await loop.sock_recv(station, 1000)).startswith(b"error: commands are ")
            assert len(await loop.sock_recv(station, 100_000)) < 300
            (await peer.arbiter.recv_async()).reply(CommandResult(reason="busy"))
            assert await loop.sock_recv(station, 1000) == b"refused: busy\n"
            obeying.cancel()
            transport.close()

    asyncio.run(talk())
    assert "'land': accepted\n" in capsys.readouterr().out


def test_commands_that_nobody_answers_do_not_pile_up() -> None:
    component, peer = Communication.test()
    with component, peer:
        link = Link(component)
        answers: list[str] = []
        for _ in range(20):
            link.take("land", answers.append)
        assert answers == 4 * ["error: too many commands wait for an answer"]


def test_typed_lines_are_taken_until_the_end_of_the_input() -> None:
    async def talk() -> None:
        component, peer = Communication.test()
        with component, peer:
            link, loop = Link(component), asyncio.get_running_loop()
            terminal, keyboard = os.pipe()
            loop.add_reader(terminal, read_terminal, link, terminal)
            os.write(keyboard, b"land\nreturn\n")
            assert [(await link.commands.get())[0] for _ in range(2)] == ["land", "return"]
            os.close(keyboard)
            read_terminal(link, terminal)
            assert not loop.remove_reader(terminal)
            os.close(terminal)

    asyncio.run(talk())


def test_a_line_shows_the_newest_messages() -> None:
    component, peer = Communication.test()
    with component, peer:
        link = Link(component)
        for east in [1, 2]:
            peer.flight.send(Flight(time_us=east * 1_000_000, position=Vector(x=east), position_valid=True))
        peer.fix.send(Fix(satellites=9, quality=FixQuality.FIX_QUALITY_3D))
        peer.power.send(Power(charge_left=0.5))
        for gate in (component.flight, component.fix, component.power):
            component.wait(gate)
        while link.vehicle.line(0).find("east 2.0") < 0:
            link.look()
        line = link.vehicle.line(link.vehicle.flight.arrived)
        assert line.startswith("time 2.0 s, mode grounded, east 2.0, north 0.0, height 0.0 m, battery 50%")
        assert line.endswith("satellites 9")
