"""Runs the stages of the gate, all of them, whatever fails: `python3 .ci/gate (gate|full) [STAGE...]`."""

import sys

import report
import stages
from runner import Runner


def main():
    which, *names = sys.argv[1:]
    chosen = stages.stages(which)
    unknown = set(names) - {stage.name for stage in chosen}
    if unknown:
        print(f"error: no stage {', '.join(sorted(unknown))}", file=sys.stderr)
        print(f"  = help: the stages are {', '.join(stage.name for stage in chosen)}", file=sys.stderr)
        return 2
    runner = Runner()
    results = [runner.run(stage) for stage in chosen if not names or stage.name in names]
    report.show(results)
    return 1 if any(result.problems for result in results) else 0


sys.exit(main())
