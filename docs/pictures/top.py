#!/usr/bin/env python3
"""Draws top.svg: `scl top` on the running quick start, as a terminal shows it.

    cargo build && python3 docs/pictures/top.py

Needs tmux, which is the terminal. Only process ids, processor time and memory differ from run to run.
"""

import html
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCL = ROOT / "target/debug/scl"
COMPONENTS = ["sensor", "controller", "actuator", "user_interface"]
COLUMNS, LINES = 80, 18
CHARACTER, LINE = 8.4, 18
COLOURS = {"1": "#cc6666", "2": "#8ec07c", "3": "#e5c07b"}


def main():
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "SCL_RUNTIME_DIR": folder}
        programs = [ROOT / "target/debug" / name for name in COMPONENTS]
        running = [subprocess.Popen([it], env=environment, stdout=subprocess.DEVNULL) for it in programs]
        try:
            # A rate needs some seconds to settle.
            screen = captured(environment, 15)
        finally:
            for program in running:
                program.terminate()
                program.wait()
    (Path(__file__).parent / "top.svg").write_text(svg(screen))


def captured(environment, seconds):
    """What `scl top` shows after a time, with its colours."""
    tmux = ["tmux", "-L", f"scl-{os.getpid()}"]
    command = f"SCL_RUNTIME_DIR={environment['SCL_RUNTIME_DIR']} {SCL} top"
    # Until the first component has announced itself, there is no system.
    while subprocess.run([SCL, "top", "--once"], env=environment, capture_output=True).returncode:
        time.sleep(0.2)
    subprocess.run([*tmux, "new-session", "-d", "-x", str(COLUMNS), "-y", str(LINES), command], check=True)
    try:
        time.sleep(seconds)
        # The third gate, with its connections.
        subprocess.run([*tmux, "send-keys", "Down", "Down", "Down", "Enter"], check=True)
        time.sleep(1)
        return subprocess.run([*tmux, "capture-pane", "-p", "-e"], check=True, capture_output=True, text=True).stdout
    finally:
        subprocess.run([*tmux, "kill-server"], check=False)


def svg(screen):
    width, height = COLUMNS * CHARACTER + 24, LINES * LINE + 24
    texts = [line for number, text in enumerate(screen.splitlines()) for line in spans(number, text)]
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height:g}" '
        f'viewBox="0 0 {width:g} {height:g}">',
        f'<rect width="{width:g}" height="{height:g}" rx="8" fill="#1d2021"/>',
        '<g font-family="ui-monospace, Menlo, Consolas, DejaVu Sans Mono, monospace" font-size="14" fill="#d5c4a1" '
        'xml:space="preserve">',
        *texts,
        "</g>",
        "</svg>",
        "",
    ])


def spans(number, text):
    """One SVG text for each run of characters in the same style."""
    column, style = 0, {}
    for part in re.split(r"(\x1b\[[0-9;]*m)", text):
        if part.startswith("\x1b"):
            style = changed(style, part[2:-1].split(";"))
        elif part:
            yield from span(number, column, part, style)
            column += len(part)


def changed(style, codes):
    if codes in ([""], ["0"]):
        return {}
    if codes[:2] == ["38", "5"]:
        return {**style, "colour": codes[2]}
    simple = {"1": {"bold": True}, "2": {"dim": True}, "7": {"reversed": True}, "39": {"colour": None}}
    for code in codes:
        if re.fullmatch("3[0-7]", code):
            style = {**style, "colour": code[1]}
        style = {**style, **simple.get(code, {})}
    return style


def span(number, column, text, style):
    x, y = 12 + column * CHARACTER, 12 + number * LINE
    length = len(text) * CHARACTER
    fill = COLOURS.get(style.get("colour"))
    if style.get("reversed"):
        yield f'<rect x="{x:g}" y="{y:g}" width="{length:g}" height="{LINE}" fill="#d5c4a1"/>'
        fill = "#1d2021"
    attributes = f' fill="{fill}"' if fill else ""
    attributes += ' font-weight="bold"' if style.get("bold") else ""
    attributes += ' opacity="0.6"' if style.get("dim") else ""
    words = text.strip()
    if words:
        # Viewers differ in what they do with spaces at the ends.
        x += (len(text) - len(text.lstrip())) * CHARACTER
        length = len(words) * CHARACTER
        shown = html.escape(words)
        yield f'<text x="{x:g}" y="{y + 13.5:g}" textLength="{length:g}"{attributes}>{shown}</text>'


if __name__ == "__main__":
    sys.exit(main())
