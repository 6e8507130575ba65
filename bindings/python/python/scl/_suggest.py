"""Suggestions for misspelt names."""

from __future__ import annotations

from collections.abc import Iterable


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Returns the end of an error text, empty if no known name is similar."""
    import difflib

    nearest = difflib.get_close_matches(name, [it for it in known if not it.startswith("_")], n=1)
    return f"; did you mean `{nearest[0]}`?" if nearest else ""
