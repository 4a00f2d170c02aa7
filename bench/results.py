#!/usr/bin/env python3
"""Measures as data files, and the page that shows some of them.

  bench/results.py take MEASURED     writes what bench/run.sh printed to bench/results/NAME.json, a file a section
  bench/results.py page              draws the tables and the list of docs/reference/measures.md anew
  bench/results.py show NAME         prints a file as Markdown
  bench/results.py check             exits 1 where a file is malformed, or the page is not what `page` would draw

A file has its section's title and what it answers; the command, the machine, the date and the commit that it was
measured with, and maybe the versions of libraries and the devices; `parts`, which are notes and tables in the order in
which they were printed; and `remarks`, which somebody wrote `on` the measures of a commit. Figures of others, which no
command here prints, have a `source` instead of a command and a commit.

In the page, what is between a mark and its end is drawn:

  <!-- table: NAME -->                       all columns and rows of the file's tables, and how old they are
  <!-- table: NAME | columns: a; b -->       these columns alone
  <!-- table: NAME | where: a = x / y -->    the rows with these values of a
  <!-- table: NAME | across: a; b -->        a column for each value of a, which holds b
  <!-- /table -->
  <!-- list --> and <!-- /list -->           a line for each file that the page has no table of

A mark may go on in further lines. Where columns share a name, a#2 is the second a.
"""
import json
import os
import re
import sys
import textwrap

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
RESULTS = os.path.join(ROOT, "bench", "results")
PAGE = os.path.join(ROOT, "docs", "reference", "measures.md")
# The keys of a file, in order; those with False may be missing.
KEYS = {"title": True, "answers": True, "command": False, "source": False, "machine": True, "date": True,
        "commit": False, "versions": False, "devices": False, "parts": True, "remarks": False}


class Malformed(Exception):
    pass


def is_text(value):
    return isinstance(value, str) and value.strip() == value and value != ""


def check_result(result):
    """Raises Malformed with what is wrong."""
    if not isinstance(result, dict):
        raise Malformed("no object")
    for key in result:
        if key not in KEYS:
            raise Malformed(f"unknown key {key}")
    for key, needed in KEYS.items():
        if needed and key not in result:
            raise Malformed(f"no {key}")
        if key in result and key not in ("parts", "remarks") and not is_text(result[key]):
            raise Malformed(f"{key} is no text")
    for key in ("title", "answers", "command", "machine"):
        if "\n" in result.get(key, ""):
            raise Malformed(f"{key} has several lines")
    if not re.fullmatch(r"\d{4}(-\d\d-\d\d)?", result["date"]):
        raise Malformed(f"date {result['date']} is none")
    if "source" in result:
        if "command" in result or "commit" in result:
            raise Malformed("a source besides a command or a commit")
    else:
        if "command" not in result:
            raise Malformed("no command")
        if not re.fullmatch(r"[0-9a-f]{7,40}", result.get("commit", "")):
            raise Malformed("no commit")
    if not isinstance(result["parts"], list) or not result["parts"]:
        raise Malformed("no parts")
    for part in result["parts"]:
        if not isinstance(part, dict):
            raise Malformed("a part is no object")
        if set(part) == {"note"}:
            if not is_text(part["note"]):
                raise Malformed("a note is no text")
        elif set(part) == {"columns", "rows"}:
            columns, rows = part["columns"], part["rows"]
            if not isinstance(columns, list) or not columns or not isinstance(rows, list) or not rows:
                raise Malformed("a table without columns or rows")
            for row in [columns, *rows]:
                if not isinstance(row, list) or not all(isinstance(c, str) and "\n" not in c for c in row):
                    raise Malformed("a row is no list of texts")
                if len(row) != len(columns):
                    raise Malformed(f"{len(columns)} columns, and a row of {len(row)}: {row[:3]}")
        else:
            raise Malformed(f"a part with {', '.join(sorted(part))}")
    for remark in result.get("remarks", []):
        if not isinstance(remark, dict) or set(remark) != {"on", "text"} or not all(map(is_text, remark.values())):
            raise Malformed("a remark is no text on a commit")


