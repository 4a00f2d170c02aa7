"""Follows the pages that add a kind of shape, light or material, or a setting. See tests/growth.sh."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

# The most files of the library, its program and its schema that each may touch.
MOST = {"shape": 8, "light": 8, "material": 6, "setting": 5}
# Files that a command makes of the table of settings: "photongrid_setting_texts".
MADE = {"setting": ["examples/scenes/photongrid-scene.schema.json", "docs/reference/settings.md"]}
NEW = re.compile(r"New file `([^`]+)`:")
BLOCK = re.compile(
    r"(?P<said>[^\n][^`\n]*(?:`[^`]*`[^`\n]*)*)\n\n```(?P<kind>\w+)\n(?P<text>.*?)```\n", re.DOTALL)
EDIT = re.compile(r"In `([^`]+)`, (after|before|in place of) `([^`]+)`:", re.DOTALL)


class Page:
    """The steps of a page: files to write, edits of files, and commands."""

    def __init__(self, name, text):
        self.name = name
        self.commands = []
        self.files = []  # (path, place, anchor, text); place None: a new file
        for block in BLOCK.finditer(text):
            if block["kind"] == "sh":
                self.commands.append(block["text"])
            elif new := NEW.fullmatch(block["said"]):
                self.files.append((new[1], None, None, block["text"]))
            elif edit := EDIT.fullmatch(block["said"]):
                self.files.append((edit[1], edit[2], edit[3], block["text"]))
            else:
                sys.exit(f"{name}: a block of {block['kind']} after: {block['said']}\n"
                         '  say "New file `X`:" or "In `X`, after `Y`:"')

    def follow(self, root):
        for path, place, anchor, text in self.files:
            file = root / path
            if place is None:
                if file.exists():
                    sys.exit(f"{self.name}: {path} is there already")
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text)
                continue
            before = file.read_text()
            if before.count(anchor) != 1:
                sys.exit(f"{self.name}: {path} has {before.count(anchor)} times what the page names: {anchor}")
            at = before.index(anchor)
            past = at + len(anchor)
            if place == "after":  # whole lines
                at = past = before.index("\n", past) + 1
            elif place == "before":
                at = past = before.rindex("\n", 0, at) + 1
            else:  # a part of a line keeps the line's end
                text = text.removesuffix("\n")
            file.write_text(before[:at] + text + before[past:])

    def touched(self):
        """The files of the library that the page touches, without tests, in which new kinds are only drawn."""
        return sorted({path for path, *_ in self.files if not path.startswith("tests/")} | set(MADE.get(self.name, [])))


def copy_sources(to):
    for folder, folders, files in os.walk("."):
        if folder == ".":
            folders[:] = [f for f in folders if f not in (".git", "out") and not f.startswith("build")]
        for name in files:
            path = pathlib.Path(folder, name)
            target = to / path
            target.parent.mkdir(parents=True, exist_ok=True)
            if not target.exists() or target.read_bytes() != path.read_bytes():
                shutil.copy2(path, target)  # what has not changed need not be built again


def run(command, root):
    print(f"growth: {command.strip()}", flush=True)
    environment = dict(os.environ, PATH=f"{root / 'build'}:{os.environ['PATH']}")
    subprocess.run(["bash", "-euo", "pipefail", "-c", command], cwd=root, env=environment, check=True)


def main(arguments):
    builds = "--build" in arguments
    names = [a for a in arguments if a != "--build"] or list(MOST)
    root = pathlib.Path("build-growth")
    copy_sources(root)
    pages = [Page(name, pathlib.Path(f"docs/guide/add_a_{name}.md").read_text()) for name in names]
    failed = False
    for page in pages:
        for path, place, *_ in page.files:
            if place is None:
                (root / path).unlink(missing_ok=True)  # of a run before
        page.follow(root)
        touched = page.touched()
        print(f"growth: a {page.name} touches {len(touched)} files; at most {MOST[page.name]}")
        if len(touched) > MOST[page.name]:
            print("".join(f"  {path}\n" for path in touched) + "growth: let a table or one place of its kind say it")
            failed = True
    if builds:
        configure = "cmake --preset release -DPHOTONGRID_WERROR=ON"
        if shutil.which("ccache"):
            configure += " -DCMAKE_CXX_COMPILER_LAUNCHER=ccache"
        run(f"{configure} >configure.log || {{ cat configure.log; false; }}", root.resolve())
        run("cmake --build build --target photongrid_program", root.resolve())
        for page in pages:
            for command in page.commands:
                run(command, root.resolve())
    return failed


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
