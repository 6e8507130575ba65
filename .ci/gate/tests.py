"""What tests say: which failed, which were flaky, which did not run."""

import re
import subprocess
import xml.etree.ElementTree as xml
from pathlib import Path

# In place of a name.
ALL = "(ended without a result)"
DOCUMENTATION = "documentation of"
# Ends the last binary of a log.
LAST = "     Running the end (end-0000000000000000)"


def junit_of(command):
    """The report that a run of nextest writes."""
    profile = re.search(r"nextest run --profile (\S+)", command)
    return Path(f"target/nextest/{profile.group(1)}/junit.xml") if profile else None


def read(stage, junit, log):
    """Failed and flaky tests as (binary, name), and the names of ignored ones."""
    if junit:
        failed, flaky = read_junit(junit)
        return failed, flaky, ignored_by_nextest(stage.command)
    if "cargo test" in stage.command:
        return read_cargo_test(log)
    return [], [], []


def read_junit(path):
    failed, flaky = [], []
    if not path.exists():
        return [("nextest", "has written no report")], []
    for suite in xml.parse(path).getroot().iter("testsuite"):
        for case in suite.iter("testcase"):
            test = (suite.get("name"), case.get("name"))
            if case.find("failure") is not None or case.find("error") is not None:
                failed.append(test)
            elif case.find("flakyFailure") is not None or case.find("flakyError") is not None:
                flaky.append(" ".join(test))
    return failed, flaky


def ignored_by_nextest(command):
    """Nextest does not report ignored tests."""
    listing = command.replace("nextest run", "nextest list -T oneline --run-ignored only")
    listing = re.sub(r"--retries \d+", "", listing)
    listing = listing[listing.index("cargo nextest"):]
    run = subprocess.run(["bash", "-c", f"exec {listing}"], stdout=subprocess.PIPE, text=True)
    return run.stdout.splitlines() if run.returncode == 0 else [f"unknown, because `{listing}` failed"]


def read_cargo_test(log):
    """A binary that ends without a result, which runs the rest of its tests never, failed as a whole."""
    failed, ignored, slow, binary, unfinished = [], [], [], None, False
    for line in log.splitlines() + [LAST]:
        if running := re.match(r"\s+(?:Running .*\((?:.*/)?(\S+)-[0-9a-f]{16}\)|Doc-tests (\S+))", line):
            if unfinished:
                failed += slow or [(binary, ALL)]
            binary = running.group(1) or f"{DOCUMENTATION} {running.group(2)}"
            slow, unfinished = [], False
        elif re.match(r"running \d+ tests?$", line):
            unfinished = True
        elif line.startswith("test result: "):
            unfinished = False
        elif hanging := re.match(r"test (.*) has been running for over 60 seconds", line):
            slow.append((binary, hanging.group(1)))
        elif ended := re.match(r"test (.*?)(?: - should panic)? \.\.\. (ok|FAILED|ignored)", line):
            test = (binary, ended.group(1))
            slow = [other for other in slow if other != test]
            if ended.group(2) == "FAILED":
                failed.append(test)
            # Examples in documentation that are not Rust programs are ignored too.
            elif ended.group(2) == "ignored" and not re.search(r" \(line \d+\)$", ended.group(1)):
                ignored.append(" ".join(test))
    return failed, [], ignored
