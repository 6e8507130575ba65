"""The last lines: a table of stages, and the tests that failed or were flaky."""

import re


def show(results):
    print("\n==== summary")
    width = max(len(result.name) for result in results)
    for result in results:
        verdict = "FAILED" if result.problems else "passed"
        print(f"{result.name:{width}}  {verdict}  {result.seconds:5.0f} s")
        for problem in result.problems:
            print(f"{'':{width}}  {problem}")
    print(f"{'all':{width}}          {sum(result.seconds for result in results):5.0f} s")
    for result in results:
        panics = panics_of("".join(log.read_text(errors="replace") for log in result.logs)) if result.failed else {}
        for binary, name in result.failed:
            print(f"FAILED {binary} {name}: {panics.get(name, 'see its output above')}")
    for result in results:
        for test in result.flaky:
            print(f"FLAKY {test}")


def panics_of(log):
    """The place where each test panicked, and the first line of what it said."""
    found = re.findall(r"thread '([^']+)'(?: \(\d+\))? panicked at (\S+):\n\s*(.*)", log)
    return {name: f"{place} {text}" for name, place, text in found}
