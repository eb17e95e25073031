# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whether each option, each of its words and each kind of file has had a test that looked at what
came out. Options are those of --help; what was looked at is in the notes of the other tests.

    python3 TestSplatmipComplete.py PROGRAM NOTES...
"""
import re
import subprocess
import sys

# What comes out of these is no file: test_version, test_help, TestWindow.
WITHOUT_FILE = {"--help", "--version", "--interactive"}


def split_help(text):
    """The help's first words of an option, and all else that is said of it."""
    starts = list(re.finditer(r"(?m)^  (?:(-\w,)?(--[a-z-]+)|(file)\b)", text))
    ends = [match.start() for match in starts[1:]] + [text.index("Examples:")]
    return {match.group(2) or match.group(3): text[match.start():end]
            for match, end in zip(starts, ends)}


def find_endings(text):
    return re.findall(r"(?<!\w)\.[a-z]+(?:\.gz)?", text)


def list_wanted(options):
    """What must have been looked at, as SplatmipTesting.look_at() notes it."""
    wanted = set(options) - WITHOUT_FILE - {"file"}
    for name, text in options.items():
        choices = re.search(r"\{([^}]*)\}", text)
        if choices:
            wanted.update(f"{name} {choice}" for choice in choices.group(1).split(","))
    wanted.update("input " + ending for ending in find_endings(options["file"]))
    wanted.update("input " + kind for kind in ("folder", "DICOMDIR") if kind in options["file"])
    wanted.update("output " + ending for ending in find_endings(options["--output"]))
    return wanted


def main():
    program, *notes = sys.argv[1:]
    text = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    wanted = list_wanted(split_help(text))
    looks = set()
    for name in notes:
        with open(name, encoding="utf-8") as file:
            looks.update(file.read().splitlines())
    assert len(wanted) > 60, wanted  # the help has been understood
    missing = sorted(wanted - looks)
    for name in missing:
        print(f"ERROR: no test has looked at what comes of: {name}")
    print(f"{len(wanted) - len(missing)} of {len(wanted)} options, words and kinds of files")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
