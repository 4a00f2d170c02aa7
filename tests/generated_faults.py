#!/usr/bin/env python3
"""Faults for planted_faults.sh that nobody chose: one operator or number of a line of a kernel, changed.

  tests/generated_faults.py NUMBER SEED     so many of them, in the form of planted_faults.sh; the same for the same seed

Only lines that their file holds once, so that the fault is where its name says. A line that starts with # or // or that
declares something is left alone.
"""

import pathlib
import random
import re
import sys

# What becomes what; each keeps a kernel valid, mostly.
CHANGES = [(r" <= ", " < "), (r" < ", " <= "), (r" >= ", " > "), (r" > ", " >= "), (r" == ", " != "), (r" != ", " == "),
           (r" && ", " || "), (r" \|\| ", " && "), (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "),
           (r"\bmin\(", "max("), (r"\bmax\(", "min("), (r"\b0\.0f", "1.0f"), (r"\b1\.0f", "0.0f"), (r"\b0\.5f", "0.25f"),
           (r"\btrue\b", "false"), (r"\bfalse\b", "true"), (r"\b0u\b", "1u"), (r"\b1u\b", "2u")]
LEFT_ALONE = re.compile(r"\s*(//|#|struct |INPUT|OUTPUT|ARGS|SWITCH|KERNEL|const |/\*)|^\}?;?$")


def changed(line):
    """All lines that differ from this one by one change."""
    code = line.split("//")[0]
    return [code[:m.start()] + to + line[m.end():] for of, to in CHANGES for m in re.finditer(of, code)]


def main():
    number, seed = int(sys.argv[1]), int(sys.argv[2])
    found = []
    for path in sorted(pathlib.Path("include").glob("*/*/**/*.glsl")):
        lines = path.read_text(encoding="utf-8").split("\n")
        for at, line in enumerate(lines):
            if not LEFT_ALONE.match(line) and sum(line in other for other in lines) == 1:
                found += [(f"generated: {path.name}:{at + 1}", str(path), line, to) for to in changed(line)]
    for parts in random.Random(seed).sample(found, min(number, len(found))):
        print("|".join(p.replace("|", r"\|") for p in parts))


if __name__ == "__main__":
    main()