def text_of_result(result):
    """The file: a line for each row, so that a difference shows rows."""
    def text(value):
        return json.dumps(value, ensure_ascii=False)

    lines = []
    for key in KEYS:
        if key not in result:
            continue
        if key == "parts":
            parts = []
            for part in result["parts"]:
                if "note" in part:
                    parts.append(f'    {{"note": {text(part["note"])}}}')
                else:
                    rows = ",\n".join(f"      {text(row)}" for row in part["rows"])
                    parts.append(f'    {{"columns": {text(part["columns"])}, "rows": [\n{rows}\n    ]}}')
            value = "[\n" + ",\n".join(parts) + "\n  ]"
        elif key == "remarks":
            value = "[\n" + ",\n".join(f"    {text(remark)}" for remark in result["remarks"]) + "\n  ]"
        else:
            value = text(result[key])
        lines.append(f'  "{key}": {value}')
    return "{\n" + ",\n".join(lines) + "\n}\n"


def load(name):
    path = os.path.join(RESULTS, name + ".json")
    try:
        with open(path, encoding="utf-8") as f:
            text = f.read()
    except OSError as e:
        raise Malformed(f"there is no bench/results/{name}.json") from e
    try:
        result = json.loads(text)
        check_result(result)
    except (Malformed, ValueError) as e:
        raise Malformed(f"bench/results/{name}.json: {e}") from e
    return result, text


def store(name, result):
    try:
        check_result(result)
    except Malformed as e:
        raise Malformed(f"bench/results/{name}.json: {e}") from e
    os.makedirs(RESULTS, exist_ok=True)
    with open(os.path.join(RESULTS, name + ".json"), "w", encoding="utf-8") as f:
        f.write(text_of_result(result))


def names():
    return sorted(n[:-len(".json")] for n in os.listdir(RESULTS) if n.endswith(".json"))


def load_all():
    """All files by name. Two with one title would both be where `take` writes."""
    results, titles = {}, {}
    for name in names():
        results[name], _ = load(name)
        title = results[name]["title"]
        if title in titles:
            raise Malformed(f"bench/results/{name}.json has the title of {titles[title]}.json: {title}")
        titles[title] = name
    return results


# What bench/run.sh prints.

def cells_of(line):
    line = line.strip()
    return [cell.strip() for cell in line[1:-1 if line.endswith("|") else None].split("|")]


def parts_of(lines):
    """Notes, whose lines are joined unless they are items of a list, and tables."""
    parts, open_note = [], False
    at = 0
    while at < len(lines):
        line = lines[at].rstrip()
        if line.startswith("|"):
            table = []
            while at < len(lines) and lines[at].startswith("|"):
                table.append(cells_of(lines[at]))
                at += 1
            if len(table) < 2 or not all(re.fullmatch(r":?-+:?", cell) for cell in table[1]):
                raise Malformed(f"a table without a line below its columns: {lines[at - 1]}")
            if len(table) > 2:
                parts.append({"columns": table[0], "rows": table[2:]})
            open_note = False
            continue
        at += 1
        if not line:
            open_note = False
        elif open_note:
            parts[-1]["note"] += ("\n" if line.startswith("- ") else " ") + line.strip()
        else:
            parts.append({"note": line.strip()})
            open_note = True
    return parts


def name_of_title(title):
    return re.sub(r"[^a-z0-9]+", "_", title.lower()).strip("_")


