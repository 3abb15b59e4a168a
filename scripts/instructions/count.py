"""Instructions of a frame by module, from two runs under callgrind; see scripts/instructions.sh.

count.py ONE.out THREE.out RECORD.json RUSTC COMMAND [--record]
"""

import json
import re
import sys
from collections import Counter
from pathlib import Path

# Growth that is told, and that of a total that fails.
LIMIT = 0.02
# Modules below this share of the total are not told of: a little of nothing.
SMALL = 0.005
HASH = re.compile(r"::h[0-9a-f]{16}$")
NAME = re.compile(r"\((\d+)\)(?: (.*))?")
PATH = re.compile(r"^<*&?(?:mut |dyn )?([a-z_0-9]+(?:::[a-z_0-9]+)*)")
SOURCE = re.compile(r"crates/(ambray\w*)/src/(\w+)")
TREES = ("ambray_cpu::bvh",)


def by_module(path):
    """Instructions of each module itself, without what it calls. Inlined code counts for the function it went into."""
    cost, names, files, skip = Counter(), {}, {}, False
    function = file = ""

    def named(known, text):
        number, name = NAME.match(text).groups()
        if name:
            known[number] = name
        return known[number]

    for line in path.read_text(errors="replace").splitlines():
        key, _, value = line.partition("=")
        if key == "fn":
            function = named(names, value)
        elif key == "cfn":
            named(names, value)
        elif key in ("fl", "fi", "fe"):
            file = named(files, value)
        elif key in ("cfi", "cfl"):
            named(files, value)
        elif key == "calls":
            skip = True  # the next line is what the called function took
        elif line[:1] in "0123456789+-*" and line:
            if not skip:
                cost[module(function, file)] += int(line.split()[-1])
            skip = False
    return cost


def module(function, file):
    """Crate and module of a function. One of the standard library may be nothing but a closure: its lines tell then."""
    found = PATH.match(HASH.sub("", function))
    parts = found.group(1).split("::") if found else []
    if parts and parts[0].startswith("ambray"):
        return "::".join(parts[:2])
    source = SOURCE.search(file)
    return "::".join(source.groups()) if source else "others"


def counted(modules):
    total = sum(modules.values())
    shown = {name: count for name, count in modules.most_common() if count > total * SMALL}
    return {"total": total, "by_module": shown}


def compare(what, now, then):
    """Tells what has changed; whether the total has grown too much."""
    def ratio(a, b):
        return a / b if b else float("inf")

    print(f"{what:<40} {now['total']:>14,} {ratio(now['total'], then['total']):>7.3f} of the record")
    for name in sorted(now["by_module"].keys() | then["by_module"].keys()):
        a, b = now["by_module"].get(name, 0), then["by_module"].get(name, 0)
        mark = " <" if abs(ratio(a, b) - 1) > LIMIT and abs(a - b) > SMALL * then["total"] else ""
        print(f"  {name:<38} {a:>14,} {ratio(a, b):>7.3f}{mark}")
    return now["total"] > then["total"] * (1 + LIMIT)


def main():
    one, three, record, rustc, command, mode = sys.argv[1:7]
    one, three = by_module(Path(one)), by_module(Path(three))
    frame = Counter({name: (three[name] - one[name]) // 2 for name in three if three[name] > one[name]})
    trees = Counter({name: one[name] - frame[name] for name in TREES if one[name]})
    now = {"command": f"ambray {command}", "rustc": rustc, "frame": counted(frame), "trees": counted(trees)}
    path = Path(record)
    if mode == "--record":
        path.write_text(json.dumps(now, indent=2) + "\n")
        print(f"wrote {record}: {now['frame']['total']:,} instructions a frame")
        return 0
    if not path.exists():
        print(f"{record} does not exist: --record makes it", file=sys.stderr)
        return 2
    then = json.loads(path.read_text())
    if then["command"] != now["command"]:
        print("the record is of another frame: --record makes it anew", file=sys.stderr)
        return 2
    if then["rustc"] != rustc:
        print(f"note: recorded with {then['rustc']}, this is {rustc}")
    grown = [what for what in ("frame", "trees") if compare(what, now[what], then[what])]
    if grown:
        print(f"{' and '.join(grown)} took over {LIMIT:.0%} more instructions than recorded", file=sys.stderr)
    return 1 if grown else 0


sys.exit(main())
