#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Length budget: functions, files and parameter lists (needs universal-ctags).

usage: lint_size.py [BUILD_DIR] [SOURCE_DIR]      exit status 0: within the limits
"""
import json
import pathlib
import subprocess
import sys

MAX_LINES = {".c": 500, ".cxx": 500, ".inc": 500, ".h": 200}
MAX_FUNCTION, REVIEW_FUNCTION, MAX_PARAMETERS = 100, 60, 7
FOLDERS = ("engine", "kernels", "partition", "io", "tests", "bench")


def sources(root):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in MAX_LINES:
                yield path


def parameters(signature):
    """Parameters of "(int a, void (*f)(int, int))"; an ellipsis is not counted."""
    depth, count, text = 0, 1, signature.strip()[1:-1]
    for char in text:
        depth += (char in "([") - (char in ")]")
        count += char == "," and depth == 0
    if text.strip() in ("", "void"):
        return 0
    return count - text.rstrip().endswith("...")


def functions(root, files):
    """Tags of every function definition and prototype."""
    command = ["ctags", "--output-format=json", "--languages=C,C++", "--langmap=C:+.inc.h,C++:.cxx",
               "--kinds-C=fp", "--kinds-C++=fp", "--fields=+neSK", "-f", "-", "-L", "-"]
    text = "\n".join(str(f.relative_to(root)) for f in files)
    out = subprocess.run(command, input=text, capture_output=True, text=True, check=True, cwd=root)
    return [json.loads(line) for line in out.stdout.splitlines()]


def check_functions(tags):
    errors, review = [], []
    for tag in tags:
        place = f"{tag['path']}:{tag['line']}: {tag['name']}"
        count = parameters(tag.get("signature", "()"))
        if count > MAX_PARAMETERS:
            errors.append(f"{place}: {count} parameters, at most {MAX_PARAMETERS}")
        if tag["kind"] != "function" or "end" not in tag:
            continue
        length = tag["end"] - tag["line"] + 1
        if length > MAX_FUNCTION:
            errors.append(f"{place}: {length} lines, at most {MAX_FUNCTION}")
        elif length > REVIEW_FUNCTION:
            review.append(f"{place}: {length} lines")
    return errors, review


def main():
    default = pathlib.Path(__file__).resolve().parent.parent
    root = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else default
    files = list(sources(root))
    tags = functions(root, files)
    if not files or not tags:
        sys.exit("no sources or no functions found: nothing was checked")
    errors, review = check_functions(tags)
    for path in files:
        lines = len(path.read_text().splitlines())
        if lines > MAX_LINES[path.suffix]:
            errors.append(f"{path.relative_to(root)}: {lines} lines, at most {MAX_LINES[path.suffix]}")
    for line in review:
        print(f"review: {line}")
    for line in errors:
        print(f"error: {line}")
    print(f"{len(files)} files, {len(tags)} functions and prototypes, {len(errors)} over the limits")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