def take(path):
    with open(path, encoding="utf-8") as f:
        lines = f.read().splitlines()
    machine, sections, about = None, [], []
    for line in lines:
        if line.startswith("Machine: "):
            machine = line[len("Machine: "):]
        elif line.startswith("### "):
            sections.append((line[len("### "):].strip(), []))
        elif sections:
            sections[-1][1].append(line)
        elif machine and line.strip():
            about.append(line.rstrip())
    if not machine:
        raise Malformed(f"{path} has no line that begins with `Machine: `")
    where, date, versions = (word.strip() for word in machine.split(";", 2))
    found = re.fullmatch(r"(.*?),? *photongrid ([0-9a-f]{7,40})", versions, re.DOTALL)
    if not found:
        raise Malformed(f"{path} was measured outside of a repository: it names no commit")
    of_title = {result["title"]: name for name, result in load_all().items()}
    failed = False
    for title, text in sections:
        name = of_title.get(title, name_of_title(title))
        old = load(name)[0] if title in of_title else {}
        command = next((line[len("Command: "):].strip() for line in text if line.startswith("Command: ")), None)
        parts = parts_of([line for line in text if not line.startswith("Command: ")])
        if not parts:
            print(f"results.py: nothing was printed under {title}; its file stays as it is", file=sys.stderr)
            failed = True
            continue
        result = {"title": title, "answers": old.get("answers", title), "command": command or old.get("command", ""),
                  "machine": where, "date": date, "commit": found[2], "versions": found[1].rstrip(" ;,"),
                  "parts": parts}
        if about:
            result["devices"] = "\n".join(about)
        if old.get("remarks"):
            result["remarks"] = old["remarks"]
            print(f"results.py: {name} keeps its remarks on older measures; see whether they hold", file=sys.stderr)
        if not old:
            print(f"results.py: {name} is new; write into the file what it answers", file=sys.stderr)
        store(name, result)
    return 1 if failed else 0


# The page.

def age_of(result):
    if "source" in result:
        return f"{result['source']}; {result['machine']}; {result['date']}"
    return f"{result['machine']}; {result['date']}; photongrid {result['commit']}"


def table_text(columns, rows):
    def line(cells):
        return "|" + "".join(f" {cell} |" if cell else " |" for cell in cells)

    return "\n".join([line(columns), "|" + "---|" * len(columns), *(line(row) for row in rows)])


def drawn_table(part, options):
    columns, rows = part["columns"], part["rows"]

    def index(column):
        name, _, number = column.partition("#")
        found = [i for i, other in enumerate(columns) if other == name]
        if len(found) < int(number or 1):
            raise Malformed(f"no column is called {column}")
        return found[int(number or 1) - 1]

    for condition in filter(None, options.get("where", "").split(";")):
        column, _, values = condition.partition("=")
        at, wanted = index(column.strip()), [value.strip() for value in values.split(" / ")]
        rows = [row for row in rows if row[at] in wanted]
    shown = [column.strip() for column in options["columns"].split(";")] if "columns" in options else columns
    if "across" not in options:
        picked = [index(column) for column in shown] if "columns" in options else range(len(columns))
        return table_text([columns[i] for i in picked], [[row[i] for i in picked] for row in rows])
    across, cell = (column.strip() for column in options["across"].split(";"))
    kept = [index(column) for column in shown if column not in (across, cell)]
    values = list(dict.fromkeys(row[index(across)] for row in rows))
    lines = {}
    for row in rows:
        lines.setdefault(tuple(row[i] for i in kept), {})[row[index(across)]] = row[index(cell)]
    return table_text([columns[i] for i in kept] + [f"{across} {value}" for value in values],
                      [list(key) + [of.get(value, "") for value in values] for key, of in lines.items()])


