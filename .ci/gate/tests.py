"""What tests say: which failed, which were flaky, which did not run."""

import re
import subprocess
import xml.etree.ElementTree as xml
from pathlib import Path


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
    listing = re.sub(r"nextest run", "nextest list -T oneline --run-ignored only", command)
    listing = re.sub(r"--no-fail-fast|--retries \d+", "", listing)
    output = subprocess.run(["bash", "-c", "exec " + listing[listing.index("cargo nextest"):]], capture_output=True, text=True)
    return output.stdout.split("\n")[:-1]


def read_cargo_test(log):
    failed, ignored, binary = [], [], None
    for line in log.splitlines():
        if running := re.match(r"\s+(?:Running .*\((?:.*/)?(\S+)-[0-9a-f]{16}\)|Doc-tests (\S+))", line):
            binary = running.group(1) or f"documentation of {running.group(2)}"
        elif failure := re.match(r"test (.*?)(?: - should panic)? \.\.\. FAILED", line):
            failed.append((binary, failure.group(1)))
        # Examples in documentation that are not Rust programs are ignored too.
        elif (skipped := re.match(r"test (.*) \.\.\. ignored", line)) and not re.search(r" \(line \d+\)$", skipped.group(1)):
            ignored.append(f"{binary} {skipped.group(1)}")
    return failed, [], ignored
