# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Links of the documents lead somewhere, and their tables are those of the recorded figures."""
import pathlib
import re
import subprocess
import sys
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = ("Examples", "Module", "Rendering", "Testing")


class TestDocuments(unittest.TestCase):
    def documents(self):
        yield TOP / "README.md"
        for folder in FOLDERS:
            yield from (TOP / folder).rglob("*.md")

    def test_links(self):
        links = 0
        for document in self.documents():
            for link in re.findall(r"\]\(([^)#]+)[^)]*\)", document.read_text(encoding="utf-8")):
                if "://" not in link:
                    links += 1
                    self.assertTrue((document.parent / link).exists(), f"{document}: {link}")
        self.assertGreater(links, 20)

    def test_figures(self):
        """Each table is what figures.py makes of the recorded run."""
        subprocess.run([sys.executable, TOP / "Testing/Benchmark/figures.py", "check"], check=True)


if __name__ == "__main__":
    unittest.main()