def wrapped(text, indent=""):
    return textwrap.fill(text, 120, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def drawn(mark, results, shown):
    """What belongs below a mark."""
    if mark == "list":
        lines = []
        for name, result in results.items():
            if name in shown:
                continue
            age = f"{result['date']} {result['commit']}" if "commit" in result else result["date"]
            how = f"`{result['command']}`" if "command" in result else result["source"]
            text = f"- [{name}](../../bench/results/{name}.json), {age}: {result['answers']}; {how}"
            lines.append(wrapped(text, "  "))
        return "\n".join(lines)
    head, *fields = mark[len("table: "):].split(" | ")
    options = {}
    for field in fields:
        key, _, value = field.partition(": ")
        if key not in ("columns", "where", "across"):
            raise Malformed(f"a mark with {key}: {mark}")
        options[key] = value
    name = head.strip()
    if name not in results:
        raise Malformed(f"there is no bench/results/{name}.json: {mark}")
    try:
        tables = [drawn_table(part, options) for part in results[name]["parts"] if "columns" in part]
    except Malformed as e:
        raise Malformed(f"{mark}: {e}") from e
    return "\n\n".join([*tables, wrapped(f"{age_of(results[name])} ([{name}](../../bench/results/{name}.json)).")])


MARK = re.compile(r"<!-- (table: [^>]*|list) -->\n(.*?)<!-- /(table|list) -->", re.DOTALL)


def drawn_page(text, results):
    marks = [(" ".join(found[1].split()), found) for found in MARK.finditer(text)]
    for mark, found in marks:
        if "<!--" in found[2] or not mark.startswith(found[3]):
            raise Malformed(f"a mark without its end in the page: {mark}")
    shown = {mark[len("table: "):].split(" | ")[0].strip() for mark, _ in marks if mark != "list"}

    def replaced(found):
        mark = " ".join(found[1].split())
        return f"<!-- {found[1]} -->\n\n{drawn(mark, results, shown)}\n\n<!-- /{found[3]} -->"

    return MARK.sub(replaced, text)


def texts_of(parts):
    return [part["note"] if "note" in part else table_text(part["columns"], part["rows"]) for part in parts]


def shown_text(result):
    lines = [f"### {result['title']}", f"{result['answers']}: `{result['command']}`" if "command" in result
             else f"{result['answers']}: {result['source']}", *texts_of(result["parts"])]
    lines.append(age_of(result) + (f"; {result['versions']}" if "versions" in result else "") + ".")
    if "devices" in result:
        lines.append("```\n" + result["devices"] + "\n```")
    lines += [f"On {remark['on']}: {remark['text']}" for remark in result.get("remarks", [])]
    return "\n\n".join(lines)


def check():
    wrong = []
    results = {}
    try:
        results = load_all()
        for name, result in results.items():
            if not re.fullmatch(r"[a-z0-9_]+", name):
                wrong.append(f"bench/results/{name}.json: names have small letters, digits and _")
            if load(name)[1] != text_of_result(result):
                wrong.append(f"bench/results/{name}.json: not as `take` writes it")
            if parts_of("\n\n".join(texts_of(result["parts"])).splitlines()) != result["parts"]:
                wrong.append(f"bench/results/{name}.json: `take` does not read what `show` prints of it")
        with open(PAGE, encoding="utf-8") as f:
            text = f.read()
        if drawn_page(text, results) != text:
            wrong.append("docs/reference/measures.md: not what `bench/results.py page` draws")
    except Malformed as e:
        wrong.append(str(e))
    for line in wrong:
        print(line)
    if not wrong:
        print(f"results: {len(results)} files")
    return 1 if wrong else 0


def main(arguments):
    verb, rest = arguments[:1], arguments[1:]
    if verb == ["take"] and len(rest) == 1:
        return take(rest[0])
    if verb == ["page"] and not rest:
        results = load_all()
        with open(PAGE, encoding="utf-8") as f:
            text = drawn_page(f.read(), results)
        with open(PAGE, "w", encoding="utf-8") as f:
            f.write(text)
        return 0
    if verb == ["show"] and len(rest) == 1:
        print(shown_text(load(rest[0].removesuffix(".json").rsplit("/", 1)[-1])[0]))
        return 0
    if verb == ["check"] and not rest:
        return check()
    print(__doc__.strip(), file=sys.stderr)
    return 2


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (Malformed, OSError) as error:
        print(f"results.py: {error}", file=sys.stderr)
        sys.exit(2)
