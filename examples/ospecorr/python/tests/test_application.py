"""The application beside the other ends of its gates."""

import asyncio
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import asynccontextmanager, suppress

import pytest

from application import RequirementsRefused, Stream, describe_change, on_change
from ospecorr_scl import Application, ApplicationPeer, LinkState, Received, RequirementsResult
from quality import Requirement

REQUIRED = Requirement(rate=20_000, longest_gap=0.2)


@asynccontextmanager
async def running() -> AsyncIterator[ApplicationPeer]:
    """The other ends of a running application's gates."""
    application, peer = Application.test()
    stream = asyncio.create_task(Stream(application, REQUIRED).run())
    yield peer
    stream.cancel()
    with suppress(asyncio.CancelledError):
        await stream
    application.close()
    peer.close()


async def accept(peer: ApplicationPeer) -> None:
    """Answers one request for a link."""
    request = await peer.requirements.recv_async()
    assert (request.message.rate, request.message.longest_gap) == (20_000, 0.2)
    request.reply(RequirementsResult(accepted=True))


async def carry(peer: ApplicationPeer) -> None:
    """Hands frames over to the far end, one each 10 ms of the spectrum's clock."""
    async for frame in peer.frames:
        time_us = (frame.number + 1) * 10_000
        peer.received.send(Received(time_us=time_us, number=frame.number, length=len(frame.data)))


def asynchronous(test: Callable[[], Coroutine[None, None, None]]) -> Callable[[], None]:
    """Runs a test in an event loop, and ends it if it hangs."""

    def run() -> None:
        asyncio.run(asyncio.wait_for(test(), 60))

    run.__name__ = test.__name__
    return run


@asynchronous
async def test_frames_are_numbered_and_start_when_the_requirements_are_accepted() -> None:
    async with running() as peer:
        request = await peer.requirements.recv_async()
        assert peer.frames.try_recv() is None
        request.reply(RequirementsResult(accepted=True))
        for number in range(5):
            frame = await peer.frames.recv_async()
            assert (frame.number, len(frame.data)) == (number, 200)


@asynchronous
async def test_the_requirements_are_repeated() -> None:
    async with running() as peer:
        for _ in range(3):
            await accept(peer)


@asynchronous
async def test_a_refusal_ends_the_program() -> None:
    application, peer = Application.test()
    stream = asyncio.create_task(Stream(application, REQUIRED).run())
    (await peer.requirements.recv_async()).reply(RequirementsResult(accepted=False, reason="too fast"))
    with pytest.raises(RequirementsRefused, match="too fast"):
        await stream


def test_each_change_of_the_channel_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    async def test() -> None:
        async with running() as peer:
            for time_us, channel, transmit in [(1, 2, True), (2, 2, False), (3, 2, True), (4, 5, False), (5, 5, True)]:
                peer.link.send(LinkState(time_us=time_us * 1000, channel=channel, transmit=transmit, reason="so"))
            while "channel 5" not in (printed := capsys.readouterr().out):
                await asyncio.sleep(0)
            lines = [line for line in printed.splitlines() if "channel" in line]
            assert lines == ["0.001 s: on channel 2: so", "0.005 s: on channel 5 after 2: so"]

    asyncio.run(asyncio.wait_for(test(), 60))


def test_service_is_lost_without_frames_and_comes_back(capsys: pytest.CaptureFixture[str]) -> None:
    async def next_line(start: str) -> str:
        while True:
            for line in capsys.readouterr().out.splitlines():
                if line.startswith(start):
                    return line
            await asyncio.sleep(0.01)

    async def test() -> None:
        async with running() as peer:
            assert await next_line("not served") == "not served: 0 of 20000 bytes/s"
            await accept(peer)
            for _ in range(2):
                carrying = asyncio.create_task(carry(peer))
                assert (await next_line("served")).endswith("; 0 frames lost so far")
                carrying.cancel()
                await next_line("not served")

    asyncio.run(asyncio.wait_for(test(), 60))


def test_a_change_names_both_channels() -> None:
    link = LinkState(time_us=12_345_678, channel=3, reason="channel 1 is occupied")
    assert describe_change(1, link) == "12.346 s: on channel 3 after 1: channel 1 is occupied"


def test_what_does_not_change_is_printed_once(capsys: pytest.CaptureFixture[str]) -> None:
    say = on_change()
    say("served after 1 s", key="served")
    say("served after 2 s", key="served")
    say("not served")
    say("not served")
    say("served after 3 s", key="served")
    assert capsys.readouterr().out == "served after 1 s\nnot served\nserved after 3 s\n"
